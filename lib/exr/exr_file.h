/**
 * OpenEXR file, open for reading, with a checked header. Constant while open, so any number of
 * threads may read.
 *
 * Only the first part of a multi-part file is read.
 */
#ifndef SLC_EXR_EXR_FILE_H
#define SLC_EXR_EXR_FILE_H

#include <sluice/image.h>

#include "exr/primaries.h"
#include "image/input_file.h"

#include <openexr.h>

#include <stdatomic.h>

/** Largest width and height, equal to the limit of textures. */
#define SLC_EXR_MAX_SIZE (1u << 20)
/** Most channels to read: R, G, B, A or Y, A. */
#define SLC_EXR_MAX_CHANNELS 4
/** Most channels of a file. Keeps the bytes of a chunk far below 2^64. */
#define SLC_EXR_MAX_FILE_CHANNELS 1024

enum slc_exr_layout {
    SLC_EXR_SCANLINES,
    SLC_EXR_ONE_LEVEL, ///< tiles of level 0 alone
    SLC_EXR_MIPMAP,
    SLC_EXR_RIPMAP
};

struct slc_exr_channel {
    exr_pixel_type_t type;
    uint32_t size;   ///< bytes per texel: 2 or 4
    uint32_t offset; ///< bytes per texel of all earlier channels in the file
};

struct slc_exr_file {
    struct slc_input_file input;
    /** SluiceResult of the last failed read. The end of the file is no failure here. */
    atomic_int system_failure;
    exr_context_t context;

    enum slc_exr_layout layout;
    exr_compression_t compression;
    uint32_t width, height;
    int32_t first_line;                 ///< y of the first row in the file
    uint32_t chunk_width, chunk_height; ///< size of a tile or block of lines
    int32_t chunk_count;
    int32_t level_count_x, level_count_y; ///< in the file
    uint64_t chunk_table_offset;          ///< for rip maps only
    bool is_multipart;

    char channel_names[256]; ///< all names of the file, as many as fit
    uint32_t channel_count;  ///< channels to read; the file may have others
    struct slc_exr_channel channels[SLC_EXR_MAX_CHANNELS]; ///< channels to read, in file order
    int32_t rgba[4];         ///< index of the channel for R, G, B and A; -1: none
    uint32_t texel_size;     ///< bytes of all channels of the file
    exr_pixel_type_t widest; ///< widest type among the channels to read

    bool has_chromaticities;
    struct slc_chromaticities chromaticities;
    bool is_foreign; ///< R, G and B are delivered in primaries other than Rec. 709
    bool converts;   ///< R, G and B are multiplied by the matrix below
    double to_rec709[3][3];
};

/**
 * Opens a file and checks its header. Errors: the same as sluiceCreateExrImageSource. Each error is
 * logged once, with the path and a remedy.
 */
SluiceResult slc_exr_file_open(struct slc_exr_file *file, const struct slc_input_choice *choice,
                               const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);

/** Closes the file. Call it also after a failed open. */
void slc_exr_file_close(struct slc_exr_file *file);

/** Converts a result of OpenEXRCore's read functions. */
SluiceResult slc_exr_result(const struct slc_exr_file *file, exr_result_t result);

/** Fills the fields that describe the image from the open context. Errors are logged. */
SluiceResult slc_exr_read_header(struct slc_exr_file *file);

/** Chooses the channels to read. Errors: CORRUPT_DATA, UNSUPPORTED; logged. */
SluiceResult slc_exr_read_channels(struct slc_exr_file *file);

/** Decides whether to convert R, G and B. Logs attributes that are ignored. */
SluiceResult slc_exr_read_primaries(struct slc_exr_file *file);

/** Finds the size of a level of the file. A rip map repeats the last size of the shorter direction.
 */
SluiceResult slc_exr_level_size(const struct slc_exr_file *file, uint32_t level, uint32_t *width,
                                uint32_t *height);

#endif /* SLC_EXR_EXR_FILE_H */
