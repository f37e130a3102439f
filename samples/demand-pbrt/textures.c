#include "textures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/files.h"
#include "../../tools/common/log.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

#define POLL_SECONDS 0.002

/* A preview differs from the store in a few texels, so pictures would depend on time: wait for the
 * store. */
static SluiceResult wait_for_bake(SluiceImageSource *source, SluiceImageFileKind *kind)
{
    for (;;) {
        SluiceOpenedImageInfo info = {.structSize = sizeof info};
        SluiceResult result = sluiceGetOpenedImageInfo(source, &info);
        *kind = info.kind;
        if (result != SLUICE_SUCCESS || info.ready)
            return result;
        if (info.failure != SLUICE_SUCCESS)
            return info.failure;
        clock_sleep_until(clock_seconds() + POLL_SECONDS);
    }
}

static SluiceResult open_source(struct picture_image *image, SluiceImageSource **source,
                                SluiceImageInfo *info)
{
    SluiceResult result = sluiceOpenImageSource(image->opener, image->path, source);
    if (result != SLUICE_SUCCESS)
        return result;
    result = wait_for_bake(*source, &image->kind);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetImageInfo(*source, info);
    if (result == SLUICE_SUCCESS)
        return result;
    sluiceDestroyImageSource(*source);
    *source = NULL;
    return result;
}

/* On a thread of the loader, and never twice at a time. */
static SluiceResult open_image(void *user_data, SluiceImageSource **source)
{
    struct picture_image *image = user_data;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = open_source(image, source, &info);
    if (result != SLUICE_SUCCESS) {
        if (result != SLUICE_NOT_READY && !image->has_failed)
            text_say("%s:%u: %s: cannot be read: %s; the texture becomes gray", image->file,
                     image->line, image->path, sluiceGetResultName(result));
        image->has_failed = image->has_failed || result != SLUICE_NOT_READY;
        return result;
    }
    if (image->says_what_it_reads)
        text_say("picture %s: %u x %u", image->path, info.width, info.height);
    image->info = info;
    return SLUICE_SUCCESS;
}

bool textures_create(SluiceDemandLoader *loader, const char *cache, uint32_t thread_count,
                     struct textures *t)
{
    const SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                              .pCacheFolder = cache,
                                              .bakeThreadCount = thread_count,
                                              .log = {.pfnLog = log_say}};
    *t = (struct textures){.loader = loader, .max_anisotropy = 1.0f};
    SluiceResult result = sluiceCreateImageOpener(&info, &t->opener);
    if (result != SLUICE_SUCCESS)
        text_say("pictures cannot be opened: %s", sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

void textures_finish(struct textures *t)
{
    for (uint32_t i = 0; i < t->image_count; i++)
        free(t->images[i]);
    for (uint32_t i = 0; i < t->use_count; i++)
        free(t->uses[i]);
    free(t->images);
    free(t->uses);
    sluiceDestroyImageOpener(t->opener);
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
    const char *path = texture->pImagePath;
    for (uint32_t i = 0; i < t->image_count; i++)
        if (strcmp(t->images[i]->path, path) == 0)
            return t->images[i];
    if (!grow((void **)&t->images, t->image_count, &t->image_room, sizeof(struct picture_image *)))
        return NULL;
    struct picture_image *image = calloc(1, sizeof *image);
    if (!image || !output_add_input(path)) {
        free(image);
        return NULL;
    }
    *image = (struct picture_image){.path = path,
                                    .file = texture->pFile,
                                    .line = texture->line,
                                    .opener = t->opener,
                                    .says_what_it_reads = t->says_what_it_reads};
    t->images[t->image_count++] = image;
    return image;
}

static SluiceResult add_texture(struct textures *t, struct picture_use *use)
{
    const SluiceDemandSampler sampler = make_sampler(use);
    struct picture_image *image = use->image;
    if (image->id != SLUICE_NO_DEMAND_TEXTURE)
        return sluiceAddDemandTextureVariant(t->loader, image->id, &sampler, &use->id);
    const SluiceDemandTextureCreateInfo info = {
        .structSize = sizeof info,
        .image = {.pUserData = image, .pfnOpen = open_image, .pName = image->path},
        .pSampler = &sampler,
        .failureColor = {0.5f, 0.5f, 0.5f, 1.0f}};
    SluiceResult result = sluiceAddDemandTexture(t->loader, &info, &use->id);
    image->id = use->id;
    return result;
}

static bool is_same_use(const struct picture_use *a, const struct picture_use *b)
{
    return strcmp(a->image->path, b->image->path) == 0 && a->wrap == b->wrap &&
           a->nearest == b->nearest && a->anisotropy == b->anisotropy;
}

/* Callers keep the pointer. */
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
