/**
 * DDS and KTX2 files made from their specifications, and what must be read of them. Shares nothing
 * with lib/container: formats, sizes and places are worked out here again.
 */
#ifndef TESTS_CONTAINER_FILES_H
#define TESTS_CONTAINER_FILES_H

#include <sluice/image.h>

struct format_names {
    SluiceFormat format; ///< as which it is delivered
    uint32_t dxgi, vulkan;
    uint32_t block_size, block_extent; ///< bytes, texels
    bool is_bgra, is_opaque;           ///< stored so, delivered as RGBA, with alpha 1
};

/** Every format that both kinds of file have; dxgi or vulkan is 0 where one has not. */
extern const struct format_names format_names[];
extern const uint32_t format_names_count;

/** The one that DDS and KTX2 have for this format, BGRA left out. */
const struct format_names *format_names_of(SluiceFormat format);

struct picture {
    const struct format_names *format;
    uint32_t width, height;
    uint32_t layer_count; ///< 0: 1 and no array; of a cube map: cubes
    bool is_cube;
    uint32_t level_count; ///< 0: all
};

struct file_bytes {
    uint8_t *bytes; ///< from malloc
    size_t size;
    size_t header_size; ///< bytes before the first texel
};

uint32_t picture_level_count(const struct picture *picture);
/** Layers that are delivered. */
uint32_t picture_layer_count(const struct picture *picture);

/** With a DX10 header. */
struct file_bytes make_dds(const struct picture *picture);
/** With an old one: flags, FourCC, bits and masks are the 7 words of the pixel format. */
struct file_bytes make_old_dds(const struct picture *picture, const uint32_t pixel_format[7]);
/** `scheme`: 0: plain, 2: Zstandard. */
struct file_bytes make_ktx2(const struct picture *picture, uint32_t scheme);

/** The byte at `index` of one image of the file. */
uint8_t picture_byte(uint32_t layer, uint32_t level, uint64_t index);

/** A file of its own, which is removed at the end. */
struct scratch {
    char path[64];
    int descriptor;
};

void scratch_init(struct scratch *scratch, const struct file_bytes *file);
/** Puts other contents into it. */
void scratch_replace(struct scratch *scratch, const void *bytes, size_t size);
void scratch_finish(struct scratch *scratch);

/** What a source says of itself and all of its texels, by levels and by rectangles, is the picture.
 */
void check_picture(SluiceImageSource *source, const struct picture *picture);

/** Reads all of all levels; the first error. */
SluiceResult read_everything(SluiceImageSource *source);

/** Errors in the log, each one line that names `path`. */
struct log_tally {
    const char *path;
    int errors;
    char last[1024];
};

/** A SluiceLogCallback that counts. */
SluiceLogCallback log_to(struct log_tally *tally);

#endif /* TESTS_CONTAINER_FILES_H */
