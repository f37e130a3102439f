/** One attempt: a request and its untrusted answer. */
#ifndef SLC_HTTP_HTTP_ATTEMPT_H
#define SLC_HTTP_HTTP_ATTEMPT_H

#include "http/http_client.h"

enum slc_http_outcome {
    SLC_HTTP_OK,
    SLC_HTTP_AGAIN,  ///< another attempt may succeed
    SLC_HTTP_FAILED, ///< no other attempt will succeed
    SLC_HTTP_CANCELLED
};

struct slc_http_request {
    SluiceHttpClient *client;
    CURL *easy;
    const struct slc_http_url *url;
    const SluiceHttpFile *file; ///< the opened version; NULL: opens
    bool is_own;                ///< the host is the opened URL's: headers and signature are sent
    const struct slc_http_part *parts; ///< sorted by offset
    uint32_t part_count;
    uint64_t offset, size; ///< range from the first part to the end of the last
};

/** Version of the file in an answer. */
struct slc_http_version {
    uint64_t size;
    char etag[256], modified[64];
    bool is_fresh; ///< at opening: so new that a later version may get the same date, or an ETag
                   ///< derived from the same date
};

struct slc_http_answer {
    enum slc_http_outcome outcome;
    SluiceResult result;  ///< reason of FAILED
    bool is_host_fault;   ///< the host does not answer, or is overloaded
    bool is_changed;      ///< the file is not the opened version
    bool is_refused;      ///< 401, 403, 404 or 410
    uint64_t retry_after; ///< milliseconds, requested by the server; 0: none
    uint64_t received;    ///< received bytes of the body
    struct slc_http_version version;
    char *redirect; ///< owned by libcurl; valid until the handle's next request
    char why[256];  ///< message of AGAIN and FAILED
};

/** Makes the request. Blocks. */
void slc_http_attempt(const struct slc_http_request *request, struct slc_http_answer *answer);

#endif /* SLC_HTTP_HTTP_ATTEMPT_H */
