/** URLs: parsed form, origin, and text for messages. */
#ifndef SLC_HTTP_HTTP_URL_H
#define SLC_HTTP_HTTP_URL_H

#include <sluice/http.h>

/** Parsed URL with owned strings. Zeroed: none. */
struct slc_http_url {
    char *full;   ///< for libcurl: http or https, no fragment
    char *origin; ///< "SCHEME://HOST:PORT"
    char *shown;  ///< for messages: without user, password and query
    bool is_s3;   ///< the scheme was s3; requests are signed if keys are set
};

/** Copied settings of an object store. `endpoint` NULL: not set. */
struct slc_s3_access {
    char *endpoint, *region, *access_key, *secret_key, *session_token;
};

/**
 * Parses an http, https or s3 URL. Errors, logged: INVALID_ARGUMENT; not logged:
 * OUT_OF_HOST_MEMORY. Free `url` also after errors.
 */
SluiceResult slc_http_url_parse(struct slc_http_url *url, const char *text,
                                const struct slc_s3_access *s3, const SluiceAllocationCallbacks *cb,
                                const SluiceLogCallback *log);
void slc_http_url_free(struct slc_http_url *url, const SluiceAllocationCallbacks *cb);

/** True if requests to both go to the same scheme, host and port. */
bool slc_http_same_origin(const struct slc_http_url *a, const struct slc_http_url *b);
/** True if `url` is https. */
bool slc_http_is_secure(const struct slc_http_url *url);

#endif /* SLC_HTTP_HTTP_URL_H */
