/** Picture that is read from top to bottom, through libvips or from an image source. */
#ifndef SLC_BAKE_PICTURE_H
#define SLC_BAKE_PICTURE_H

#include "bake/texels.h"

struct slc_picture;

struct slc_picture_interface {
    /** Reads row `y`: the row after the last one, or 0 after opening and rewind. `*samples` is
     * valid until the next call. */
    SluiceResult (*row)(struct slc_picture *picture, uint32_t y, const void **samples);
    /** Rewinds to row 0. */
    SluiceResult (*rewind)(struct slc_picture *picture);
    void (*close)(struct slc_picture *picture);
};

struct slc_picture {
    const struct slc_picture_interface *implementation;
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    const char *name; ///< name for messages; valid as long as the picture
    uint32_t width, height;
    uint32_t layer_count; ///< at least 1
    uint32_t layer;       ///< layer whose rows are read; set it, then rewind
    bool cube;            ///< the layers are faces of cube maps
    enum slc_sample sample;
    SluiceFormat texels;    ///< SLC_SAMPLE_TEXELS: their format
    uint32_t channels;      ///< 1 to 4
    bool alpha;             ///< the last of 2 or 4 channels is alpha
    bool premultiplied;     ///< default, unless the settings say otherwise
    bool srgb;              ///< default, unless the settings say otherwise
    bool halves_suffice;    ///< the 32-bit floats were converted from shorter numbers
    uint64_t memory;        ///< approximate bytes that reading takes
    uint64_t unpacked_size; ///< part of `memory` for a file that is unpacked as a whole
    bool foreign_primaries; ///< colors have other primaries than Rec. 709
    /** Source of all levels for block-compressed data and integers, which are not filtered. Else
     *  NULL. */
    SluiceImageSource *levels;
};

struct slc_picture_opening {
    uint64_t max_memory;      ///< most bytes that reading may take
    bool keep_primaries;      ///< for OpenEXR files
    const SluiceInput *input; ///< NULL: the file; else the path is only a name
    uint32_t first_level;     ///< first level, for pictures that libvips reads
};

/**
 * Opens a file by its first bytes: OpenEXR, DDS and KTX2 if this build reads them, all others with
 * libvips. Errors: as sluiceBakeFile; logged.
 */
SluiceResult slc_picture_open(const char *path, const struct slc_picture_opening *opening,
                              const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                              struct slc_picture **picture);

/**
 * Makes a picture of a source: level 0, or all levels if it is block-compressed or has integers.
 * Missing levels of integers are picked. `owned`: closing destroys the source.
 */
SluiceResult slc_picture_of_source(SluiceImageSource *source, bool owned, const char *name,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceLogCallback *log, struct slc_picture **picture);

SluiceResult slc_picture_open_vips(const char *path, const struct slc_picture_opening *opening,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceLogCallback *log, struct slc_picture **picture);

/** NULL is allowed. */
void slc_picture_close(struct slc_picture *picture);

#endif /* SLC_BAKE_PICTURE_H */
