/** Target of requests: the final URL of redirects, until expired. */
#ifndef SLC_HTTP_HTTP_TARGET_H
#define SLC_HTTP_HTTP_TARGET_H

#include "http/http_client.h"

/** Begins a use of the file's target. A target is freed after its last use. Any thread. */
struct slc_http_target *slc_http_target_use(SluiceHttpFile *file);
void slc_http_target_leave(SluiceHttpFile *file, struct slc_http_target *target);

/**
 * Sends later reads to `landed`, with the connections and back-off of the new host. Zeros: the
 * opened URL. Takes ownership of the strings, also after an error. Errors: OUT_OF_HOST_MEMORY. Any
 * thread.
 */
SluiceResult slc_http_target_move(SluiceHttpFile *file, struct slc_http_url *landed);

/** Frees the target of a file that is being destroyed. */
void slc_http_target_finish(SluiceHttpFile *file);

#endif /* SLC_HTTP_HTTP_TARGET_H */
