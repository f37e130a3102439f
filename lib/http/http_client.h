/**
 * A client's settings, hosts and connections. A connection is a handle of libcurl, which keeps its
 * socket open between requests. One thread uses it at a time.
 */
#ifndef SLC_HTTP_HTTP_CLIENT_H
#define SLC_HTTP_HTTP_CLIENT_H

#include "base/said.h"
#include "http/http_cache.h"
#include "http/http_url.h"
#include "platform/thread.h"

#include <curl/curl.h>
#include <stdatomic.h>

/** Most reads that share a request. */
#define SLC_HTTP_MAX_PARTS 32u

struct slc_http_settings {
    uint32_t max_connections, head_size, max_joined_size;
    uint32_t connect_timeout, stall_timeout; ///< milliseconds
    uint32_t max_attempts, retry_delay, max_retry_delay;
};

struct slc_http_connection {
    CURL *easy;
    struct slc_http_host *host;
    struct slc_http_connection *next; ///< among the idle ones of the host
};

/** Bytes of a file that somebody wants. */
struct slc_http_part {
    uint64_t offset;
    uint64_t size;
    unsigned char *bytes;
};

/** A read that waits for a connection, or for the read that took its part along. */
struct slc_http_wait {
    const SluiceHttpFile *file; ///< NULL: an opening, which is never joined
    struct slc_http_part part;
    struct slc_http_connection *connection; ///< given: this read is to make the request
    bool is_done;
    SluiceResult result; ///< valid if done
    struct slc_condition changed;
    struct slc_http_wait *next;
};

/** Lives as long as the client. Guarded by the client's mutex. */
struct slc_http_host {
    char *origin;
    uint32_t connection_count;
    struct slc_http_connection *idle;
    struct slc_http_wait *first_wait, *last_wait;
    uint32_t failures;   ///< in a row, of requests that say the host is out of order
    uint64_t down_until; ///< monotonic time before which nobody asks; 0: in order
    bool is_probed;      ///< while it is down, one request finds out
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
    char *signature, *credentials_user; ///< for CURLOPT_AWS_SIGV4; the access key
    struct curl_slist *headers;         ///< the application's
    struct curl_slist *s3_headers;      ///< for signed requests
    atomic_bool is_cancelled;
    struct slc_mutex mutex;
    struct slc_condition cancelled; ///< wakes those that wait for their next attempt
    struct slc_http_host *hosts;
    uint32_t connection_count, in_flight, waiting;
    struct slc_http_counts counts;
    struct slc_http_cache cache; ///< zeroed: none
};

/** Where requests of a file go. Reads that use it keep it alive. */
struct slc_http_target {
    struct slc_http_url url; ///< where redirects led; zeroed: nowhere else than the opened URL
    struct slc_http_host *host;
    uint32_t user_count; ///< the file, and reads; guarded by the client's mutex
};

struct SluiceHttpFile {
    SluiceHttpClient *client;
    struct slc_http_url url;        ///< as it was opened
    struct slc_http_target *target; ///< guarded by the client's mutex
    uint64_t size;
    char etag[256], modified[64]; ///< of the opened version; empty: not told
    char version[384];            ///< both and the size, for the cache; empty: not to be kept
    unsigned char *head;
    size_t head_size;
    struct slc_said said;
    atomic_bool is_stale; ///< changed on the server
};

/** Finds or adds the host of a URL. NULL: no memory. */
struct slc_http_host *slc_http_get_host(SluiceHttpClient *client, const char *origin);

/** Way to get a connection. */
enum slc_http_turn {
    SLC_HTTP_GO,      ///< *connection is the caller's until slc_http_release
    SLC_HTTP_DONE,    ///< another read did the work; wait->result
    SLC_HTTP_REFUSED, ///< the host is out of order, or the client is cancelled
    SLC_HTTP_NO_MEMORY
};

/** Waits for a connection to `host`. `is_probe` becomes true if the host is out of order and this
 *  request is to find out. */
enum slc_http_turn slc_http_acquire(SluiceHttpClient *client, struct slc_http_host *host,
                                    struct slc_http_wait *wait,
                                    struct slc_http_connection **connection, bool *is_probe);

/**
 * Takes waiting reads that lie side by side with `parts` out of the queue. `parts` and `waits` have
 * SLC_HTTP_MAX_PARTS elements, of which one part is there. Returns the number of parts, sorted by
 * offset; waits[i] is NULL for the caller's own.
 */
uint32_t slc_http_join(SluiceHttpClient *client, struct slc_http_host *host,
                       const SluiceHttpFile *file, struct slc_http_part *parts,
                       struct slc_http_wait **waits);

/** Hands the result to the reads that were taken along. */
void slc_http_finish_joined(SluiceHttpClient *client, struct slc_http_wait *const *waits,
                            uint32_t count, SluiceResult result);

/** How a request ended, for its host. */
enum slc_http_verdict { SLC_HTTP_IN_ORDER, SLC_HTTP_OUT_OF_ORDER, SLC_HTTP_UNKNOWN };

/** Gives the connection to the next read that waits. `least_delay`: milliseconds that an overloaded
 *  server asked for. */
void slc_http_release(SluiceHttpClient *client, struct slc_http_connection *connection,
                      enum slc_http_verdict verdict, uint64_t least_delay);

/** Waits `least` milliseconds, and `delay` less a random part of up to a half. False: cancelled. */
bool slc_http_pause(SluiceHttpClient *client, uint64_t least, uint64_t delay);

#endif /* SLC_HTTP_HTTP_CLIENT_H */
