/** Kind of a picture's file, and sources that read the file in place. */
#ifndef SAMPLES_STREAMING_PICTURE_FILE_H
#define SAMPLES_STREAMING_PICTURE_FILE_H

#include <sluice/exr.h>
#include <sluice/store.h>

#include "../../tools/common/picture_names.h"
#include "settings.h"

/** Suffixes of files in folders that are shown. */
#define HANGABLE_SUFFIXES SLUICE_STORE_EXTENSION "|" PICTURE_SUFFIXES

enum picture_kind {
    PICTURE_STORE,
    PICTURE_EXR,            ///< tiled and with levels: tiles can be read one by one
    PICTURE_EXR_LEVEL_ZERO, ///< must be read whole before any tile is available
    PICTURE_DDS,
    PICTURE_KTX2,
    PICTURE_OTHER ///< read by libvips
};

/**
 * Detects the kind from the first bytes. Errors: NOT_READY without free file descriptors (not
 * printed); IO, also for a pipe or a device (printed on stderr).
 */
SluiceResult picture_file_kind(const char *path, enum picture_kind *kind);

/** Options to open a file in place. Fails for stores if the build has none, and for
 * PICTURE_OTHER. */
struct picture_opening {
    enum pixel_format pixels;  ///< format for OpenEXR files; other files keep their own
    SluiceStoreReadPool *pool; ///< shared by all stores; must outlive them
    /** Shared by all OpenEXR files without levels; must outlive them. NULL: each file has the
     * library's default budget. */
    SluiceExrMemoryBudget *memory;
    const SluiceInput *input; ///< input for a store on a server; NULL: the path is a file
};

/** Reports errors on stderr. Returns UNSUPPORTED for PICTURE_OTHER. */
SluiceResult picture_file_open(const char *path, enum picture_kind kind,
                               const struct picture_opening *opening, SluiceImageSource **source,
                               SluiceImageInfo *info);

/** Chooses the format in which an OpenEXR file is streamed. Never 32-bit floats, which exceed what
 * screens show. */
SluiceResult picture_file_exr_format(const char *path, enum pixel_format pixels,
                                     SluiceFormat *format);

#endif /* SAMPLES_STREAMING_PICTURE_FILE_H */
