/** Where a file is asked for: where redirects led, until that expires. */
#ifndef SLC_HTTP_HTTP_TARGET_H
#define SLC_HTTP_HTTP_TARGET_H

#include "http/http_client.h"

/** Begins a use of the file's target, which stays until its last use ends. Any thread. */
struct slc_http_target *slc_http_target_use(SluiceHttpFile *file);
void slc_http_target_leave(SluiceHttpFile *file, struct slc_http_target *target);

/**
 * Sends later reads to `landed`, whose host's connections and back-off then count. Zeros: to the
 * opened URL. Takes the strings, also after an error: OUT_OF_HOST_MEMORY. Any thread.
 */
SluiceResult slc_http_target_move(SluiceHttpFile *file, struct slc_http_url *landed);

/** Frees the target of a file that is being destroyed. */
void slc_http_target_finish(SluiceHttpFile *file);

#endif /* SLC_HTTP_HTTP_TARGET_H */
