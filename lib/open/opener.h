/** Files that are open, by path, and what they share. */
#ifndef SLC_OPEN_OPENER_H
#define SLC_OPEN_OPENER_H

#include <sluice/bake.h>
#include <sluice/open.h>

#include "image/file_pool.h"
#include "open/catalogue.h"
#include "open/file_kind.h"
#include "platform/thread.h"

#define SLC_OPENER_BUCKETS 1024u
#define SLC_OPENER_CATALOGUES 8u ///< that stay in memory

struct slc_picture_stream;
struct slc_background;

/** One file. Its opener's mutex guards what comes before `path`. The rest is constant once it is
 *  open; before, only the thread that opens it uses `source`, `complete` and `stream`. */
struct slc_opened_image {
    SluiceImageSource base;
    SluiceImageOpener *opener;
    SluiceInput input;             ///< of a path that is no file; zeroed: a file
    void *opened;                  ///< what the path opener closes
    struct slc_opened_image *next; ///< in the same bucket
    uint32_t reference_count;      ///< threads that wait until it is open included
    bool is_opening;
    bool is_kind_known;  ///< else `kind` is not set yet: what a path opener opens tells it
    bool is_checking;    ///< a thread asks whether a catalogue is unchanged
    uint64_t checked;    ///< slc_monotonic_time when a catalogue was last known to be unchanged
    SluiceResult result; ///< of opening it
    char *path;          ///< owned
    char *shown;         ///< owned; a URL without password and query, for messages; NULL: a file
    char *texture;       ///< owned; name that was asked for; NULL: none
    struct slc_catalogue *catalogue; ///< owned; no source is then made, nor returned
    uint64_t settings_hash;          ///< of a picture's bake; 0: default settings
    struct slc_file_identity identity;
    SluiceImageFileKind kind;
    SluiceImageSource *source;         ///< owned; NULL for pictures
    SluiceImageSource *complete;       ///< owned; adds levels to `source`; NULL: it lacks none
    struct slc_picture_stream *stream; ///< owned; of pictures
};

struct SluiceImageOpener {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    SluiceLogCallback cache_log;  ///< for stores of the cache folder: errors are warnings
    SluicePathOpener path_opener; ///< zeroed: none
    SluiceResult (*check_path)(void *user, void *opened); ///< NULL: nothing can be checked
    char *cache_folder;                                   ///< owned; NULL: none
    uint64_t max_cache_size, max_bake_memory;
    uint32_t bake_thread_count;
    struct slc_shared_files files;
    struct slc_mutex mutex;            ///< around what follows; never held while files are read
    struct slc_condition opened;       ///< an image is open, or could not be opened
    struct slc_background *background; ///< owned; NULL: no picture was opened yet
    /** Catalogues, the last one opened first. A reference each; the first NULL ends them. */
    struct slc_opened_image *kept[SLC_OPENER_CATALOGUES];
    struct slc_opened_image *buckets[SLC_OPENER_BUCKETS];
};

/** One call. */
struct slc_open_request {
    const char *path, *texture;         ///< texture NULL: none
    const SluiceBakeSettings *settings; ///< NULL: default
    uint64_t settings_hash;             ///< 0: default, or of no picture
    SluiceImageFileKind kind;
    struct slc_file_identity identity;
    bool is_entry; ///< a catalogue names it
};

bool slc_opener_owns_path(const SluiceImageOpener *opener, const char *path);
SluiceResult slc_opener_open(SluiceImageOpener *opener, struct slc_open_request *r,
                             SluiceImageSource **source);
/** With the mutex held. */
void slc_opener_forget(struct slc_opened_image *image);
/** Drops a reference that the caller counted. */
void slc_opener_release(struct slc_opened_image *image);

/** Catalogues, opener_catalogues.c. @{ */

/** Reads the catalogue of an image that is being opened. */
SluiceResult slc_opener_read_catalogue(struct slc_opened_image *image);
/** With the mutex held. Keeps a catalogue in memory; returns the one that has to go, whose
 *  reference the caller releases without the mutex, or NULL. */
struct slc_opened_image *slc_opener_keep(struct slc_opened_image *image);
/**
 * Whether the catalogue is as it was when it was read. If not, the next request reads it again.
 * Files are: their identity was compared. Others are asked if `*is_sure` is set, which then says
 * that something was wrong, or if a second has passed. `*is_sure` becomes whether the catalogue is
 * known to be unchanged since `began`.
 */
bool slc_opener_is_current(struct slc_opened_image *image, uint64_t began, bool *is_sure);
/** Opens the store that a row of `by` names. `is_sure` false: errors that an outdated catalogue
 *  may cause are not logged. */
SluiceResult slc_opener_open_row(struct slc_opened_image *by, const struct slc_open_request *r,
                                 bool is_sure, SluiceImageSource **source);

/** @} */

#endif /* SLC_OPEN_OPENER_H */
