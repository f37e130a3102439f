/** Opener: open files by path, and shared pools. */
#ifndef SLC_OPEN_OPENER_H
#define SLC_OPEN_OPENER_H

#include <sluice/bake.h>
#include <sluice/open.h>

#include "image/file_pool.h"
#include "open/catalogue.h"
#include "open/file_kind.h"
#include "platform/thread.h"

#define SLC_OPENER_BUCKETS 1024u
#define SLC_OPENER_CATALOGUES 8u ///< most catalogues in memory

struct slc_picture_stream;
struct slc_background;

/** Opened file. The opener's mutex guards the fields before `path`. The other fields are constant
 *  after the opening. During the opening, only the opening thread uses `source`, `complete` and
 *  `stream`. */
struct slc_opened_image {
    SluiceImageSource base;
    SluiceImageOpener *opener;
    SluiceInput input;             ///< bytes from a path opener; zeroed: a file
    void *opened;                  ///< handle for the path opener's close function
    struct slc_opened_image *next; ///< next in the bucket
    uint32_t reference_count;      ///< includes threads that wait for the opening
    bool is_opening;
    bool is_kind_known;  ///< false: `kind` follows from a path opener's input
    bool is_checking;    ///< a thread asks whether a catalogue is unchanged
    uint64_t checked;    ///< slc_monotonic_time of the last check that found no change
    SluiceResult result; ///< result of the opening
    char *path;          ///< owned
    char *shown;         ///< owned; a URL without password and query, for messages; NULL: a file
    char *texture;       ///< owned; requested name; NULL: no name
    struct slc_catalogue *catalogue; ///< owned; not NULL: there is no source
    uint64_t settings_hash;          ///< settings of a picture's bake; 0: default
    struct slc_file_identity identity;
    SluiceImageFileKind kind;
    SluiceImageSource *source;         ///< owned; NULL for pictures
    SluiceImageSource *complete;       ///< owned; adds levels to `source`; NULL: complete chain
    struct slc_picture_stream *stream; ///< owned; for pictures
};

struct SluiceImageOpener {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    SluiceLogCallback cache_log;  ///< for stores of the cache folder: errors are warnings
    SluicePathOpener path_opener; ///< zeroed: no path opener
    SluiceResult (*check_path)(void *user, void *opened); ///< NULL: nothing can be checked
    char *cache_folder;                                   ///< owned; NULL: none
    uint64_t max_cache_size, max_bake_memory;
    uint32_t bake_thread_count;
    struct slc_shared_files files;
    struct slc_mutex mutex;            ///< guards the fields below; unlocked during file reads
    struct slc_condition opened;       ///< an opening has ended
    struct slc_background *background; ///< owned; NULL: no picture was opened yet
    /** Kept catalogues, most recently used first, one reference each. NULL ends the list. */
    struct slc_opened_image *kept[SLC_OPENER_CATALOGUES];
    struct slc_opened_image *buckets[SLC_OPENER_BUCKETS];
};

/** Request: arguments of one open call. */
struct slc_open_request {
    const char *path, *texture;         ///< texture NULL: none
    const SluiceBakeSettings *settings; ///< NULL: default
    uint64_t settings_hash;             ///< 0: default, or not a picture
    SluiceImageFileKind kind;
    struct slc_file_identity identity;
    bool is_entry; ///< the path comes from a catalogue
};

bool slc_opener_owns_path(const SluiceImageOpener *opener, const char *path);
SluiceResult slc_opener_open(SluiceImageOpener *opener, struct slc_open_request *r,
                             SluiceImageSource **source);
/** Removes an image from its bucket, so that later requests open again. The mutex is held. */
void slc_opener_forget(struct slc_opened_image *image);
/** Drops a counted reference. */
void slc_opener_release(struct slc_opened_image *image);

/** Functions for catalogues, in opener_catalogues.c. @{ */

/** Reads the catalogue of an image during its opening. */
SluiceResult slc_opener_read_catalogue(struct slc_opened_image *image);
/** Keeps a catalogue in memory. The mutex is held. Returns NULL, or the evicted catalogue; the
 * caller releases its reference without the mutex. */
struct slc_opened_image *slc_opener_keep(struct slc_opened_image *image);
/**
 * Tells whether the catalogue is unchanged since its read. If not, the next request reads it again.
 * Local files are always current, because their identity was compared. Other catalogues are checked
 * at most once a second, or at once if `*is_sure` is set on entry (an error raised doubt). On
 * return, `*is_sure` tells whether the catalogue is known to be unchanged since `began`.
 */
bool slc_opener_is_current(struct slc_opened_image *image, uint64_t began, bool *is_sure);
/** Opens the store in a row of `by`. `is_sure` false: errors that an outdated catalogue may cause
 * are not logged. */
SluiceResult slc_opener_open_row(struct slc_opened_image *by, const struct slc_open_request *r,
                                 bool is_sure, SluiceImageSource **source);

/** @} */

#endif /* SLC_OPEN_OPENER_H */
