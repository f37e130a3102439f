/** Files that are open, by path, and what they share. */
#ifndef SLC_OPEN_OPENER_H
#define SLC_OPEN_OPENER_H

#include <sluice/open.h>

#include "image/file_pool.h"
#include "open/catalogue.h"
#include "open/file_kind.h"
#include "platform/thread.h"

#define SLC_OPENER_BUCKETS 1024u

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
    SluiceResult result; ///< of opening it
    char *path;          ///< owned
    char *shown;         ///< owned; a URL without password and query, for messages; NULL: a file
    char *texture;       ///< owned; name that was asked for; NULL: none
    struct slc_catalogue_entry entry; ///< owned; set if the path is a catalogue's: opening failed
    uint64_t settings_hash;           ///< of a picture's bake; 0: default settings
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
    char *cache_folder;           ///< owned; NULL: none
    uint64_t max_cache_size, max_bake_memory;
    uint32_t bake_thread_count;
    struct slc_shared_files files;
    struct slc_mutex mutex;            ///< around what follows; never held while files are read
    struct slc_condition opened;       ///< an image is open, or could not be opened
    struct slc_background *background; ///< owned; NULL: no picture was opened yet
    struct slc_opened_image *buckets[SLC_OPENER_BUCKETS];
};

#endif /* SLC_OPEN_OPENER_H */
