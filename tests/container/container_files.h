/**
 * Makes DDS and KTX2 files from their specifications, and the expected texels. Shares no code with
 * lib/container: computes formats, sizes and offsets independently.
 */
#ifndef TESTS_CONTAINER_FILES_H
#define TESTS_CONTAINER_FILES_H

#include <sluice/image.h>

struct format_names {
    SluiceFormat format; ///< format of the image source
    uint32_t dxgi, vulkan;
    uint32_t block_size, block_extent; ///< bytes, texels
    bool is_bgra, is_opaque; ///< stored as BGRA or without alpha; delivered as RGBA with alpha 1
};

/** All formats of both kinds of file. dxgi or vulkan is 0 if a kind lacks the format. */
extern const struct format_names format_names[];
extern const uint32_t format_names_count;

/** Returns the entry with both DDS and KTX2 names, except BGRA. */
const struct format_names *format_names_of(SluiceFormat format);

struct picture {
    const struct format_names *format;
    uint32_t width, height;
    uint32_t layer_count; ///< 0: one layer, no array; cube maps: number of cubes
    bool is_cube;
    uint32_t level_count; ///< 0: all
};

struct file_bytes {
    uint8_t *bytes; ///< from malloc
    size_t size;
    size_t header_size; ///< bytes before the first texel
};

uint32_t picture_level_count(const struct picture *picture);
/** Number of layers of the image source. */
uint32_t picture_layer_count(const struct picture *picture);

/** Makes a file with a DX10 header. */
struct file_bytes make_dds(const struct picture *picture);
/** Makes a file with an old header. `pixel_format`: flags, FourCC, bits and masks. */
struct file_bytes make_old_dds(const struct picture *picture, const uint32_t pixel_format[7]);
/** `scheme` 0: plain; 2: Zstandard. */
struct file_bytes make_ktx2(const struct picture *picture, uint32_t scheme);

/** Returns the byte at `index` of one image of the file. */
uint8_t picture_byte(uint32_t layer, uint32_t level, uint64_t index);

/** A temporary file, removed at the end. */
struct scratch {
    char path[64];
    int descriptor;
};

void scratch_init(struct scratch *scratch, const struct file_bytes *file);
/** Replaces the contents. */
void scratch_replace(struct scratch *scratch, const void *bytes, size_t size);
void scratch_finish(struct scratch *scratch);

/** Checks the source's info, and all texels by levels and by rectangles, against the picture. */
void check_picture(SluiceImageSource *source, const struct picture *picture);

/** Reads all levels. Returns the first error. */
SluiceResult read_everything(SluiceImageSource *source);

/** Counts errors in the log. Each must be one line that names `path`. */
struct log_tally {
    const char *path;
    int errors;
    char last[1024];
};

/** Returns a callback that counts in `tally`. */
SluiceLogCallback log_to(struct log_tally *tally);

#endif /* TESTS_CONTAINER_FILES_H */
