/** Background jobs of pictures: one thread makes previews, another one bakes stores. */
#ifndef SLC_OPEN_BACKGROUND_H
#define SLC_OPEN_BACKGROUND_H

#include <sluice/bake.h>

#include "open/picture_stream.h"

/** Starts libvips and the threads. Errors: UNSUPPORTED, OUT_OF_HOST_MEMORY. */
SluiceResult slc_background_create(SluiceImageOpener *opener, struct slc_background **background);
/** Ends the threads. No job may be left. NULL is allowed. */
void slc_background_destroy(struct slc_background *background);

SluiceBaker *slc_background_baker(struct slc_background *background);

/** Queues a job, unless the stream is canceled. The end of a preview queues the bake. */
void slc_background_queue(struct slc_background *background, struct slc_picture_stream *stream,
                          enum slc_stream_job_kind kind);
/** Removes the stream's jobs from the queues, or waits for their end. */
void slc_background_cancel(struct slc_background *background, struct slc_picture_stream *stream);

/** Jobs of the two threads, in picture_jobs.c. False: the store cannot be baked now; bake other
 *  pictures first, then try again. */
void slc_make_preview(struct slc_background *background, struct slc_picture_stream *stream);
bool slc_make_store(struct slc_background *background, struct slc_picture_stream *stream);

/** Opens the picture's store, if baked from this picture, and returns the file's identity. Errors,
 *  not logged: FILE_NOT_FOUND for a missing store, CORRUPT_DATA for a store of another picture.
 *  Other errors are logged as warnings. */
SluiceResult slc_open_picture_store(struct slc_picture_stream *stream, SluiceImageSource **store,
                                    struct slc_file_identity *identity);
/** Tells whether the store's name now has a file other than `identity`. `*is_there`: any file. */
bool slc_picture_store_is_replaced(const struct slc_picture_stream *stream,
                                   const struct slc_file_identity *identity, bool *is_there);
/** Tells whether `source` equals the image described to readers, from `level` on. Readers' buffers
 *  have the size of the described image. */
bool slc_picture_is_as_described(const struct slc_picture_stream *stream, SluiceImageSource *source,
                                 uint32_t level);

#endif /* SLC_OPEN_BACKGROUND_H */
