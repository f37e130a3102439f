/**
 * One OpenEXR file open for reading, its header checked and understood: what the rest of this layer
 * knows of a file. Constant once it is open, so any number of threads may read through it.
 *
 * Only the first part of a file is looked at.
 */
#ifndef SLC_EXR_EXR_FILE_H
#define SLC_EXR_EXR_FILE_H

#include <sluice/image.h>

#include "exr/primaries.h"
#include "image/input_file.h"

#include <openexr.h>

#include <stdatomic.h>

/** Largest width and height; a texture cannot be larger either. */
#define SLC_EXR_MAX_SIZE (1u << 20)
/** Channels that are read: R, G, B, A or Y, A. */
#define SLC_EXR_MAX_CHANNELS 4
/** Channels that a file may have, so that the bytes of a chunk stay far below 2^64. */
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
    uint32_t offset; ///< bytes per texel of the channels before it in the file
};

struct slc_exr_file {
    struct slc_input_file input;
    /** SluiceResult of the last read that failed for another reason than the file's end. */
    atomic_int system_failure;
    exr_context_t context;

    enum slc_exr_layout layout;
    exr_compression_t compression;
    uint32_t width, height;
    int32_t first_line;                 ///< the y that the file gives to the first row
    uint32_t chunk_width, chunk_height; ///< of the tiles, or of the blocks of lines
    int32_t chunk_count;
    int32_t level_count_x, level_count_y; ///< in the file
    uint64_t chunk_table_offset;          ///< for rip maps only
    bool is_multipart;

    char channel_names[256]; ///< of the file, as far as they fit
    uint32_t channel_count;  ///< that are read; the file may have others
    struct slc_exr_channel channels[SLC_EXR_MAX_CHANNELS]; ///< that are read, in the file's order
    int32_t rgba[4];         ///< index of the channel that R, G, B and A come from, -1: none
    uint32_t texel_size;     ///< bytes of all channels of the file
    exr_pixel_type_t widest; ///< of the channels that are read

    bool has_chromaticities;
    struct slc_chromaticities chromaticities;
    bool is_foreign; ///< R, G and B are delivered in other primaries than those of Rec. 709
    bool converts;   ///< R, G and B are multiplied by:
    double to_rec709[3][3];
};

/**
 * Opens a file and checks its header. Errors as sluiceCreateExrImageSource has them; each one is
 * logged once, with the path and what to do.
 */
SluiceResult slc_exr_file_open(struct slc_exr_file *file, const struct slc_input_choice *choice,
                               const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);

/** Also after a failed open. */
void slc_exr_file_close(struct slc_exr_file *file);

/** What a result of OpenEXRCore is in ours, for reading. */
SluiceResult slc_exr_result(const struct slc_exr_file *file, exr_result_t result);

/** Fills the fields that describe the image from the open context. Errors are logged. */
SluiceResult slc_exr_read_header(struct slc_exr_file *file);

/** Chooses the channels to read. Errors: CORRUPT_DATA, UNSUPPORTED; logged. */
SluiceResult slc_exr_read_channels(struct slc_exr_file *file);

/** Finds out whether R, G and B are to be converted. Says what is not applied. */
SluiceResult slc_exr_read_primaries(struct slc_exr_file *file);

/** Size of a level of the file. Levels beyond those of one direction repeat its last. */
SluiceResult slc_exr_level_size(const struct slc_exr_file *file, uint32_t level, uint32_t *width,
                                uint32_t *height);

#endif /* SLC_EXR_EXR_FILE_H */
