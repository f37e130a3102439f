/**
 * Reads image files from web servers and object stores, a range of bytes at a time. Link
 * `sluice-http`, which needs libcurl.
 *
 * Open a URL, get its SluiceInput and give that to a source: sluiceCreateStoreImageSource,
 * sluiceCreateDdsImageSource, sluiceCreateKtx2ImageSource or sluiceCreateExrImageSource. The source
 * then reads tiles by range requests over HTTP/1.1. Reads block, so give the loader as many threads
 * as requests are to be in flight: 32 are a good number.
 */
#ifndef SLUICE_HTTP_H
#define SLUICE_HTTP_H

#include <sluice/input.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Default number of connections to one host. */
#define SLUICE_HTTP_DEFAULT_CONNECTIONS_PER_HOST 32u
/** Default number of bytes that are asked for when a URL is opened. */
#define SLUICE_HTTP_DEFAULT_HEAD_SIZE ((uint32_t)128 << 10)

/** Default limit of the cache folder: 4 GiB. */
#define SLUICE_HTTP_DEFAULT_CACHE_SIZE ((uint64_t)4 << 30)

/** Keeps connections to hosts, and settings that all of its files share. */
typedef struct SluiceHttpClient SluiceHttpClient;
/** A file on a server. */
typedef struct SluiceHttpFile SluiceHttpFile;

/**
 * Access to an object store that speaks the protocol of Amazon S3, for URLs "s3://BUCKET/KEY".
 * Sluice reads no environment variables; the tools do.
 */
typedef struct SluiceS3Access {
    uint32_t structSize; ///< sizeof(SluiceS3Access).
    /** "https://HOST[:PORT]". Required. The bucket's name becomes the first part of the path. */
    const char *pEndpoint;
    const char *pRegion;       ///< Default: "us-east-1".
    const char *pAccessKey;    ///< Default: requests are not signed.
    const char *pSecretKey;    ///< Required with pAccessKey.
    const char *pSessionToken; ///< Default: none.
} SluiceS3Access;

/** Settings of a client. A field of zero selects its default. */
typedef struct SluiceHttpClientCreateInfo {
    uint32_t structSize; ///< sizeof(SluiceHttpClientCreateInfo).
    /** Most connections to one host, and so requests in flight there. 1 to 1024. Default:
     * SLUICE_HTTP_DEFAULT_CONNECTIONS_PER_HOST. */
    uint32_t maxConnectionsPerHost;
    /** Bytes that opening a URL asks for and keeps in memory: header and index of a tile store of
     * up to 6 324 tiles fit into the default. 1 to 2^26. Default:
     * SLUICE_HTTP_DEFAULT_HEAD_SIZE. */
    uint32_t headSize;
    /** Reads that wait for a connection and lie side by side in a file become one request of at
     * most so many bytes. 1: never. At most 2^26. Default: 2^20. */
    uint32_t maxJoinedSize;
    uint32_t connectTimeout; ///< Milliseconds. Default: 10 000.
    /** Milliseconds after which an attempt ends, within a second, if no more than 500 bytes per
     * second of the body came in them. Default: 10 000. */
    uint32_t stallTimeout;
    /** Attempts of a request before it fails, the first one included. 1 to 100. Default: 4. */
    uint32_t maxAttemptCount;
    /** Milliseconds before the second attempt. Doubles with each further one, and a random part of
     * up to a half is taken off. Default: 100. */
    uint32_t retryDelay;
    /** Most milliseconds between two attempts. A server that asks for more by Retry-After gets no
     * further attempt. Default: 5 000. */
    uint32_t maxRetryDelay;
    /** File of certificates in PEM that are trusted instead of the system's. Default: NULL. */
    const char *pCertificateFile;
    /** Header lines for every request to every host, such as "Authorization: Bearer ...". Never
     * logged, and not sent to another host after a redirect. Copied. */
    const char *const *ppHeaders;
    uint32_t headerCount;
    const SluiceS3Access *pS3; ///< Copied. Default: NULL, URLs of s3:// are refused.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    /** Failures, with URL and range. Passwords and queries of URLs are left out. Any thread. */
    SluiceLogCallback log;
    /**
     * Cache folder for ranges, so that the next start does not request them again. Created if its
     * parent exists. Several processes may use the folder, and may be killed at any time. Ranges
     * are checked; damaged ranges are requested again. A folder in which every user may write is an
     * error, because its writers could choose texels. Files without ETag and date are not cached,
     * nor files with a date less than two seconds old at opening. The query of a URL is part of its
     * name, so presigned URLs never hit the cache. Copied. Default: NULL, no cache.
     */
    const char *pCacheFolder;
    /** Most bytes in the folder. Beyond, the least recently read ranges are removed. Default:
     * SLUICE_HTTP_DEFAULT_CACHE_SIZE. */
    uint64_t maxCacheSize;
} SluiceHttpClientCreateInfo;

/**
 * Creates a client. Opens no connection. `pInfo` may be NULL: every setting has its default.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, also for SluiceS3Access::pEndpoint;
 *         SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a setting out of range;
 *         SLUICE_ERROR_IO, with a log message, if the cache folder cannot be made, or everybody may
 *         write in it;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY; SLUICE_ERROR_UNSUPPORTED if libcurl lacks HTTPS or
 *         threads.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateHttpClient(const SluiceHttpClientCreateInfo *pInfo,
                                               SluiceHttpClient **pClient);

/**
 * Destroys a client and closes its connections. Destroy its files first. NULL is allowed.
 * Thread safety: external on `client`.
 */
SLUICE_API void sluiceDestroyHttpClient(SluiceHttpClient *client);

/**
 * Ends all reads and opens that are under way and refuses further ones: they return
 * SLUICE_ERROR_IO within a second, without a log message. Call it before you destroy a loader
 * whose reads may wait for a slow server. NULL is allowed.
 * Thread safety: any thread.
 */
SLUICE_API void sluiceCancelHttpReads(SluiceHttpClient *client);

/**
 * Opens "http://", "https://" or "s3://" URL. Asks for the first
 * SluiceHttpClientCreateInfo::headSize bytes and keeps them, so that a source made of it reads its
 * header without a request.
 *
 * Only servers that answer ranges can be read. A server that sends the whole file instead is
 * refused with SLUICE_ERROR_UNSUPPORTED, unless the file has at most headSize bytes. Characters
 * that URLs do not allow must be escaped ("%20"); in s3:// URLs they are escaped for you.
 *
 * Redirects are followed, up to five, but never from https to http.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for URLs of other kinds;
 *         SLUICE_ERROR_FILE_NOT_FOUND for answers 404 and 410; SLUICE_ERROR_UNSUPPORTED;
 *         SLUICE_ERROR_IO for other answers, certificates that are not trusted, an empty file, and
 *         servers that do not answer in maxAttemptCount attempts;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY. All but the first are logged.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceOpenHttpFile(SluiceHttpClient *client, const char *pUrl,
                                           SluiceHttpFile **pFile);

/**
 * Closes and frees a file. Destroy the sources that read it first. NULL is allowed.
 * Thread safety: external on `file`.
 */
SLUICE_API void sluiceDestroyHttpFile(SluiceHttpFile *file);

/**
 * Gets the file as an input of sources. The input is valid until the file is destroyed.
 *
 * Its reads return:
 * - SLUICE_ERROR_IO if all attempts failed. While a host does not answer, reads fail at once, and
 *   one attempt is made each time the host's back-off has passed: after `retryDelay`, doubled with
 *   every further failure up to `maxRetryDelay`. Streamers keep the coarser level and read again.
 * - SLUICE_ERROR_IO for ever after the file was changed on the server (another ETag, date or size):
 *   texels of two versions never meet. Destroy the file and open it again.
 * - SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 * Thread safety: any thread; the input's reads, too.
 */
SLUICE_API SluiceResult sluiceGetHttpInput(SluiceHttpFile *file, SluiceInput *pInput);

/**
 * Opens a URL for an opener (SluicePathOpener, whose pUserData is the client): sluiceOpenHttpFile
 * and sluiceGetHttpInput in one. `*ppOpened` becomes the SluiceHttpFile.
 *
 * Errors: as sluiceOpenHttpFile and sluiceGetHttpInput.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceOpenHttpPath(void *pClient, const char *path, SluiceInput *pInput,
                                           void **ppOpened);

/** Closes a file of sluiceOpenHttpPath. NULL is allowed. Thread safety: external on `pOpened`. */
SLUICE_API void sluiceCloseHttpPath(void *pClient, void *pOpened);

/**
 * Asks the server for one byte of a file that sluiceOpenHttpPath opened. Bypasses memory and cache
 * folder. For SluiceImageOpenerCreateInfo::pfnCheckPath.
 *
 * Returns SLUICE_SUCCESS if ETag, date and size have not changed since the file was opened.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_IO if the file was changed, which is not logged,
 *         or cannot be read; SLUICE_ERROR_UNSUPPORTED if the size is that of the opening, and the
 *         server tells nothing else (neither ETag nor date, or the file was changed less than 2 s
 *         before it was opened); SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCheckHttpPath(void *pClient, void *pOpened);

/** Counts of a client since its creation. */
typedef struct SluiceHttpStatistics {
    uint32_t structSize;      ///< sizeof(SluiceHttpStatistics).
    uint32_t connectionCount; ///< Connections that are open or were not found closed yet.
    uint32_t requestsInFlight;
    uint32_t waitingReadCount; ///< Reads that wait for a connection.
    uint64_t requestTotal;     ///< Attempts, including attempts to open.
    uint64_t connectTotal;     ///< Connections made.
    uint64_t retryTotal;       ///< Attempts after the first one of a request.
    uint64_t failureTotal;     ///< Requests whose attempts all failed.
    uint64_t refusedTotal;     ///< Reads that failed at once because of their host's back-off.
    uint64_t readTotal;        ///< Reads by sources that succeeded.
    uint64_t joinedTotal;      ///< Reads that shared the request of another one.
    uint64_t keptTotal;        ///< Reads that were answered from the bytes kept at opening.
    uint64_t askedBytes;       ///< Bytes that successful reads by sources asked for.
    uint64_t bodyBytes;        ///< Bytes of bodies received.
    uint64_t headerBytes;      ///< Bytes of answers' headers received.
    uint64_t cacheHitTotal;    ///< Reads that were answered from the cache folder.
    uint64_t cacheSize;        ///< Bytes in the cache folder, as far as this client knows.
} SluiceHttpStatistics;

/**
 * Gets the counts of a client.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceGetHttpStatistics(SluiceHttpClient *client,
                                                SluiceHttpStatistics *pStatistics);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_HTTP_H */
