/**
 * A picture without tiles: a preview at once, then its store, which a bake in the background
 * writes. Any thread reads while others exchange what is read.
 */
#ifndef SLC_OPEN_PICTURE_STREAM_H
#define SLC_OPEN_PICTURE_STREAM_H

#include <sluice/bake.h>

#include "open/opener.h"
#include "platform/rw_lock.h"

#include <stdatomic.h>

/** Levels with at most so many texels in a direction are in the preview. */
#define SLC_PREVIEW_SIZE 512u
/** Times that a store is baked again because it was damaged, and as many because it vanished. */
#define SLC_MOST_REBUILDS 2u

/** A stream's place in the queue of jobs. The mutex of the background guards it. */
struct slc_stream_job {
    struct slc_picture_stream *next; ///< in the queue
    bool is_queued, is_running;
    bool is_later; ///< It was tried, and could not be done then.
};

enum slc_stream_job_kind { SLC_JOB_PREVIEW, SLC_JOB_BAKE, SLC_JOB_KIND_COUNT };

struct slc_picture_stream {
    SluiceImageOpener *opener;
    struct slc_background *background; ///< borrowed from the opener; NULL: it has no jobs yet
    const char *path;                  ///< borrowed
    struct slc_file_identity identity;
    SluiceBakeSettings settings;
    uint64_t settings_hash;
    char *store_path; ///< owned
    SluiceImageInfo info;
    uint32_t preview_level; ///< its first; 0: there is no preview
    struct slc_stream_job jobs[SLC_JOB_KIND_COUNT];
    atomic_bool is_canceled;
    atomic_int failure; ///< SluiceResult of the bake
    atomic_uint_fast64_t done_texels, total_texels;
    atomic_uint vanished_count; ///< stores that vanished since the last good read
    struct slc_rw_lock lock;    ///< around what follows; readers hold it while they read
    SluiceImageSource *store;   ///< owned; NULL: not yet
    SluiceImageSource *preview; ///< owned; NULL: not yet, or not needed
    void *preview_bytes;        ///< owned
    size_t preview_size;
    struct slc_file_identity store_identity; ///< of the store's file when it was opened
    uint32_t damaged_count;                  ///< stores that were damaged
    bool is_damaged;                         ///< the file with `store_identity` is; replace it
    uint32_t open_tries; ///< baked stores that could not be opened; only the bake's thread uses it
    bool has_said_busy;  ///< that another process bakes it; only the bake's thread uses it
};

/** Hash of all settings but the default ones, which have 0. `settings` is of this version. */
SluiceResult slc_picture_settings_hash(const SluiceBakeSettings *settings, uint64_t *hash);

/**
 * Opens the picture's store, or describes the picture and queues its bake. `path` lives as long as
 * the stream. `settings` NULL: default. The opener's mutex is not held. Writes `*stream` with the
 * mutex. Errors: as sluiceOpenImageSource, logged.
 */
SluiceResult slc_picture_stream_create(SluiceImageOpener *opener, const char *path,
                                       const struct slc_file_identity *identity,
                                       const SluiceBakeSettings *settings,
                                       struct slc_picture_stream **stream);
/** Cancels its jobs and waits for them. NULL is allowed. The opener's mutex is not held. */
void slc_picture_stream_destroy(struct slc_picture_stream *stream);

SluiceResult slc_picture_stream_read(struct slc_picture_stream *stream,
                                     const SluiceImageRegion *region, void *texels,
                                     size_t row_pitch, SluiceImageFault *fault);

/** Fills the fields that tell how far it is. */
void slc_picture_stream_describe(struct slc_picture_stream *stream, SluiceOpenedImageInfo *info);

#endif /* SLC_OPEN_PICTURE_STREAM_H */
