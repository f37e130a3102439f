/** One file of a picture: what it is, and the source that reads it in place. */
#ifndef SAMPLES_STREAMING_PICTURE_FILE_H
#define SAMPLES_STREAMING_PICTURE_FILE_H

#include <sluice/exr.h>
#include <sluice/store.h>

#include "../../tools/common/picture_names.h"
#include "settings.h"

/** Files of folders that are looked at. */
#define HANGABLE_SUFFIXES SLUICE_STORE_EXTENSION "|" PICTURE_SUFFIXES

enum picture_kind {
    PICTURE_STORE,
    PICTURE_EXR,            ///< tiled and with levels: any tile is read by itself
    PICTURE_EXR_LEVEL_ZERO, ///< has to be read whole before anything of it can be shown
    PICTURE_DDS,
    PICTURE_KTX2,
    PICTURE_OTHER ///< for libvips
};

/**
 * By the first bytes. Errors: NOT_READY for want of file descriptors, not said; IO, also for a pipe
 * or a device, said on stderr.
 */
SluiceResult picture_file_kind(const char *path, enum picture_kind *kind);

/** What is read in place: neither stores of a build that has none, nor what only libvips reads. */
struct picture_opening {
    enum pixel_format pixels;  ///< of OpenEXR files; others deliver what is in them
    SluiceStoreReadPool *pool; ///< for all stores; outlives them
    /** For OpenEXR files without levels together; outlives them. NULL: each has the library's
     *  default. */
    SluiceExrMemoryBudget *memory;
    const SluiceInput *input; ///< of a store on a server; NULL: the path is a file
};

/** Says on stderr why it failed. UNSUPPORTED for PICTURE_OTHER. */
SluiceResult picture_file_open(const char *path, enum picture_kind kind,
                               const struct picture_opening *opening, SluiceImageSource **source,
                               SluiceImageInfo *info);

/** What OpenEXR files are streamed as: never floats of 32 bits, which a screen cannot show. */
SluiceResult picture_file_exr_format(const char *path, enum pixel_format pixels,
                                     SluiceFormat *format);

#endif /* SAMPLES_STREAMING_PICTURE_FILE_H */
