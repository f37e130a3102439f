#include "pictures.h"

#include <sluice/exr.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_message(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    (void)severity;
    fprintf(stderr, "%s\n", message);
}

static const SluiceLogCallback log_to_stderr = {NULL, print_message};

static void must(SluiceResult result, const char *what)
{
    if (result == SLUICE_SUCCESS)
        return;
    fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
    exit(1);
}

/* The next number of a header; comments go to the end of their line. */
static bool read_number(FILE *file, uint32_t *number)
{
    int c = ' ';
    while (c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '#') {
        if (c == '#')
            while (c != '\n' && c != EOF)
                c = fgetc(file);
        c = fgetc(file);
    }
    ungetc(c, file);
    return fscanf(file, "%u", number) == 1;
}

static unsigned char *read_ppm(FILE *file, uint32_t *width, uint32_t *height)
{
    uint32_t maximum;
    if (fgetc(file) != 'P' || fgetc(file) != '6' || !read_number(file, width) ||
        !read_number(file, height) || !read_number(file, &maximum) || maximum != 255 ||
        fgetc(file) == EOF || *width == 0 || *height == 0 || *width > 65536 || *height > 65536)
        return NULL;
    size_t count = (size_t)*width * *height;
    unsigned char *texels = malloc(count * 4);
    if (!texels || fread(texels + count, 3, count, file) != count) {
        free(texels);
        return NULL;
    }
    for (size_t i = 0; i < count; i++) { /* three bytes at the end move apart to the front */
        const unsigned char rgba[4] = {texels[count + 3 * i], texels[count + 3 * i + 1],
                                       texels[count + 3 * i + 2], 255};
        memcpy(texels + 4 * i, rgba, 4);
    }
    return texels;
}

static SluiceImageSource *open_ppm(const char *path)
{
    FILE *file = fopen(path, "rb");
    SluiceImageInfo info = {
        .structSize = sizeof info, .format = SLUICE_FORMAT_R8G8B8A8_SRGB, .pName = path};
    unsigned char *texels = file ? read_ppm(file, &info.width, &info.height) : NULL;
    SluiceImageSource *source = NULL;
    if (texels)
        must(sluiceCreateMemoryImageSource(texels, &info, NULL, &source), path);
    else
        fprintf(stderr, "%s: is not a PPM file of 8 bits\n", path);
    free(texels);
    if (file)
        fclose(file);
    return source;
}

SluiceImageSource *open_exr(const char *path, SluiceFormat format)
{
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = path,
                                             .format = format,
                                             .log = log_to_stderr,
                                             .maxMemorySize = UINT64_MAX};
    SluiceImageSource *source = NULL;
    return sluiceCreateExrImageSource(&create, &source) == SLUICE_SUCCESS ? source : NULL;
}

SluiceImageSource *open_picture(const char *path)
{
    const char *ending = strrchr(path, '.');
    if (ending && strcmp(ending, ".exr") == 0)
        return open_exr(path, SLUICE_FORMAT_R8G8B8A8_SRGB);
    return open_ppm(path);
}

SluiceImageSource *open_store(const char *path, SluiceStoreReadPool *pool, bool checks_always)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = path,
                                               .log = log_to_stderr,
                                               .readPool = pool,
                                               .alwaysCheckRawTiles = checks_always};
    SluiceImageSource *source = NULL;
    must(sluiceCreateStoreImageSource(&create, &source), path);
    return source;
}

static void write_tile(SluiceStoreWriter *writer, SluiceImageSource *source, uint32_t level,
                       uint32_t x, uint32_t y, unsigned char *texels)
{
    SluiceStoreLayout layout;
    SluiceImageRegion region;
    must(sluiceGetStoreWriterLayout(writer, &layout), "layout");
    must(sluiceGetStoreTileRegion(&layout, level, x, y, &region), "tile");
    size_t pitch = sluiceGetFormatRegionSize(layout.format, region.width, 1);
    must(sluiceReadImageRegion(source, &region, texels, pitch), "reading the picture");
    must(sluiceWriteStoreTile(writer, 0, level, x, y, texels, pitch), "writing");
}

static void write_tail(SluiceStoreWriter *writer, SluiceImageSource *source,
                       const SluiceStoreLayout *layout, unsigned char *texels)
{
    const void *levels[SLUICE_STORE_MAX_MIP_LEVELS];
    for (uint32_t l = layout->tailFirstLevel; l < layout->mipLevelCount; l++) {
        SluiceImageRegion region;
        must(sluiceGetStoreTileRegion(layout, l, 0, 0, &region), "level");
        must(sluiceReadImageRegion(source, &region, texels,
                                   sluiceGetFormatRegionSize(layout->format, region.width, 1)),
             "reading the picture");
        levels[l - layout->tailFirstLevel] = texels;
        texels += sluiceGetFormatRegionSize(layout->format, region.width, region.height);
    }
    must(sluiceWriteStoreTail(writer, 0, levels, NULL), "writing");
}

void write_store(const char *path, SluiceImageSource *source, uint32_t compression)
{
    static unsigned char texels[1 << 17];
    SluiceImageInfo info = {.structSize = sizeof info};
    must(sluiceGetImageInfo(source, &info), path);
    SluiceStoreCreateInfo create = {.structSize = sizeof create,
                                    .pPath = path,
                                    .width = info.width,
                                    .height = info.height,
                                    .format = info.format,
                                    .compressionLevel = compression,
                                    .log = log_to_stderr};
    SluiceStoreWriter *writer = NULL;
    SluiceStoreLayout layout;
    must(sluiceCreateStoreWriter(&create, &writer), path);
    must(sluiceGetStoreWriterLayout(writer, &layout), path);
    for (uint32_t l = 0; l < layout.tailFirstLevel; l++)
        for (uint32_t y = 0; y < layout.levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < layout.levelWidthInTiles[l]; x++)
                write_tile(writer, source, l, x, y, texels);
    write_tail(writer, source, &layout, texels);
    must(sluiceFinishStore(writer), path);
    sluiceDestroyStoreWriter(writer);
}

void write_exr(const char *path, SluiceImageSource *source)
{
    SluiceExrWriteInfo info = {.structSize = sizeof info, .pPath = path, .log = log_to_stderr};
    must(sluiceGetStandardTileShape(SLUICE_FORMAT_R16G16B16A16_SFLOAT, &info.tileWidth,
                                    &info.tileHeight),
         path);
    must(sluiceWriteExrFile(&info, source), path);
}
