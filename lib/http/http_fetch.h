/** Fetch: a request with its redirects and repeated attempts. */
#ifndef SLC_HTTP_HTTP_FETCH_H
#define SLC_HTTP_HTTP_FETCH_H

#include "http/http_attempt.h"

/** Bytes and URLs of a fetch. */
struct slc_http_fetch {
    SluiceHttpClient *client;
    const SluiceHttpFile *file;        ///< NULL: opens `url`
    const struct slc_http_url *url;    ///< opened URL
    const struct slc_http_url *target; ///< first URL to try; NULL: `url`
    const struct slc_http_part *parts; ///< sorted by offset, adjacent
    uint32_t part_count;
    struct slc_said *said;
    bool is_check; ///< a changed file is no failure
};

/**
 * Fetches on a connection. Logs failures with URL and range. After success from the opened URL, not
 * from a target, `is_moved` is true, and `landed` is the final URL of redirects, or zeros. The
 * caller frees `landed`. `answer` is the last answer.
 * Errors: IO, FILE_NOT_FOUND, UNSUPPORTED, OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_http_fetch(const struct slc_http_fetch *fetch,
                            struct slc_http_connection *connection, uint32_t max_attempts,
                            struct slc_http_url *landed, bool *is_moved,
                            struct slc_http_answer *answer);

/** Returns the verdict on the host for its last answer. */
enum slc_http_verdict slc_http_verdict_of(const struct slc_http_answer *answer);

#endif /* SLC_HTTP_HTTP_FETCH_H */
