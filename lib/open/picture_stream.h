/**
 * Stream of a picture without tiles: shows a preview soon, then the store from a background bake.
 * Any thread may read while another thread exchanges preview and store.
 */
#ifndef SLC_OPEN_PICTURE_STREAM_H
#define SLC_OPEN_PICTURE_STREAM_H

#include <sluice/bake.h>

#include "open/opener.h"
#include "platform/rw_lock.h"

#include <stdatomic.h>

/** Largest width and height of levels in the preview. */
#define SLC_PREVIEW_SIZE 512u
/** Most repeated bakes of a damaged store, and also of a vanished store. */
#define SLC_MOST_REBUILDS 2u

/** Stream's place in the queue of jobs. Guarded by the background's mutex. */
struct slc_stream_job {
    struct slc_picture_stream *next; ///< next in the queue
    bool is_queued, is_running;
    bool is_later; ///< an earlier attempt was postponed
};

enum slc_stream_job_kind { SLC_JOB_PREVIEW, SLC_JOB_BAKE, SLC_JOB_KIND_COUNT };

struct slc_picture_stream {
    SluiceImageOpener *opener;
    struct slc_background *background; ///< borrowed from the opener; NULL: no job was queued
    const char *path;                  ///< borrowed
    struct slc_file_identity identity;
    SluiceBakeSettings settings;
    uint64_t settings_hash;
    char *store_path; ///< owned
    SluiceImageInfo info;
    uint32_t preview_level; ///< first level of the preview; 0: no preview
    struct slc_stream_job jobs[SLC_JOB_KIND_COUNT];
    atomic_bool is_canceled;
    atomic_int failure; ///< SluiceResult of the bake
    atomic_uint_fast64_t done_texels, total_texels;
    atomic_uint vanished_count; ///< stores that vanished since the last good read
    struct slc_rw_lock lock;    ///< guards the fields below; readers hold the lock
    SluiceImageSource *store;   ///< owned; NULL: not yet
    SluiceImageSource *preview; ///< owned; NULL: not yet, or not needed
    void *preview_bytes;        ///< owned
    size_t preview_size;
    struct slc_file_identity store_identity; ///< identity of the opened store's file
    uint32_t damaged_count;                  ///< stores that were damaged
    bool is_damaged;     ///< the file with `store_identity` is damaged; replace it
    uint32_t open_tries; ///< failed openings after bakes; for the bake's thread only
    bool has_said_busy;  ///< logged: another process bakes; for the bake's thread only
};

/** Hashes settings; 0 for the default. `settings` has this version's size. */
SluiceResult slc_picture_settings_hash(const SluiceBakeSettings *settings, uint64_t *hash);

/**
 * Opens the picture's store, or describes the picture and queues its bake. `path` must live as long
 * as the stream. `settings` NULL: default. Called without the opener's mutex, and locks it to write
 * `*stream`. Errors, logged: the same as sluiceOpenImageSource.
 */
SluiceResult slc_picture_stream_create(SluiceImageOpener *opener, const char *path,
                                       const struct slc_file_identity *identity,
                                       const SluiceBakeSettings *settings,
                                       struct slc_picture_stream **stream);
/** Cancels the jobs and waits for them. NULL is allowed. Called without the opener's mutex. */
void slc_picture_stream_destroy(struct slc_picture_stream *stream);

SluiceResult slc_picture_stream_read(struct slc_picture_stream *stream,
                                     const SluiceImageRegion *region, void *texels,
                                     size_t row_pitch, SluiceImageFault *fault);

/** Fills the fields about the progress of preview and bake. */
void slc_picture_stream_describe(struct slc_picture_stream *stream, SluiceOpenedImageInfo *info);

#endif /* SLC_OPEN_PICTURE_STREAM_H */
