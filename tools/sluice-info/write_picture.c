#include "show.h"

#include "open_file.h"
#include "text.h"
#include "to_bytes.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef HAVE_PNG
#include <png.h>
#endif

/* More than this is no picture to look at. */
#define MAX_TEXELS ((uint64_t)1 << 28)

static bool fail(const char *path, const char *why)
{
    text_say("sluice-info: %s: %s", path, why);
    return false;
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* The level, or one tile of the standard shape. */
static bool find_region(const struct options *o, const SluiceImageInfo *image,
                        SluiceImageRegion *region)
{
    uint32_t width, height;
    if (o->level >= image->mipLevelCount)
        return fail(o->files[0], "it has no such level");
    width = level_size(image->width, o->level);
    height = level_size(image->height, o->level);
    *region = (SluiceImageRegion){.mipLevel = o->level, .width = width, .height = height};
    if (!o->has_tile)
        return (uint64_t)width * height <= MAX_TEXELS ||
               fail(o->files[0], "the level is too large for a picture; name a tile");
    if (sluiceGetStandardTileShape(image->format, &region->width, &region->height) !=
        SLUICE_SUCCESS)
        return fail(o->files[0], "its format has no tiles");
    uint64_t x = (uint64_t)o->tile_x * region->width, y = (uint64_t)o->tile_y * region->height;
    if (x >= width || y >= height)
        return fail(o->files[0], "the level has no such tile");
    region->x = (uint32_t)x;
    region->y = (uint32_t)y;
    region->width = least(region->width, width - region->x);
    region->height = least(region->height, height - region->y);
    return true;
}

static bool write_png(const char *path, const uint8_t *rgba, uint32_t width, uint32_t height)
{
#ifdef HAVE_PNG
    png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height};
    image.format = PNG_FORMAT_RGBA;
    if (png_image_write_to_file(&image, path, 0, rgba, 0, NULL))
        return true;
    fail(path, image.message[0] ? image.message : strerror(errno));
    remove(path);
    return false;
#else
    (void)rgba, (void)width, (void)height;
    return fail(path, "this build writes no PNG files");
#endif
}

static bool write_region(const struct texture_file *file, const char *in,
                         const SluiceImageRegion *region, const char *out)
{
    SluiceFormat format = file->image.format;
    size_t count = (size_t)region->width * region->height;
    char *texels = malloc(count * sluiceFormatTexelSize(format));
    uint8_t *rgba = malloc(4 * count);
    bool done = false;
    if (!texels || !rgba) {
        fail(in, "out of memory");
    } else {
        SluiceResult result = sluiceReadImageRegion(
            file->source, region, texels, (size_t)region->width * sluiceFormatTexelSize(format));
        if (result == SLUICE_SUCCESS) {
            texels_to_bytes(format, texels, rgba, count);
            done = write_png(out, rgba, region->width, region->height);
        } else if (!file->has_spoken) {
            fail(in, sluiceResultString(result));
        }
    }
    free(texels);
    free(rgba);
    return done;
}

int write_picture(const struct options *options)
{
    struct texture_file file;
    SluiceImageRegion region;
    if (!open_texture_file(&file, options->files[0]))
        return NOT_SHOWN;
    bool done = false;
    if (!can_become_bytes(file.image.format))
        fail(options->files[0], "its format cannot be shown as a picture");
    else if (find_region(options, &file.image, &region))
        done = write_region(&file, options->files[0], &region, options->png);
    close_texture_file(&file);
    return done ? ALL_SHOWN : NOT_SHOWN;
}
