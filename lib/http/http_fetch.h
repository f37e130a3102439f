/** A request with its redirects and further attempts. */
#ifndef SLC_HTTP_HTTP_FETCH_H
#define SLC_HTTP_HTTP_FETCH_H

#include "http/http_attempt.h"

/** Names the bytes of a fetch, and where they come from. */
struct slc_http_fetch {
    SluiceHttpClient *client;
    const SluiceHttpFile *file;        ///< NULL: opens `url`
    const struct slc_http_url *url;    ///< as it was opened
    const struct slc_http_url *target; ///< where to begin, or NULL: at `url`
    const struct slc_http_part *parts; ///< sorted by offset, side by side
    uint32_t part_count;
    struct slc_said *said;
    bool is_check; ///< it is no failure that the file was changed
};

/**
 * Fetches on a connection. Logs failures with URL and range. If this succeeds from the opened URL,
 * not from a target, `is_moved` becomes true, and `landed` is the URL that redirects led to, or
 * zeros. The caller frees it. `answer` is the last one.
 * Errors: IO, FILE_NOT_FOUND, UNSUPPORTED, OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_http_fetch(const struct slc_http_fetch *fetch,
                            struct slc_http_connection *connection, uint32_t max_attempts,
                            struct slc_http_url *landed, bool *is_moved,
                            struct slc_http_answer *answer);

/** Judges the host by its last answer. */
enum slc_http_verdict slc_http_verdict_of(const struct slc_http_answer *answer);

#endif /* SLC_HTTP_HTTP_FETCH_H */
