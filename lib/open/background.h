/** Two threads that make previews and stores of pictures, one thread each. */
#ifndef SLC_OPEN_BACKGROUND_H
#define SLC_OPEN_BACKGROUND_H

#include <sluice/bake.h>

#include "open/picture_stream.h"

/** Starts libvips and the threads. Errors: UNSUPPORTED, OUT_OF_HOST_MEMORY. */
SluiceResult slc_background_create(SluiceImageOpener *opener, struct slc_background **background);
/** No job is left. NULL is allowed. */
void slc_background_destroy(struct slc_background *background);

SluiceBaker *slc_background_baker(struct slc_background *background);

/** A stream that is canceled is not queued. The end of a preview queues the bake. */
void slc_background_queue(struct slc_background *background, struct slc_picture_stream *stream,
                          enum slc_stream_job_kind kind);
/** Takes the stream's jobs out of the queues, or waits until they have ended. */
void slc_background_cancel(struct slc_background *background, struct slc_picture_stream *stream);

/** The two jobs of the threads. They are in picture_jobs.c. A store that cannot be made now returns
 *  false: other pictures are baked first, and then it is tried again. */
void slc_make_preview(struct slc_background *background, struct slc_picture_stream *stream);
bool slc_make_store(struct slc_background *background, struct slc_picture_stream *stream);

/** Opens the picture's store if it was made of this picture, and tells which file it is. Errors:
 *  FILE_NOT_FOUND if there is none, and CORRUPT_DATA for a store of something else, not logged;
 *  others, logged as warnings. */
SluiceResult slc_open_picture_store(struct slc_picture_stream *stream, SluiceImageSource **store,
                                    struct slc_file_identity *identity);
/** Whether another file than `identity` has the store's name now. `*is_there`: one has it. */
bool slc_picture_store_is_replaced(const struct slc_picture_stream *stream,
                                   const struct slc_file_identity *identity, bool *is_there);
/** Whether `source` has the levels from `level` on of the image that readers were told of. Buffers
 *  of readers have the size of that image. */
bool slc_picture_is_as_described(const struct slc_picture_stream *stream, SluiceImageSource *source,
                                 uint32_t level);

#endif /* SLC_OPEN_BACKGROUND_H */
