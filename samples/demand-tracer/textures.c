#include "textures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"
#include "../streaming/picture_file.h"

#define TEXTURE_SUFFIXES ".store|.exr|.dds|.ktx2"

static SluiceResult open_file(const struct texture *texture, SluiceImageSource **source)
{
    const char *path = texture->path;
    enum picture_kind kind;
    SluiceImageInfo info = {.structSize = sizeof info};
    struct picture_opening opening = {.pixels = PIXEL_FORMAT_AUTO, .memory = texture->memory};
    SluiceResult result = picture_file_kind(path, &kind);
    if (result != SLUICE_SUCCESS)
        return result;
    if (kind == PICTURE_OTHER) {
        text_say("%s: is no OpenEXR, DDS or KTX2 file, nor a tile store", path);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    return picture_file_open(path, kind, &opening, source, &info);
}

/* Called on a thread of a loader, one at a time, when a ray has hit the texture, and again later if
 * it failed. A refusal that no retry changes is reported once. */
static SluiceResult open_texture(void *user_data, SluiceImageSource **source)
{
    struct texture *texture = user_data;
    if (texture->path && texture->refusal == SLUICE_SUCCESS) {
        SluiceResult result = open_file(texture, source);
        if (result == SLUICE_ERROR_LIMIT_EXCEEDED || result == SLUICE_ERROR_UNSUPPORTED)
            texture->refusal = result;
        if (result == SLUICE_ERROR_LIMIT_EXCEEDED)
            text_say("%s: --memory raises the limit", texture->path);
        return result;
    }
    if (texture->path)
        return texture->refusal;
    return pattern_open(&texture->pattern, texture->size, source);
}

static bool collect_files(const struct option_list *named, struct file_list *files)
{
    for (size_t i = 0; i < named->count; i++)
        if (!files_collect(named->items[i], TEXTURE_SUFFIXES, files)) {
            fprintf(stderr, "out of memory\n");
            return false;
        }
    if (named->count > 0 && files->count == 0)
        fprintf(stderr, "there is no file that could be a texture (" TEXTURE_SUFFIXES ")\n");
    return named->count == 0 || files->count > 0;
}

static uint64_t chain_size(uint32_t size)
{
    uint64_t sum = 0;
    for (; size > 0; size /= 2)
        sum += (uint64_t)size * size * 4;
    return sum;
}

/** Chooses the image of each texture: files in turn. Leaves are always computed, because they need
 * holes. */
static bool choose_images(const struct tracer_options *options, struct textures *t)
{
    for (uint32_t i = 0; i < t->scene_count; i++) {
        enum texture_use use = scene_texture_use(i, t->scene_count);
        bool is_file = t->files.count > 0 && use != TEXTURE_OF_LEAVES;
        if (is_file && i >= t->files.count) {
            t->of_scene[i] = t->of_scene[i % t->files.count];
            continue;
        }
        struct texture *texture = &t->items[t->count];
        if (!shared_source_init(&texture->shared, open_texture, texture))
            return false;
        t->of_scene[i] = t->count++;
        texture->memory = t->memory;
        if (is_file) {
            texture->path = t->files.paths[i];
        } else {
            texture->pattern = pattern_choose(use, i + options->seed - 1);
            texture->size = options->texture_size;
            t->virtual_size += chain_size(texture->size);
        }
    }
    return true;
}

static bool add_texture(const struct tracer_options *options, SluiceDemandLoader *loader,
                        struct texture *texture, SluiceDemandTextureId *id)
{
    bool leaf = !texture->path && texture->pattern.use == TEXTURE_OF_LEAVES;
    VkSamplerAddressMode mode =
        leaf ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE : VK_SAMPLER_ADDRESS_MODE_REPEAT;
    SluiceDemandTextureCreateInfo info = {
        .structSize = sizeof info,
        .image = {.pUserData = &texture->shared,
                  .pfnOpen = shared_source_open,
                  .pfnClose = shared_source_close,
                  .pName = texture->path},
        .pSampler = &(SluiceDemandSampler){.structSize = sizeof(SluiceDemandSampler),
                                           .addressModeU = mode,
                                           .addressModeV = mode,
                                           .maxAnisotropy = (float)options->anisotropy,
                                           .explicitAddressModes = !texture->path},
        .failureColor = {1.0f, 0.0f, 1.0f, 1.0f},
    };
    SluiceResult result = sluiceAddDemandTexture(loader, &info, id);
    if (result != SLUICE_SUCCESS)
        text_say("a texture cannot be created: %s", sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

bool textures_create(const struct tracer_options *options, struct textures *t)
{
    *t = (struct textures){.scene_count = options->texture_count};
    if (!collect_files(&options->textures, &t->files))
        return false;
    for (size_t i = 0; i < t->files.count; i++)
        if (!output_add_input(t->files.paths[i]))
            return false;
    t->items = calloc(t->scene_count, sizeof *t->items);
    t->of_scene = calloc(t->scene_count, sizeof *t->of_scene);
    if (!t->items || !t->of_scene ||
        sluiceCreateExrMemoryBudget(options->memory, NULL, &t->memory) != SLUICE_SUCCESS ||
        !choose_images(options, t)) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    return true;
}

bool textures_add(const struct tracer_options *options, struct textures *t,
                  SluiceDemandLoader *loader, SluiceDemandTextureId *ids)
{
    for (uint32_t i = 0; i < t->count; i++)
        if (!add_texture(options, loader, &t->items[i], &ids[i]))
            return false;
    return true;
}

void textures_finish(struct textures *t)
{
    for (uint32_t i = 0; i < t->count; i++)
        shared_source_finish(&t->items[i].shared);
    sluiceDestroyExrMemoryBudget(t->memory);
    free(t->items);
    free(t->of_scene);
    files_finish(&t->files);
    memset(t, 0, sizeof *t);
}

uint32_t textures_index(const struct textures *t, const SluiceDemandTextureId *ids, uint32_t index)
{
    return (uint32_t)ids[t->of_scene[index]];
}
