#define _XOPEN_SOURCE 700
#include "baked_blocks.h"

#ifdef HAVE_BAKE

#include <sluice/bake.h>
#include <sluice/store.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Level 0 of a chain as a source. */
struct chain_source {
    SluiceImageSource base;
    const struct chain *chain;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    const struct chain *chain = ((const struct chain_source *)base)->chain;
    info->width = chain->width;
    info->height = chain->height;
    info->mipLevelCount = 1;
    info->format = SLUICE_FORMAT_R8G8B8A8_UNORM;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t pitch)
{
    const struct chain *chain = ((const struct chain_source *)base)->chain;
    for (uint32_t y = 0; y < region->height; y++)
        memcpy((char *)texels + y * pitch,
               chain->texels + 4 * ((size_t)(region->y + y) * chain->width + region->x),
               4 * (size_t)region->width);
    return SLUICE_SUCCESS;
}

static void destroy_nothing(SluiceImageSource *base)
{
    (void)base;
}

static const SluiceImageSourceInterface chain_interface = {sizeof chain_interface, get_info,
                                                           read_region, destroy_nothing};

static SluiceResult bake(const struct chain *chain, const char *path)
{
    struct chain_source source = {{&chain_interface}, chain};
    const SluiceBakeSettings settings = {.structSize = sizeof settings,
                                         .format = SLUICE_FORMAT_BC7_UNORM_BLOCK,
                                         .transfer = SLUICE_BAKE_TRANSFER_LINEAR,
                                         .alpha = SLUICE_BAKE_ALPHA_PREMULTIPLIED};
    const SluiceBakeInfo info = {.structSize = sizeof info,
                                 .source = &source.base,
                                 .pOutputPath = path,
                                 .pSettings = &settings,
                                 .force = true};
    const SluiceBakerCreateInfo create = {.structSize = sizeof create};
    SluiceBaker *baker = NULL;
    SluiceResult result = sluiceCreateBaker(&create, &baker);
    if (result == SLUICE_SUCCESS)
        result = sluiceBakeFile(baker, &info, NULL);
    sluiceDestroyBaker(baker);
    return result;
}

static SluiceResult read_store(const struct chain *chain, const char *path, uint8_t *blocks)
{
    const SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *store = NULL;
    SluiceResult result = sluiceCreateStoreImageSource(&create, &store);
    for (uint32_t level = 0; level < chain->level_count && result == SLUICE_SUCCESS; level++) {
        SluiceImageRegion region = {.mipLevel = level,
                                    .width = chain->width >> level ? chain->width >> level : 1,
                                    .height = chain->height >> level ? chain->height >> level : 1};
        size_t pitch = (region.width + 3) / 4 * (size_t)16;
        result = sluiceReadImageRegion(store, &region, blocks, pitch);
        blocks += pitch * ((region.height + 3) / 4);
    }
    sluiceDestroyImageSource(store);
    return result;
}

bool baked_blocks_exist(void)
{
    return true;
}

bool baked_blocks_write(const struct chain *chain, uint8_t *blocks)
{
    const char *folder = getenv("TMPDIR");
    char path[4096];
    snprintf(path, sizeof path, "%s/neural_figures.XXXXXX", folder ? folder : "/tmp");
    int file = mkstemp(path);
    if (file < 0) {
        fprintf(stderr, "%s: cannot be made\n", path);
        return false;
    }
    close(file);
    SluiceResult result = bake(chain, path);
    if (result == SLUICE_SUCCESS)
        result = read_store(chain, path, blocks);
    unlink(path);
    if (result != SLUICE_SUCCESS)
        fprintf(stderr, "%s: baking BC7: %s\n", path, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

#else

bool baked_blocks_exist(void)
{
    return false;
}

bool baked_blocks_write(const struct chain *chain, uint8_t *blocks)
{
    (void)chain, (void)blocks;
    return false;
}

#endif /* HAVE_BAKE */
