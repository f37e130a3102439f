#include "stores.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static bool check(SluiceResult result, const char *what)
{
    if (result == SLUICE_SUCCESS)
        return true;
    fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
    return false;
}

static unsigned char *draw(uint32_t size)
{
    unsigned char *texels = malloc((size_t)size * size * 4);
    uint32_t state = 12345;
    for (uint32_t y = 0; texels && y < size; y++)
        for (uint32_t x = 0; x < size; x++) {
            unsigned char *texel = &texels[((size_t)y * size + x) * 4];
            float shape = 100 + 60 * sinf((float)x * 0.013f) + 60 * cosf((float)y * 0.007f);
            state = state * 1664525u + 1013904223u;
            for (uint32_t c = 0; c < 3; c++)
                texel[c] = (unsigned char)(shape + (float)(state >> (8 + 4 * c) & 15));
            texel[3] = 255;
        }
    return texels;
}

static SluiceImageSource *create_picture(uint32_t size)
{
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = size,
                                  .height = size,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "picture"};
    unsigned char *texels = draw(size);
    SluiceImageSource *source = NULL;
    if (texels)
        check(sluiceCreateMemoryImageSource(texels, &info, NULL, &source), "picture");
    free(texels);
    return source;
}

static bool read_level(SluiceImageSource *source, const SluiceImageRegion *region,
                       unsigned char *texels)
{
    return check(sluiceReadImageRegion(source, region, texels, (size_t)region->width * 4),
                 "reading the picture");
}

static bool write_levels(SluiceStoreWriter *writer, SluiceImageSource *source,
                         const SluiceStoreLayout *layout, unsigned char *texels)
{
    SluiceImageRegion at;
    for (uint32_t level = 0; level < layout->tailFirstLevel; level++)
        for (uint32_t y = 0; y < layout->levelHeightInTiles[level]; y++)
            for (uint32_t x = 0; x < layout->levelWidthInTiles[level]; x++)
                if (!check(sluiceGetStoreTileRegion(layout, level, x, y, &at), "tile") ||
                    !read_level(source, &at, texels) ||
                    !check(
                        sluiceWriteStoreTile(writer, 0, level, x, y, texels, (size_t)at.width * 4),
                        "writing"))
                    return false;
    const void *levels[SLUICE_STORE_MAX_MIP_LEVELS];
    for (uint32_t level = layout->tailFirstLevel; level < layout->mipLevelCount; level++) {
        if (!check(sluiceGetStoreTileRegion(layout, level, 0, 0, &at), "level") ||
            !read_level(source, &at, texels))
            return false;
        levels[level - layout->tailFirstLevel] = texels;
        texels += (size_t)at.width * at.height * 4;
    }
    return check(sluiceWriteStoreTail(writer, 0, levels, NULL), "writing");
}

bool stores_write(const char *path, uint32_t size)
{
    const SluiceStoreCreateInfo create = {.structSize = sizeof create,
                                          .pPath = path,
                                          .width = size,
                                          .height = size,
                                          .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                          .compressionLevel = 3};
    SluiceStoreLayout layout;
    SluiceStoreWriter *writer = NULL;
    SluiceImageSource *source = create_picture(size);
    unsigned char *texels = malloc(1 << 18);
    bool done = source && texels && check(sluiceCreateStoreWriter(&create, &writer), path) &&
                check(sluiceGetStoreWriterLayout(writer, &layout), "layout") &&
                write_levels(writer, source, &layout, texels) &&
                check(sluiceFinishStore(writer), path);
    sluiceDestroyStoreWriter(writer);
    sluiceDestroyImageSource(source);
    free(texels);
    return done;
}

SluiceImageSource **stores_open(const char *path, uint32_t count)
{
    SluiceImageSource **sources = calloc(count, sizeof *sources);
    const SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    for (uint32_t i = 0; sources && i < count; i++)
        if (!check(sluiceCreateStoreImageSource(&create, &sources[i]), path)) {
            stores_close(sources, i);
            return NULL;
        }
    return sources;
}

void stores_close(SluiceImageSource **sources, uint32_t count)
{
    for (uint32_t i = 0; sources && i < count; i++)
        sluiceDestroyImageSource(sources[i]);
    free(sources);
}
