#include "textures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/files.h"
#include "../../tools/common/text.h"

/* Called on a thread of the loader, never twice at the same time for one image. */
static SluiceResult open_image(void *user_data, SluiceImageSource **source)
{
    struct picture_image *image = user_data;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceOpenedImageInfo opened = {.structSize = sizeof opened};
    SluiceResult result = shared_source_open(&image->file->shared, source);
    if (result != SLUICE_SUCCESS)
        return result;
    if ((result = sluiceGetImageInfo(*source, &info)) == SLUICE_SUCCESS)
        result = sluiceGetOpenedImageInfo(*source, &opened);
    if (result != SLUICE_SUCCESS) {
        shared_source_close(&image->file->shared, *source);
        return result;
    }
    image->kind = opened.kind;
    image->info = info;
    return SLUICE_SUCCESS;
}

static void close_image(void *user_data, SluiceImageSource *source)
{
    struct picture_image *image = user_data;
    shared_source_close(&image->file->shared, source);
}

void textures_create(SluiceDemandLoader *loader, struct picture_files *files, struct textures *t)
{
    *t = (struct textures){.loader = loader, .files = files, .max_anisotropy = 1.0f};
}

void textures_finish(struct textures *t)
{
    for (uint32_t i = 0; i < t->image_count; i++)
        free(t->images[i]);
    for (uint32_t i = 0; i < t->use_count; i++)
        free(t->uses[i]);
    free(t->images);
    free(t->uses);
    *t = (struct textures){0};
}

static bool grow(void **items, uint32_t count, uint32_t *room, size_t size)
{
    if (count < *room)
        return true;
    const uint32_t wanted = *room ? 2 * *room : 16;
    void *grown = realloc(*items, wanted * size);
    if (!grown) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    *items = grown;
    *room = wanted;
    return true;
}

static VkSamplerAddressMode address_mode(SluicePbrtWrap wrap)
{
    switch (wrap) {
    case SLUICE_PBRT_WRAP_BLACK: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    case SLUICE_PBRT_WRAP_CLAMP:
    case SLUICE_PBRT_WRAP_OCTAHEDRAL: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case SLUICE_PBRT_WRAP_REPEAT: break;
    }
    return VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

static SluiceDemandSampler make_sampler(const struct picture_use *use)
{
    const SluiceDemandFilter filter =
        use->nearest ? SLUICE_DEMAND_FILTER_NEAREST : SLUICE_DEMAND_FILTER_LINEAR;
    return (SluiceDemandSampler){.structSize = sizeof(SluiceDemandSampler),
                                 .addressModeU = address_mode(use->wrap),
                                 .addressModeV = address_mode(use->wrap),
                                 .filter = filter,
                                 .maxAnisotropy = use->anisotropy,
                                 .explicitAddressModes = true};
}

static struct picture_image *find_image(struct textures *t, const SluicePbrtTexture *texture)
{
    struct picture_file *file = picture_files_find(t->files, texture);
    for (uint32_t i = 0; i < t->image_count; i++)
        if (t->images[i]->file == file)
            return t->images[i];
    if (!file ||
        !grow((void **)&t->images, t->image_count, &t->image_room, sizeof(struct picture_image *)))
        return NULL;
    struct picture_image *image = calloc(1, sizeof *image);
    if (!image) {
        fprintf(stderr, "out of memory\n");
        return NULL;
    }
    image->file = file;
    return t->images[t->image_count++] = image;
}

static SluiceResult add_texture(struct textures *t, struct picture_use *use)
{
    const SluiceDemandSampler sampler = make_sampler(use);
    struct picture_image *image = use->image;
    if (image->id != SLUICE_NO_DEMAND_TEXTURE)
        return sluiceAddDemandTextureVariant(t->loader, image->id, &sampler, &use->id);
    const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                .image = {.pUserData = image,
                                                          .pfnOpen = open_image,
                                                          .pfnClose = close_image,
                                                          .pName = image->file->path},
                                                .pSampler = &sampler,
                                                .failureColor = {0.5f, 0.5f, 0.5f, 1.0f}};
    SluiceResult result = sluiceAddDemandTexture(t->loader, &info, &use->id);
    image->id = use->id;
    return result;
}

static bool is_same_use(const struct picture_use *a, const struct picture_use *b)
{
    return a->image == b->image && a->wrap == b->wrap && a->nearest == b->nearest &&
           a->anisotropy == b->anisotropy;
}

/* Allocates each use by itself, because callers keep the pointer. */
static const struct picture_use *add_use(struct textures *t, const SluicePbrtTexture *texture,
                                         struct picture_use *use)
{
    struct picture_use *kept = malloc(sizeof *kept);
    if (!kept || !grow((void **)&t->uses, t->use_count, &t->use_room, sizeof *t->uses)) {
        free(kept);
        return NULL;
    }
    SluiceResult result = add_texture(t, use);
    if (result != SLUICE_SUCCESS) {
        text_say("%s:%u: texture \"%s\": cannot be added: %s", texture->pFile, texture->line,
                 texture->pName, sluiceGetResultName(result));
        free(kept);
        return NULL;
    }
    *kept = *use;
    return t->uses[t->use_count++] = kept;
}

const struct picture_use *textures_find(struct textures *t, const SluicePbrtTexture *texture)
{
    const bool isotropic = texture->filter == SLUICE_PBRT_FILTER_TRILINEAR ||
                           texture->filter == SLUICE_PBRT_FILTER_POINT;
    struct picture_use use = {.image = find_image(t, texture),
                              .wrap = texture->wrap,
                              .nearest = texture->filter == SLUICE_PBRT_FILTER_POINT,
                              .anisotropy = isotropic ? 1.0f : t->max_anisotropy};
    if (!use.image)
        return NULL;
    for (uint32_t i = 0; i < t->use_count; i++)
        if (is_same_use(t->uses[i], &use))
            return t->uses[i];
    return add_use(t, texture, &use);
}

bool textures_has_alpha(const char *path)
{
    unsigned char bytes[26] = {0};
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    size_t count = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    if (count == sizeof bytes && memcmp(bytes, "\x89PNG", 4) == 0)
        return bytes[25] == 4 || bytes[25] == 6; /* color type */
    return files_has_suffix(path, ".tga") && bytes[16] == 32;
}
