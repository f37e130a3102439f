/** A picture that is read from top to bottom: through libvips, or from an image source. */
#ifndef SLC_BAKE_PICTURE_H
#define SLC_BAKE_PICTURE_H

#include "bake/texels.h"

struct slc_picture;

struct slc_picture_interface {
    /** Row `y`, which follows the row read before or is 0 after (re)opening. Valid until the next
     *  call. */
    SluiceResult (*row)(struct slc_picture *picture, uint32_t y, const void **samples);
    /** Row 0 comes next. */
    SluiceResult (*rewind)(struct slc_picture *picture);
    void (*close)(struct slc_picture *picture);
};

struct slc_picture {
    const struct slc_picture_interface *implementation;
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    const char *name; ///< for messages; lives as long as the picture
    uint32_t width, height;
    uint32_t layer_count; ///< at least 1
    uint32_t layer;       ///< whose rows are read; set it, then rewind
    bool cube;            ///< the layers are faces of cube maps
    enum slc_sample sample;
    SluiceFormat texels;    ///< of SLC_SAMPLE_TEXELS
    uint32_t channels;      ///< 1 to 4
    bool alpha;             ///< the last of 2 or 4 channels is alpha
    bool premultiplied;     ///< where nobody says otherwise
    bool srgb;              ///< where nobody says otherwise
    bool halves_suffice;    ///< 32-bit floats that were made from shorter ones
    uint64_t memory;        ///< bytes that reading takes, roughly
    uint64_t unpacked_size; ///< of these, for a file that is unpacked as a whole
    bool foreign_primaries; ///< colors are in other primaries than those of Rec. 709
    /** Set for block-compressed data and for integers: all levels are read from here, and nothing
     *  is filtered. */
    SluiceImageSource *levels;
};

struct slc_picture_opening {
    uint64_t max_memory;      ///< bytes that reading may take at most
    bool keep_primaries;      ///< of OpenEXR files
    const SluiceInput *input; ///< NULL: the file; else the path is a name
    uint32_t first_level;     ///< of pictures that libvips reads
};

/**
 * Opens a file by what it begins with: OpenEXR, DDS and KTX2 where this build reads them, all else
 * with libvips. Errors: as sluiceBakeFile; logged.
 */
SluiceResult slc_picture_open(const char *path, const struct slc_picture_opening *opening,
                              const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                              struct slc_picture **picture);

/**
 * Level 0 of a source, or all levels if it is block-compressed or has integers. Levels of integers
 * that are missing are picked. `owned`: closing destroys the source.
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
