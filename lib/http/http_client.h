/**
 * Client of HTTP: settings, hosts and connections. A connection is a libcurl handle, whose socket
 * stays open between requests. One thread at a time uses a connection.
 */
#ifndef SLC_HTTP_HTTP_CLIENT_H
#define SLC_HTTP_HTTP_CLIENT_H

#include "base/said.h"
#include "http/http_cache.h"
#include "http/http_url.h"
#include "platform/thread.h"

#include <curl/curl.h>
#include <stdatomic.h>

/** Most parts in one request. */
#define SLC_HTTP_MAX_PARTS 32u

struct slc_http_settings {
    uint32_t max_connections, head_size, max_joined_size;
    uint32_t connect_timeout, stall_timeout; ///< milliseconds
    uint32_t max_attempts, retry_delay, max_retry_delay;
};

struct slc_http_connection {
    CURL *easy;
    struct slc_http_host *host;
    struct slc_http_connection *next; ///< next idle connection of the host
};

/** Range of a file and the reader's memory. */
struct slc_http_part {
    uint64_t offset;
    uint64_t size;
    unsigned char *bytes;
};

/** Waiting read: waits for a connection, or for another read's request that includes its part. */
struct slc_http_wait {
    const SluiceHttpFile *file; ///< NULL: an opening, which never shares a request
    struct slc_http_part part;
    struct slc_http_connection *connection; ///< not NULL: this read must make the request
    bool is_done;
    SluiceResult result; ///< valid if done
    struct slc_condition changed;
    struct slc_http_wait *next;
};

/** Host. Lives as long as the client. Guarded by the client's mutex. */
struct slc_http_host {
    char *origin;
    uint32_t connection_count;
    struct slc_http_connection *idle;
    struct slc_http_wait *first_wait, *last_wait;
    uint32_t failures;   ///< consecutive failures of the host
    uint64_t down_until; ///< monotonic time of the next allowed request; 0: host works
    bool is_probed;      ///< while the host is down, one request tests it
    struct slc_http_host *next;
};

struct slc_http_counts {
    _Atomic uint64_t requests, connects, retries, failures, refused, reads, joined, kept, asked,
        body, header;
};

struct SluiceHttpClient {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    struct slc_http_settings settings;
    struct slc_s3_access s3;
    char *certificate_file;
    char *signature, *credentials_user; ///< value for CURLOPT_AWS_SIGV4, and the access key
    struct curl_slist *headers;         ///< headers of the application
    struct curl_slist *s3_headers;      ///< headers of signed requests
    atomic_bool is_cancelled;
    struct slc_mutex mutex;
    struct slc_condition cancelled; ///< wakes threads that wait for their next attempt
    struct slc_http_host *hosts;
    uint32_t connection_count, in_flight, waiting;
    struct slc_http_counts counts;
    struct slc_http_cache cache; ///< zeroed: no cache
};

/** Target of a file's requests. Kept alive by its users. */
struct slc_http_target {
    struct slc_http_url url; ///< final URL of redirects; zeroed: the opened URL
    struct slc_http_host *host;
    uint32_t user_count; ///< users: the file and its reads; guarded by the client's mutex
};

struct SluiceHttpFile {
    SluiceHttpClient *client;
    struct slc_http_url url;        ///< opened URL
    struct slc_http_target *target; ///< guarded by the client's mutex
    uint64_t size;
    char etag[256], modified[64]; ///< opened version; empty: not sent by the server
    char version[384];            ///< ETag, date and size, for the cache; empty: do not cache
    unsigned char *head;
    size_t head_size;
    struct slc_said said;
    atomic_bool is_stale; ///< changed on the server
};

/** Finds or adds the host of a URL. NULL: no memory. */
struct slc_http_host *slc_http_get_host(SluiceHttpClient *client, const char *origin);

/** Way to get a connection. */
enum slc_http_turn {
    SLC_HTTP_GO,      ///< the caller owns *connection until slc_http_release
    SLC_HTTP_DONE,    ///< another read's request has ended: see wait->result
    SLC_HTTP_REFUSED, ///< the host is down, or the client is cancelled
    SLC_HTTP_NO_MEMORY
};

/** Waits for a connection to `host`. `is_probe` becomes true if the host is down and this request
 *  must test it. */
enum slc_http_turn slc_http_acquire(SluiceHttpClient *client, struct slc_http_host *host,
                                    struct slc_http_wait *wait,
                                    struct slc_http_connection **connection, bool *is_probe);

/**
 * Takes waiting reads adjacent to `parts` from the queue. `parts` and `waits` have
 * SLC_HTTP_MAX_PARTS elements; on entry, parts[0] is the caller's. Returns the number of parts,
 * sorted by offset. waits[i] is NULL for the caller's part.
 */
uint32_t slc_http_join(SluiceHttpClient *client, struct slc_http_host *host,
                       const SluiceHttpFile *file, struct slc_http_part *parts,
                       struct slc_http_wait **waits);

/** Delivers the result to the joined reads. */
void slc_http_finish_joined(SluiceHttpClient *client, struct slc_http_wait *const *waits,
                            uint32_t count, SluiceResult result);

/** Verdict on the host after a request. */
enum slc_http_verdict { SLC_HTTP_IN_ORDER, SLC_HTTP_OUT_OF_ORDER, SLC_HTTP_UNKNOWN };

/** Gives the connection to the next waiting read. `least_delay`: milliseconds, requested by an
 *  overloaded server. */
void slc_http_release(SluiceHttpClient *client, struct slc_http_connection *connection,
                      enum slc_http_verdict verdict, uint64_t least_delay);

/** Waits `least` + `delay` milliseconds, less a random part of up to delay / 2. False: cancelled.
 */
bool slc_http_pause(SluiceHttpClient *client, uint64_t least, uint64_t delay);

#endif /* SLC_HTTP_HTTP_CLIENT_H */
