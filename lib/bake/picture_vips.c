#include "bake/picture.h"

#include "bake/vips_warnings.h"
#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "image/input_file.h"

#include <string.h>

#include <vips/vips.h>

/* Rows of one request. libvips decodes about as many rows ahead. */
#define STRIP 64u

struct vips_picture {
    struct slc_picture base;
    char *path;
    const void *bytes; ///< borrowed, or `copy`; NULL: libvips reads the file
    void *copy;        ///< owned; bytes from a callback
    size_t size;
    uint32_t first_level;
    VipsImage *image;
    uint64_t whole_size;  ///< bytes of the file's texels
    uint64_t loaded_size; ///< bytes from the loader; fewer if it shrinks a JPEG
    uint64_t loaded_pitch;
    VipsRegion *region;
    uint32_t first, count; ///< rows in the region
    int orientation;       ///< 1 to 8, as EXIF counts them
    struct slc_vips_warnings warnings;
};

/* Logs one line of libvips's error buffer. The whole process shares this buffer. */
static SluiceResult fail(const struct vips_picture *picture, SluiceResult result)
{
    char *text = vips_error_buffer_copy();
    char *end = strchr(text, '\n');
    if (end)
        *end = '\0';
    slc_log(&picture->base.log, SLUICE_LOG_ERROR, "%s: %s", picture->path,
            *text ? text : "libvips cannot read it");
    g_free(text);
    return result;
}

static SluiceResult unsupported(const struct vips_picture *picture, const char *what)
{
    slc_log(&picture->base.log, SLUICE_LOG_ERROR, "%s: %s", picture->path, what);
    return SLUICE_ERROR_UNSUPPORTED;
}

/* Replaces an image by its successor. `made` is a pointer because the call that yields `status`
 * sets the successor. */
static bool replace(VipsImage **image, int status, VipsImage *const *made)
{
    if (status != 0)
        return false;
    g_object_unref(*image);
    *image = *made;
    return true;
}

static bool is_another_space(VipsInterpretation space)
{
    switch (space) {
    case VIPS_INTERPRETATION_XYZ:
    case VIPS_INTERPRETATION_LAB:
    case VIPS_INTERPRETATION_CMYK:
    case VIPS_INTERPRETATION_LABQ:
    case VIPS_INTERPRETATION_CMC:
    case VIPS_INTERPRETATION_LCH:
    case VIPS_INTERPRETATION_LABS:
    case VIPS_INTERPRETATION_YXY:
    case VIPS_INTERPRETATION_HSV: return true;
    default: return false;
    }
}

static bool convert(VipsImage **image, bool *was_short)
{
    VipsImage *made = NULL;
    *was_short = vips_image_get_coding(*image) == VIPS_CODING_RAD;
    if (*was_short && !replace(image, vips_rad2float(*image, &made, NULL), &made))
        return false;
    if (is_another_space(vips_image_guess_interpretation(*image)) &&
        !replace(image, vips_colourspace(*image, &made, VIPS_INTERPRETATION_sRGB, NULL), &made))
        return false;
    VipsBandFormat format = vips_image_get_format(*image);
    bool is_kept =
        format == VIPS_FORMAT_UCHAR || format == VIPS_FORMAT_USHORT || format == VIPS_FORMAT_FLOAT;
    return is_kept || replace(image, vips_cast_float(*image, &made, NULL), &made);
}

/* Returns loader options. The JPEG decoder delivers an eighth of the size faster than all of it. */
static const char *loader_options(const struct vips_picture *picture)
{
    static const char *const shrinks[] = {"", "[shrink=2]", "[shrink=4]", "[shrink=8]"};
    const char *loader = picture->bytes
                             ? vips_foreign_find_load_buffer(picture->bytes, picture->size)
                             : vips_foreign_find_load(picture->path);
    bool is_jpeg = loader && strncmp(loader, "VipsForeignLoadJpeg", 19) == 0;
    return shrinks[is_jpeg ? slc_min_u32(picture->first_level, 3) : 0];
}

static VipsImage *open_image(const struct vips_picture *picture, VipsAccess access)
{
    const char *options = loader_options(picture);
    if (picture->bytes)
        return vips_image_new_from_buffer(picture->bytes, picture->size, options, "access", access,
                                          "fail_on", VIPS_FAIL_ON_TRUNCATED, NULL);
    if (*options) {
        VipsImage *image = NULL;
        int shrink = options[8] - '0';
        if (vips_jpegload(picture->path, &image, "shrink", shrink, "access", access, "fail_on",
                          VIPS_FAIL_ON_TRUNCATED, NULL) != 0)
            return NULL;
        return image;
    }
    return vips_image_new_from_file(picture->path, "access", access, "fail_on",
                                    VIPS_FAIL_ON_TRUNCATED, NULL);
}

/* Shrinks the image to the size of level `first_level`. `width` and `height`: size of level 0. */
static bool shrink_image(struct vips_picture *picture, uint32_t width, uint32_t height)
{
    VipsImage *made = NULL, *image = picture->image;
    double x = slc_mip_size(width, picture->first_level);
    double y = slc_mip_size(height, picture->first_level);
    int status = vips_resize(image, &made, x / vips_image_get_width(image), "vscale",
                             y / vips_image_get_height(image), "kernel", VIPS_KERNEL_LINEAR, NULL);
    return replace(&picture->image, status, &made) && vips_image_get_width(picture->image) == x &&
           vips_image_get_height(picture->image) == y;
}

/* Turns the picture as its EXIF tag says. Opens the picture again, because a turn reads rows in any
 * order. */
static bool turn(struct vips_picture *picture)
{
    VipsImage *made = NULL;
    picture->orientation = vips_image_get_orientation(picture->image);
    if (picture->orientation <= 1)
        return true;
    VipsImage *whole = open_image(picture, VIPS_ACCESS_RANDOM);
    return whole && replace(&picture->image, 0, &whole) &&
           replace(&picture->image, vips_autorot(picture->image, &made, NULL), &made);
}

/* Finds the size of the picture after the turn and before it is shrunk. Reads the header. */
static bool find_whole_size(const struct vips_picture *picture, uint32_t *width, uint32_t *height)
{
    struct vips_picture whole = {
        .path = picture->path, .bytes = picture->bytes, .size = picture->size};
    whole.image = open_image(&whole, VIPS_ACCESS_SEQUENTIAL);
    if (!whole.image)
        return false;
    bool is_turned = vips_image_get_orientation_swap(whole.image);
    uint32_t x = (uint32_t)vips_image_get_width(whole.image);
    uint32_t y = (uint32_t)vips_image_get_height(whole.image);
    g_object_unref(whole.image);
    *width = is_turned ? y : x;
    *height = is_turned ? x : y;
    return true;
}

/* Measures the picture before it is turned and shrunk. `width`, `height`: level 0, for previews. */
static void measure(struct vips_picture *picture, uint32_t width, uint32_t height)
{
    VipsImage *image = picture->image;
    picture->loaded_size = VIPS_IMAGE_SIZEOF_IMAGE(image);
    picture->whole_size = picture->first_level > 0
                              ? (uint64_t)VIPS_IMAGE_SIZEOF_PEL(image) * width * height
                              : picture->loaded_size;
    picture->loaded_pitch = VIPS_IMAGE_SIZEOF_LINE(image);
}

static SluiceResult load_image(struct vips_picture *picture)
{
    uint32_t width = 0, height = 0;
    if (picture->first_level > 0 && !find_whole_size(picture, &width, &height))
        return fail(picture, SLUICE_ERROR_CORRUPT_DATA);
    if (picture->first_level > 0 &&
        picture->first_level >= slc_mip_count(slc_max_u32(width, height)))
        return unsupported(picture, "it has no level firstLevel");
    picture->image = open_image(picture, VIPS_ACCESS_SEQUENTIAL);
    if (!picture->image)
        return fail(picture, SLUICE_ERROR_CORRUPT_DATA);
    measure(picture, width, height);
    if (!turn(picture))
        return fail(picture, SLUICE_ERROR_CORRUPT_DATA);
    if (vips_band_format_iscomplex(vips_image_get_format(picture->image)))
        return unsupported(picture, "complex numbers are no colors");
    if (!convert(&picture->image, &picture->base.halves_suffice))
        return fail(picture, SLUICE_ERROR_CORRUPT_DATA);
    if (picture->first_level > 0 && !shrink_image(picture, width, height))
        return fail(picture, SLUICE_ERROR_CORRUPT_DATA);
    if (vips_image_get_bands(picture->image) > 4)
        return unsupported(picture, "it has more than four channels");
    if (vips_image_get_width(picture->image) > 1 << 20 ||
        vips_image_get_height(picture->image) > 1 << 20)
        return unsupported(picture, "it has more than 2^20 texels in a direction");
    picture->region = vips_region_new(picture->image);
    return picture->region ? SLUICE_SUCCESS : fail(picture, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
}

static SluiceResult load(struct vips_picture *picture)
{
    slc_vips_warnings_enter(&picture->warnings);
    SluiceResult result = load_image(picture);
    slc_vips_warnings_leave(&picture->warnings);
    return result;
}

/* Frees the image. libvips warns about a damaged JPEG at this point. */
static void unload(struct vips_picture *picture)
{
    slc_vips_warnings_enter(&picture->warnings);
    if (picture->region)
        g_object_unref(picture->region);
    if (picture->image)
        g_object_unref(picture->image);
    slc_vips_warnings_leave(&picture->warnings);
    picture->region = NULL;
    picture->image = NULL;
    picture->first = picture->count = 0;
}

static SluiceResult row(struct slc_picture *base, uint32_t y, const void **samples)
{
    struct vips_picture *picture = (struct vips_picture *)base;
    if (y >= picture->first + picture->count) {
        picture->first = y;
        picture->count = slc_min_u32(STRIP, base->height - y);
        VipsRect rect = {0, (int)y, (int)base->width, (int)picture->count};
        slc_vips_warnings_enter(&picture->warnings);
        SluiceResult result = SLUICE_SUCCESS;
        if (vips_region_prepare(picture->region, &rect) != 0)
            result = fail(picture, SLUICE_ERROR_CORRUPT_DATA);
        slc_vips_warnings_leave(&picture->warnings);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    *samples = VIPS_REGION_ADDR(picture->region, 0, (int)y);
    return SLUICE_SUCCESS;
}

static SluiceResult rewind_picture(struct slc_picture *base)
{
    struct vips_picture *picture = (struct vips_picture *)base;
    unload(picture);
    return load(picture);
}

static void close_picture(struct slc_picture *base)
{
    struct vips_picture *picture = (struct vips_picture *)base;
    SluiceAllocationCallbacks cb = base->allocator;
    unload(picture);
    slc_free(&cb, picture->copy, picture->size, 1);
    slc_free(&cb, picture->path, picture->path ? strlen(picture->path) + 1 : 0, 1);
    slc_free(&cb, picture, 1, sizeof *picture);
}

static const struct slc_picture_interface vips_interface = {row, rewind_picture, close_picture};

static bool has_flag(VipsImage *image, const char *name)
{
    int value = 0;
    return vips_image_get_typeof(image, name) != 0 &&
           vips_image_get_int(image, name, &value) == 0 && value != 0;
}

/*
 * Returns the memory of libvips and its loaders in multiples of the unpacked picture. 0: the loader
 * reads from top to bottom and keeps only some rows. Measured with libvips 8.14,
 * 12000 x 12000 texels: interlaced PNG 0.9, progressive JPEG 1.0 (up to 2 without subsampling),
 * WebP 2.6, GIF 1.0. Shrinking saves nothing: 8000 x 8000 texels of a progressive JPEG by 8, 1.1
 * (2.0 without subsampling).
 */
static uint32_t times_unpacked(VipsImage *image)
{
    static const struct {
        const char *loader, *flag;
        uint32_t times;
    } loaders[] = {{"pngload", "interlaced", 1}, {"jpegload", "jpeg-multiscan", 2},
                   {"webpload", NULL, 3},        {"gifload", NULL, 2},
                   {"heifload", NULL, 3},        {"jxlload", NULL, 5},
                   {"magickload", NULL, 8}};
    const char *loader;
    if (vips_image_get_typeof(image, VIPS_META_LOADER) == 0 ||
        vips_image_get_string(image, VIPS_META_LOADER, &loader) != 0)
        return 0;
    for (size_t i = 0; i < sizeof loaders / sizeof loaders[0]; i++)
        if (strncmp(loader, loaders[i].loader, strlen(loaders[i].loader)) == 0 &&
            (!loaders[i].flag || has_flag(image, loaders[i].flag)))
            return loaders[i].times;
    return 0;
}

static void describe(struct vips_picture *picture)
{
    struct slc_picture *base = &picture->base;
    VipsImage *image = picture->image;
    VipsBandFormat format = vips_image_get_format(image);
    base->layer_count = 1;
    base->width = (uint32_t)vips_image_get_width(image);
    base->height = (uint32_t)vips_image_get_height(image);
    base->channels = (uint32_t)vips_image_get_bands(image);
    base->alpha = base->channels == 4 || (base->channels == 2 && vips_image_hasalpha(image) != 0);
    base->sample = format == VIPS_FORMAT_UCHAR    ? SLC_SAMPLE_U8
                   : format == VIPS_FORMAT_USHORT ? SLC_SAMPLE_U16
                                                  : SLC_SAMPLE_F32;
    base->srgb =
        base->sample != SLC_SAMPLE_F32 && base->channels > 1 && (base->channels > 2 || base->alpha);
    uint64_t pitch = (uint64_t)base->width * base->channels * slc_sample_size(base->sample);
    pitch = pitch > picture->loaded_pitch ? pitch : picture->loaded_pitch;
    /* Two rows of tiles in the file (rarely higher than 512), a strip, and 16 MiB for libvips. */
    base->memory = pitch * (2 * 512 + STRIP) + ((uint64_t)16 << 20);
    base->unpacked_size = times_unpacked(image) * picture->whole_size;
    if (picture->orientation > 1)
        base->unpacked_size += picture->loaded_size;
    base->memory += base->unpacked_size + (picture->copy ? picture->size : 0);
}

/* Gives the input's bytes to libvips. Sluice has checked the input. */
static SluiceResult take_bytes(struct vips_picture *picture, const SluiceInput *input)
{
    const struct slc_input_choice choice = {.path = picture->path, .input = input};
    const SluiceAllocationCallbacks *cb = &picture->base.allocator;
    struct slc_input_file file;
    SluiceResult result = slc_input_file_init_choice(&file, &choice, cb, &picture->base.log);
    if (result == SLUICE_SUCCESS)
        result = slc_input_file_open(&file);
    picture->bytes = file.input.pBytes;
    picture->size = (size_t)file.input.size;
    if (result == SLUICE_SUCCESS && !picture->bytes) {
        picture->bytes = picture->copy = slc_alloc(cb, picture->size, 1);
        result = picture->copy ? slc_input_file_read(&file, 0, picture->copy, picture->size)
                               : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    slc_input_file_finish(&file);
    return result;
}

SluiceResult slc_picture_open_vips(const char *path, const struct slc_picture_opening *opening,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceLogCallback *log, struct slc_picture **opened)
{
    struct vips_picture *picture = slc_calloc(cb, 1, sizeof *picture);
    if (!picture)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    picture->base.implementation = &vips_interface;
    picture->base.allocator = *cb;
    picture->base.log = *log;
    picture->path = slc_strdup(cb, path);
    picture->base.name = picture->path;
    picture->warnings.path = picture->path;
    picture->warnings.log = &picture->base.log;
    picture->first_level = opening->first_level;
    SluiceResult result = picture->path ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS && opening->input)
        result = take_bytes(picture, opening->input);
    if (result == SLUICE_SUCCESS)
        result = load(picture);
    if (result != SLUICE_SUCCESS) {
        close_picture(&picture->base);
        return result;
    }
    describe(picture);
    if (picture->orientation > 1)
        slc_log(log, SLUICE_LOG_INFO, "%s: turned as its EXIF orientation %d says", path,
                picture->orientation);
    *opened = &picture->base;
    return SLUICE_SUCCESS;
}
