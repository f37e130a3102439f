/* Textures by id: creation and removal, and their elements of the table for shaders. */
#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "demand_vulkan/opening.h"
#include "demand_vulkan/pages.h"
#include "demand_vulkan/refused_arguments.h"
#include "demand_vulkan/demand_strict.h"
#include "image/pooled_reads.h"
#include "image/info.h"
#include "vulkan/address_mode.h"

#include <sluice/shared/demand.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Bits of the shape that depend on the sampler, not on the image. */
#define SAMPLER_BITS                                                                               \
    (7u << SLUICE_DEMAND_MODE_U_SHIFT | 7u << SLUICE_DEMAND_MODE_V_SHIFT | SLUICE_DEMAND_NEAREST | \
     SLUICE_DEMAND_NEAREST_LEVEL | SLUICE_DEMAND_SPLINE | SLUICE_DEMAND_SMART)

static_assert(sizeof(struct SluiceDemandTexture) == SLC_MIRROR_ELEMENT, "elements of the table");

SluiceDemandTextureId slc_texture_id(const SluiceDemandLoader *loader, uint32_t index)
{
    return (uint64_t)loader->textures[index].generation << 32 | index;
}

SluiceResult slc_texture_find(SluiceDemandLoader *loader, SluiceDemandTextureId id, uint32_t *index)
{
    *index = (uint32_t)id;
    uint32_t generation = (uint32_t)(id >> 32);
    if (*index == 0 || *index >= loader->texture_high || generation == 0 ||
        generation > loader->textures[*index].generation)
        return SLUICE_ERROR_UNKNOWN_TEXTURE;
    const struct slc_demand_texture *texture = &loader->textures[*index];
    bool live = texture->kind != SLC_TEXTURE_FREE && texture->kind != SLC_TEXTURE_RETIRED;
    return live && generation == texture->generation ? SLUICE_SUCCESS : SLUICE_ERROR_STALE_TEXTURE;
}

static bool sampler_is_valid(const SluiceDemandSampler *s)
{
    bool modes = (uint32_t)s->addressModeU <= VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE &&
                 (uint32_t)s->addressModeV <= VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE;
    bool filters = (uint32_t)s->filter <= SLUICE_DEMAND_FILTER_SMART_CUBIC &&
                   (uint32_t)s->mipmapFilter <= SLUICE_DEMAND_FILTER_NEAREST;
    return modes && filters && s->maxAnisotropy >= 0 && s->maxAnisotropy <= 64 &&
           s->lodBias >= -16 && s->lodBias <= 16;
}

static SluiceResult refuse_sampler(const SluiceDemandLoader *loader, const char *function,
                                   const SluiceDemandSampler *s)
{
    return slc_demand_refuse(
        loader, function,
        "sampler with address modes %d and %d, filters %d and %d, "
        "maxAnisotropy %g, lodBias %g: a mode or filter is unknown, maxAnisotropy is not "
        "0 to 64, or lodBias is not -16 to 16",
        (int)s->addressModeU, (int)s->addressModeV, (int)s->filter, (int)s->mipmapFilter,
        (double)s->maxAnisotropy, (double)s->lodBias);
}

static struct SluiceDemandTexture *change_entry(SluiceDemandLoader *loader, uint32_t index)
{
    return slc_table_mirror_change(&loader->table, index);
}

static uint32_t mode_bits(VkSamplerAddressMode u, VkSamplerAddressMode v)
{
    return (uint32_t)u << SLUICE_DEMAND_MODE_U_SHIFT | (uint32_t)v << SLUICE_DEMAND_MODE_V_SHIFT;
}

static uint32_t filter_bits(const SluiceDemandSampler *s)
{
    static const uint32_t bits[] = {[SLUICE_DEMAND_FILTER_NEAREST] = SLUICE_DEMAND_NEAREST,
                                    [SLUICE_DEMAND_FILTER_CUBIC] = SLUICE_DEMAND_SPLINE,
                                    [SLUICE_DEMAND_FILTER_SMART_CUBIC] =
                                        SLUICE_DEMAND_SPLINE | SLUICE_DEMAND_SMART};
    return bits[s->filter] |
           (s->mipmapFilter == SLUICE_DEMAND_FILTER_NEAREST ? SLUICE_DEMAND_NEAREST_LEVEL : 0);
}

static void write_sampler(SluiceDemandLoader *loader, uint32_t index, const SluiceDemandSampler *s)
{
    struct SluiceDemandTexture *entry = change_entry(loader, index);
    struct slc_demand_texture *texture = &loader->textures[index];
    texture->modes[0] = s->addressModeU;
    texture->modes[1] = s->addressModeV;
    texture->explicit_modes = s->explicitAddressModes;
    *entry = (struct SluiceDemandTexture){.state = SLUICE_DEMAND_TEXTURE_UNKNOWN,
                                          .shape = mode_bits(s->addressModeU, s->addressModeV) |
                                                   filter_bits(s),
                                          .maxAnisotropy = fmaxf(1, s->maxAnisotropy),
                                          .lodBias = s->lodBias};
    memcpy(entry->borderColor, s->borderColor, sizeof entry->borderColor);
}

static SluiceResult grow(SluiceDemandLoader *loader)
{
    uint32_t old = loader->texture_capacity;
    uint32_t capacity = slc_min_u32(old ? 2 * old : 256, loader->info.maxTextureCount + 1);
    struct slc_demand_texture *textures =
        slc_regrow(&loader->cb, loader->textures, old, capacity, sizeof *textures);
    if (!textures)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memset(textures + old, 0, (capacity - old) * sizeof *textures);
    loader->textures = textures;
    loader->texture_capacity = capacity;
    return SLUICE_SUCCESS;
}

SluiceResult slc_texture_take(SluiceDemandLoader *loader, uint32_t *index)
{
    slc_textures_end_retired(loader);
    *index = loader->free_texture;
    if (*index != SLC_NONE) {
        loader->free_texture = loader->textures[*index].next;
    } else {
        if (loader->texture_high > loader->info.maxTextureCount) {
            slc_demand_strict_no_texture(loader);
            return SLUICE_ERROR_LIMIT_EXCEEDED;
        }
        SluiceResult result = slc_table_mirror_reserve(&loader->table, loader->texture_high + 1);
        if (result == SLUICE_SUCCESS && loader->texture_high >= loader->texture_capacity)
            result = grow(loader);
        if (result != SLUICE_SUCCESS)
            return result;
        *index = loader->texture_high++;
    }
    struct slc_demand_texture *texture = &loader->textures[*index];
    *texture = (struct slc_demand_texture){.generation = texture->generation + 1,
                                           .image = SLC_NONE,
                                           .retry_queued = texture->retry_queued,
                                           .base = SLC_NONE,
                                           .next = SLC_NONE};
    loader->texture_count++;
    loader->counts.texturesCreated++;
    return SLUICE_SUCCESS;
}

/* Checks a produced image at creation, because opening it later must not fail. */
static SluiceResult check_made(SluiceDemandLoader *loader, const SluiceImageInfo *image)
{
    SluiceResult result = slc_image_info_check(image, SLC_LEVELS_TO_TAIL, &loader->vk.log);
    const char *trouble = result == SLUICE_SUCCESS ? slc_image_trouble(loader, image, 0) : NULL;
    if (!trouble)
        return result;
    slc_log(&loader->vk.log, SLUICE_LOG_ERROR, "%s cannot be used as a texture: %s",
            image->pName ? image->pName : "image", trouble);
    return SLUICE_ERROR_UNSUPPORTED;
}

/* Reads the source of a texture, or its producer: `*made`, which the caller owns. */
static SluiceResult read_image(SluiceDemandLoader *loader, const char *function,
                               const SluiceDemandTextureCreateInfo *info,
                               struct slc_made_image **made)
{
    if (!info->pProducer)
        return SLUICE_SUCCESS;
    if (info->image.source || info->image.pfnOpen)
        return slc_demand_refuse(loader, function,
                                 "image.source or image.pfnOpen is set beside pProducer: one of "
                                 "them can fill the tiles");
    *made = slc_calloc(&loader->cb, 1, sizeof **made);
    if (!*made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    (*made)->info.structSize = sizeof(SluiceImageInfo);
    memcpy((*made)->last_color, info->lastLevelColor, sizeof(*made)->last_color);
    SluiceResult result = slc_tile_producer_read(&(*made)->producer, &(*made)->info,
                                                 info->pProducer, &loader->vk.log);
    if (result == SLUICE_SUCCESS)
        result = check_made(loader, &(*made)->info);
    if (result == SLUICE_SUCCESS)
        return SLUICE_SUCCESS;
    slc_free(&loader->cb, *made, 1, sizeof **made);
    *made = NULL;
    return result;
}

static void free_made(SluiceDemandLoader *loader, struct slc_demand_texture *texture)
{
    if (texture->made)
        slc_free(&loader->cb, texture->made, 1, sizeof *texture->made);
    texture->made = NULL;
}

SluiceResult sluiceAddDemandTexture(SluiceDemandLoader *loader,
                                    const SluiceDemandTextureCreateInfo *pCreateInfo,
                                    SluiceDemandTextureId *pTextureId)
{
    if (!loader || !pCreateInfo || !pTextureId)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDemandTextureCreateInfo info = {.structSize = sizeof info};
    struct slc_made_image *made = NULL;
    SluiceDemandSampler sampler = {.structSize = sizeof sampler};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceDemandTextureCreateInfo), &info,
                                          pCreateInfo, &loader->vk.log);
    if (result == SLUICE_SUCCESS && !info.pProducer && !info.image.source && !info.image.pfnOpen)
        return SLUICE_ERROR_NULL_POINTER;
    if (result == SLUICE_SUCCESS && info.pSampler)
        result = slc_struct_read(SLC_STRUCT(SluiceDemandSampler), &sampler, info.pSampler,
                                 &loader->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!sampler_is_valid(&sampler))
        return refuse_sampler(loader, __func__, &sampler);
    result = read_image(loader, __func__, &info, &made);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t index;
    result = slc_texture_take(loader, &index);
    if (result != SLUICE_SUCCESS) {
        if (made)
            slc_free(&loader->cb, made, 1, sizeof *made);
        return result;
    }
    struct slc_demand_texture *texture = &loader->textures[index];
    texture->kind = SLC_TEXTURE_IMAGE;
    texture->source = info.image;
    texture->made = made;
    memcpy(texture->failure_color, info.failureColor, sizeof texture->failure_color);
    write_sampler(loader, index, &sampler);
    *pTextureId = slc_texture_id(loader, index);
    return SLUICE_SUCCESS;
}

static void show_unknown(SluiceDemandLoader *loader, uint32_t index)
{
    struct SluiceDemandTexture *entry = change_entry(loader, index);
    entry->state = SLUICE_DEMAND_TEXTURE_UNKNOWN;
    entry->shape &= SAMPLER_BITS;
    entry->width = entry->height = entry->levels = entry->tailPage = 0;
}

static void show_failed(SluiceDemandLoader *loader, uint32_t index, const float color[4])
{
    show_unknown(loader, index);
    struct SluiceDemandTexture *entry = change_entry(loader, index);
    entry->state = SLUICE_DEMAND_TEXTURE_FAILED;
    memcpy(entry->baseColor, color, sizeof entry->baseColor);
}

/* Chooses the address modes: the sampler's, or those that the image records. */
static uint32_t choose_modes(SluiceDemandLoader *loader, uint32_t index,
                             const SluiceImageInfo *info)
{
    const struct slc_demand_texture *texture = &loader->textures[index];
    VkSamplerAddressMode u =
        slc_address_mode(texture->modes[0], texture->explicit_modes, info->addressModeU);
    VkSamplerAddressMode v =
        slc_address_mode(texture->modes[1], texture->explicit_modes, info->addressModeV);
    bool differs = slc_address_mode_differs(u, info->addressModeU) ||
                   slc_address_mode_differs(v, info->addressModeV);
    if (differs && !loader->told_of_modes)
        slc_warn_of_address_modes(&loader->vk.log, info, u, v);
    loader->told_of_modes |= differs;
    return mode_bits(u, v);
}

/* Returns the level count for shaders, which use the base color as last level. Short chains get
 * one. */
static uint32_t shown_level_count(const SluiceImageInfo *info)
{
    uint32_t full = slc_mip_count(slc_max_u32(info->width, info->height));
    return slc_min_u32(info->mipLevelCount + 1, full);
}

static void show_image(SluiceDemandLoader *loader, uint32_t index,
                       const struct slc_demand_image *image)
{
    struct SluiceDemandTexture *entry = change_entry(loader, index);
    SluiceFormatInfo format = {.structSize = sizeof format};
    sluiceGetFormatInfo(image->info.format, &format);
    entry->state = SLUICE_DEMAND_TEXTURE_OPEN;
    entry->width = image->info.width;
    entry->height = image->info.height;
    entry->shape = (entry->shape & SAMPLER_BITS & ~mode_bits(7, 7)) |
                   choose_modes(loader, index, &image->info) | slc_log2_u32(image->tile_width) |
                   slc_log2_u32(image->tile_height) << SLUICE_DEMAND_TILE_HEIGHT_SHIFT |
                   shown_level_count(&image->info) << SLUICE_DEMAND_LEVEL_COUNT_SHIFT |
                   image->regular_count << SLUICE_DEMAND_REGULAR_SHIFT |
                   format.channelCount << SLUICE_DEMAND_COMPONENTS_SHIFT |
                   (image->blocks ? SLUICE_DEMAND_BLOCKS : 0);
    entry->levels = SLC_MAX_REGULAR_LEVELS * (1 + image->slot);
    entry->tailPage = image->tail_page;
    memcpy(entry->baseColor, image->base_color, sizeof entry->baseColor);
}

void slc_texture_show_unknown(SluiceDemandLoader *loader, uint32_t index)
{
    for (uint32_t i = index; i != SLC_NONE; i = loader->textures[i].next)
        show_unknown(loader, i);
}

void slc_texture_show_failed(SluiceDemandLoader *loader, uint32_t index)
{
    for (uint32_t i = index; i != SLC_NONE; i = loader->textures[i].next)
        show_failed(loader, i, loader->textures[index].failure_color);
}

void slc_texture_show_image(SluiceDemandLoader *loader, const struct slc_demand_image *image)
{
    for (uint32_t i = image->texture; i != SLC_NONE; i = loader->textures[i].next)
        show_image(loader, i, image);
}

SluiceResult sluiceAddDemandTextureVariant(SluiceDemandLoader *loader, SluiceDemandTextureId baseId,
                                           const SluiceDemandSampler *pSampler,
                                           SluiceDemandTextureId *pTextureId)
{
    uint32_t base, index;
    if (!loader || !pSampler || !pTextureId)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDemandSampler sampler = {.structSize = sizeof sampler};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceDemandSampler), &sampler, pSampler, &loader->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_texture_find(loader, baseId, &base);
    if (result != SLUICE_SUCCESS)
        return result;
    if (loader->textures[base].kind == SLC_TEXTURE_GRID)
        return slc_demand_refuse_grid(loader, __func__, baseId);
    if (!sampler_is_valid(&sampler))
        return refuse_sampler(loader, __func__, &sampler);
    if (loader->textures[base].kind == SLC_TEXTURE_VARIANT)
        base = loader->textures[base].base;
    result = slc_texture_take(loader, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_demand_texture *texture = &loader->textures[index], *of = &loader->textures[base];
    texture->kind = SLC_TEXTURE_VARIANT;
    texture->base = base;
    texture->next = of->next;
    of->next = index;
    write_sampler(loader, index, &sampler);
    if (of->failed)
        show_failed(loader, index, of->failure_color);
    else if (of->image != SLC_NONE && loader->images[of->image]->state == SLC_IMAGE_OPEN)
        show_image(loader, index, loader->images[of->image]);
    *pTextureId = slc_texture_id(loader, index);
    return SLUICE_SUCCESS;
}

static void retire(SluiceDemandLoader *loader, uint32_t index, const float color[4])
{
    struct slc_demand_texture *texture = &loader->textures[index];
    if (texture->grid_uses)
        slc_grids_leave(loader, index);
    if (texture->kind == SLC_TEXTURE_GRID)
        slc_grid_empty(loader, index);
    show_failed(loader, index, color);
    slc_pages_forget_requests(loader, index, 1);
    free_made(loader, texture);
    texture->kind = SLC_TEXTURE_RETIRED;
    texture->launch = loader->launch;
    texture->next = SLC_NONE;
    if (loader->first_retired_texture == SLC_NONE)
        loader->first_retired_texture = index;
    else
        loader->textures[loader->last_retired_texture].next = index;
    loader->last_retired_texture = index;
    loader->texture_count--;
}

void slc_textures_end_retired(SluiceDemandLoader *loader)
{
    while (loader->first_retired_texture != SLC_NONE) {
        uint32_t index = loader->first_retired_texture;
        struct slc_demand_texture *texture = &loader->textures[index];
        if (texture->launch > loader->processed)
            return;
        loader->first_retired_texture = texture->next;
        if (texture->cell_count)
            slc_region_arena_give(&loader->grid_arena, texture->first_element,
                                  slc_div_up_u32(texture->cell_count, 16));
        texture->cell_count = 0;
        texture->kind = SLC_TEXTURE_FREE;
        if (texture->generation == UINT32_MAX)
            continue; /* all generations of the index are used up */
        texture->next = loader->free_texture;
        loader->free_texture = index;
    }
}

static void unlink_variant(SluiceDemandLoader *loader, uint32_t index)
{
    uint32_t at = loader->textures[index].base;
    while (loader->textures[at].next != index)
        at = loader->textures[at].next;
    loader->textures[at].next = loader->textures[index].next;
}

SluiceResult sluiceRemoveDemandTexture(SluiceDemandLoader *loader, SluiceDemandTextureId textureId)
{
    uint32_t index;
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_texture_find(loader, textureId, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_demand_texture *texture = &loader->textures[index];
    float color[4];
    if (texture->kind == SLC_TEXTURE_GRID) {
        memcpy(color, change_entry(loader, index)->baseColor, sizeof color);
    } else if (texture->kind == SLC_TEXTURE_IMAGE) {
        memcpy(color, texture->failure_color, sizeof color);
        if (texture->image != SLC_NONE)
            slc_image_detach(loader, loader->images[texture->image]);
        for (uint32_t next; texture->next != SLC_NONE; texture->next = next) {
            next = loader->textures[texture->next].next;
            retire(loader, texture->next, color);
        }
    } else {
        memcpy(color, loader->textures[texture->base].failure_color, sizeof color);
        unlink_variant(loader, index);
    }
    retire(loader, index, color);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceReplaceDemandImage(SluiceDemandLoader *loader, SluiceDemandTextureId textureId,
                                      const SluiceDemandImage *pImage)
{
    uint32_t index;
    if (!loader || !pImage || (!pImage->source && !pImage->pfnOpen))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_texture_find(loader, textureId, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_demand_texture *texture = &loader->textures[index];
    if (texture->kind != SLC_TEXTURE_IMAGE)
        return slc_demand_refuse(loader, __func__, "texture %#" PRIx64 " is a grid or a variant",
                                 textureId);
    if (texture->image != SLC_NONE)
        slc_image_detach(loader, loader->images[texture->image]);
    free_made(loader, texture);
    texture->source = *pImage;
    texture->failed = texture->told = texture->told_tail = false;
    slc_loader_drop_texels(loader->reader, pImage->source);
    slc_texture_show_unknown(loader, index);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceInvalidateDemandTexture(SluiceDemandLoader *loader,
                                           SluiceDemandTextureId textureId)
{
    uint32_t index;
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_texture_find(loader, textureId, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    if (loader->textures[index].kind == SLC_TEXTURE_VARIANT)
        index = loader->textures[index].base;
    struct slc_demand_texture *texture = &loader->textures[index];
    if (texture->kind == SLC_TEXTURE_GRID)
        return slc_demand_refuse_grid(loader, __func__, textureId);
    slc_loader_drop_texels(loader->reader, texture->source.source);
    if (!slc_texture_retry(loader, index) && texture->image != SLC_NONE)
        slc_image_invalidate(loader, loader->images[texture->image]);
    return SLUICE_SUCCESS;
}

bool slc_texture_retry(SluiceDemandLoader *loader, uint32_t index)
{
    struct slc_demand_texture *texture = &loader->textures[index];
    if (texture->kind != SLC_TEXTURE_IMAGE || !texture->failed)
        return false;
    texture->failed = false;
    slc_texture_show_unknown(loader, index);
    return true;
}

SluiceResult sluiceRetryDemandTexture(SluiceDemandLoader *loader, SluiceDemandTextureId textureId)
{
    uint32_t index;
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    if (textureId == SLUICE_ALL_DEMAND_TEXTURES) {
        slc_retries_everything(loader);
        return SLUICE_SUCCESS;
    }
    if (textureId == SLUICE_NO_DEMAND_TEXTURE)
        return slc_demand_refuse(loader, __func__,
                                 "textureId is SLUICE_NO_DEMAND_TEXTURE; for all textures it is "
                                 "SLUICE_ALL_DEMAND_TEXTURES");
    SluiceResult result = slc_texture_find(loader, textureId, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    if (loader->textures[index].kind == SLC_TEXTURE_VARIANT)
        index = loader->textures[index].base;
    const struct slc_demand_texture *texture = &loader->textures[index];
    if (texture->kind == SLC_TEXTURE_GRID)
        return slc_demand_refuse_grid(loader, __func__, textureId);
    if (!slc_texture_retry(loader, index) && texture->image != SLC_NONE)
        slc_retries_all(loader, &loader->images[texture->image]->retry_group);
    return SLUICE_SUCCESS;
}

void slc_demand_textures_finish(SluiceDemandLoader *loader)
{
    for (uint32_t i = 1; i < loader->texture_high && loader->textures; i++)
        free_made(loader, &loader->textures[i]);
    slc_free(&loader->cb, loader->textures, loader->texture_capacity, sizeof *loader->textures);
    loader->textures = NULL;
}
