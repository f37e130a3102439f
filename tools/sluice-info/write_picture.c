#include "show.h"

#include "open_file.h"
#include "../common/output_file.h"
#include "png_rows.h"
#include "../common/text.h"
#include "to_bytes.h"

#include <stdio.h>
#include <stdlib.h>

/* Limit of texels: larger pictures cannot be viewed. */
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

/* Finds the region to write: the level, or one tile of the standard shape. */
static bool find_region(const struct options *o, const SluiceImageInfo *image,
                        SluiceImageRegion *region)
{
    uint32_t width, height;
    if (o->level >= image->mipLevelCount)
        return fail(o->files.items[0], "it has no such level");
    width = level_size(image->width, o->level);
    height = level_size(image->height, o->level);
    *region = (SluiceImageRegion){.mipLevel = o->level, .width = width, .height = height};
    if (!o->tile.is_given)
        return (uint64_t)width * height <= MAX_TEXELS ||
               fail(o->files.items[0], "the level is too large for a picture; name a tile");
    if (sluiceGetStandardTileShape(image->format, &region->width, &region->height) !=
        SLUICE_SUCCESS)
        return fail(o->files.items[0], "its format has no tiles");
    uint64_t x = (uint64_t)o->tile.x * region->width, y = (uint64_t)o->tile.y * region->height;
    if (x >= width || y >= height)
        return fail(o->files.items[0], "the level has no such tile");
    region->x = (uint32_t)x;
    region->y = (uint32_t)y;
    region->width = least(region->width, width - region->x);
    region->height = least(region->height, height - region->y);
    return true;
}

/* Returns the number of rows read at once. They take at most half of the memory. */
static uint32_t strip_height(const struct options *options, const SluiceImageRegion *region,
                             SluiceFormat format)
{
    uint64_t row = (uint64_t)region->width * (sluiceGetFormatTexelSize(format) + 4);
    uint32_t height = 64;
    while (height > 1 && height * row > options->memory / 2)
        height /= 2;
    return least(height, region->height);
}

/* Buffers of one strip of rows. */
struct strip {
    uint32_t height;
    char *texels;
    uint8_t *rgba;
};

/* Strips begin at multiples of the height of tiles and blocks of lines, so that most are decoded
 * once. */
static bool write_rows(struct texture_file *file, const char *in, const SluiceImageRegion *region,
                       const struct strip *strip, struct png_rows *rows)
{
    SluiceFormat format = file->image.format;
    size_t pitch = (size_t)region->width * sluiceGetFormatTexelSize(format);
    uint32_t end = region->y + region->height;
    for (uint32_t y = region->y; y < end;) {
        SluiceImageRegion part = *region;
        part.y = y;
        part.height = least(strip->height - y % strip->height, end - y);
        SluiceResult result = sluiceReadImageRegion(file->source, &part, strip->texels, pitch);
        if (result != SLUICE_SUCCESS)
            return file->has_spoken ? false : fail(in, sluiceGetResultName(result));
        texels_to_bytes(format, strip->texels, strip->rgba, (size_t)part.width * part.height);
        if (!png_rows_write(rows, strip->rgba, part.height))
            return false;
        y += part.height;
    }
    return true;
}

static bool write_strips(struct texture_file *file, const struct options *options,
                         const SluiceImageRegion *region, const struct strip *strip)
{
    struct output_file *out = output_file_begin(options->png);
    if (!out)
        return false;
    struct png_rows *rows =
        png_rows_begin(output_file_stream(out), options->png, region->width, region->height);
    bool done = rows && write_rows(file, options->files.items[0], region, strip, rows);
    done = png_rows_end(rows, done);
    return output_file_end(out, done);
}

static bool write_region(const struct options *options, struct texture_file *file,
                         const SluiceImageRegion *region)
{
    struct strip strip = {.height = strip_height(options, region, file->image.format)};
    size_t count = (size_t)region->width * strip.height;
    strip.texels = malloc(count * sluiceGetFormatTexelSize(file->image.format));
    strip.rgba = malloc(4 * count);
    bool done = strip.texels && strip.rgba ? write_strips(file, options, region, &strip)
                                           : fail(options->files.items[0], "out of memory");
    free(strip.texels);
    free(strip.rgba);
    return done;
}

int write_picture(const struct options *options)
{
    const struct texture_opening opening = {.memory = options->memory,
                                            .level_zero_alone = options->level == 0};
    struct texture_file file;
    SluiceImageRegion region;
    output_set_speaker("sluice-info: ");
    if (!output_add_input(options->files.items[0]))
        return NOT_SHOWN;
    if (!open_texture_file(&file, options->files.items[0], &opening))
        return NOT_SHOWN;
    bool done = false;
    if (!can_become_bytes(file.image.format))
        fail(options->files.items[0], "its format cannot be shown as a picture");
    else if (find_region(options, &file.image, &region))
        done = write_region(options, &file, &region);
    close_texture_file(&file);
    return done ? ALL_SHOWN : NOT_SHOWN;
}
