/* Streamed textures of a streamer: adding, removing, and recording their first frame. */
#include "base/struct_size.h"
#include "vulkan/streamer.h"
#include "vulkan/texture_entry.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/limits.h"
#include "base/log.h"
#include "image/format_size.h"
#include "image/info.h"
#include "image/pooled_reads.h"
#include "vulkan/address_mode.h"
#include "vulkan/format.h"
#include "vulkan/format_caps.h"
#include "vulkan/load_cancels.h"
#include "vulkan/texture_control.h"
#include "vulkan/texture_forgetting.h"
#include "vulkan/texture_mode.h"
#include "vulkan/texture_primary.h"

#include <assert.h>
#include <math.h>
#include <sluice/shared/bindings.h>

#define MAX_ANISOTROPY 16.0f /* limit of sample.glsl */
#define LAST_ADDRESS_MODE VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE

/* Finds the first of `count` consecutive free textures. */
static uint32_t find_free(SluiceVulkanStreamer *s, uint32_t count)
{
    while (s->texture_low < s->texture_high &&
           s->textures[s->texture_low].state != SLC_TEXTURE_FREE)
        s->texture_low++;
    uint32_t run = 0, i = s->texture_low;
    for (; i < s->texture_high && run < count; i++)
        run = s->textures[i].state == SLC_TEXTURE_FREE ? run + 1 : 0;
    return count <= s->info.maxTextureCount - (i - run) ? i - run : SLC_NONE;
}

static SluiceResult check_create_info(const SluiceVulkanStreamer *s,
                                      const SluiceVulkanTextureCreateInfo *info)
{
    if (!(info->maxAnisotropy >= 0.0f && info->maxAnisotropy <= MAX_ANISOTROPY))
        return slc_log_refusal(&s->vk.log, "maxAnisotropy is %g; it must be 0 to %g",
                               (double)info->maxAnisotropy, (double)MAX_ANISOTROPY);
    const struct slc_limit limits[] = {
        {"addressModeU", (uint32_t)info->addressModeU, 0, LAST_ADDRESS_MODE},
        {"addressModeV", (uint32_t)info->addressModeV, 0, LAST_ADDRESS_MODE},
        {"filter", (uint32_t)info->filter, 0, SLUICE_TEXTURE_FILTER_SMART_CUBIC},
        {"residencyMode", (uint32_t)info->residencyMode, 0, SLUICE_RESIDENCY_MODE_DENSE},
    };
    SluiceResult result = slc_check_limits(&s->vk.log, limits, sizeof limits / sizeof limits[0]);
    if (result == SLUICE_SUCCESS)
        result = slc_texture_check_mode(s, info->residencyMode);
    if (result != SLUICE_SUCCESS || info->primaryId == SLUICE_NO_TEXTURE)
        return result;
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    return sluiceGetTextureLayout(s->manager, info->primaryId, &layout);
}

static SluiceResult take_regions(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    const SluiceStreamedTextureLayout *layout = &texture->layout;
    uint64_t count = (uint64_t)layout->feedbackWidth * layout->feedbackHeight;
    assert(count >= (uint64_t)layout->minMipWidth * layout->minMipHeight);
    if (count > s->regions.size ||
        !slc_region_arena_take(&s->regions, (uint32_t)count, &texture->region_first)) {
        slc_log(&s->vk.log, SLUICE_LOG_ERROR, "%s: no room for %llu more feedback regions of %u",
                texture->info.pName ? texture->info.pName : "image", (unsigned long long)count,
                s->info.maxRegionCount);
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    }
    texture->region_count = (uint32_t)count;
    if ((count + 3) / 4 <= s->readback.capacity)
        return SLUICE_SUCCESS;
    slc_log(&s->vk.log, SLUICE_LOG_ERROR,
            "%s: its %llu feedback regions exceed feedbackReadbackSize",
            texture->info.pName ? texture->info.pName : "image", (unsigned long long)count);
    return SLUICE_ERROR_LIMIT_EXCEEDED;
}

static SluiceResult create_packed(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    const SluiceStreamedTextureDesc *desc = &texture->image.desc;
    texture->packed_first_unit = SLC_NONE;
    SluiceFormatInfo format = {.structSize = sizeof format};
    SluiceResult result = sluiceGetFormatInfo(texture->info.format, &format);
    if (result == SLUICE_SUCCESS)
        result = slc_packed_units_init(&texture->packed, &s->cb, desc, &format, SLC_TILE_SIZE);
    if (texture->producer.pfn)
        slc_packed_units_join(&texture->packed);
    if (result != SLUICE_SUCCESS || desc->packedTileCount == 0)
        return result;
    if (texture->packed.unit_count > s->info.maxLoadsInFlight) {
        slc_log(&s->vk.log, SLUICE_LOG_ERROR,
                "%s: its packed levels need %u loads at once; maxLoadsInFlight is %u",
                texture->info.pName ? texture->info.pName : "image", texture->packed.unit_count,
                s->info.maxLoadsInFlight);
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    }
    texture->packed_tiles = slc_alloc(&s->cb, desc->packedTileCount, sizeof(SluiceTile));
    return texture->packed_tiles ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static SluiceResult add_to_manager(SluiceVulkanStreamer *s, struct slc_texture *texture,
                                   const SluiceVulkanTextureCreateInfo *info)
{
    SluiceResult result = sluiceAddStreamedTexture(s->manager, &texture->image.desc, &texture->id);
    if (result != SLUICE_SUCCESS)
        return result;
    /* Ids of textures that build_all or this function took back are free only in the next frame. */
    if ((uint32_t)texture->id >= s->info.maxTextureCount)
        result = SLUICE_ERROR_LIMIT_EXCEEDED;
    else if (info->primaryId != SLUICE_NO_TEXTURE)
        result = sluiceSetPrimaryTexture(s->manager, texture->id, info->primaryId);
    if (result == SLUICE_SUCCESS && info->pUvTransform)
        result = slc_texture_set_uv(s, texture, info->pUvTransform);
    if (result != SLUICE_SUCCESS)
        sluiceRemoveStreamedTexture(s->manager, texture->id, s->frame);
    return result;
}

static void destroy_parts(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    slc_texture_views_finish(&texture->views, &s->vk);
    slc_level_views_finish(&texture->level_views, &s->vk, &s->cb, &texture->image);
    /* the image of an array is destroyed with the last layer */
    if (texture->image.image && texture->layer + 1 == texture->layer_count)
        texture->residency->interface->destroy_image(texture->residency, texture->first);
    if (texture->region_count)
        slc_region_arena_give(&s->regions, texture->region_first, texture->region_count);
    slc_free(&s->cb, texture->packed_tiles, texture->image.desc.packedTileCount,
             sizeof *texture->packed_tiles);
    slc_packed_units_finish(&texture->packed, &s->cb);
    *texture = (struct slc_texture){.state = SLC_TEXTURE_FREE};
    s->texture_low = slc_min_u32(s->texture_low, index);
}

/* Makes views, regions and packed levels of one layer. The image exists. */
static SluiceResult build(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    SluiceResult result = SLUICE_SUCCESS;
    if (texture->image.image)
        result = slc_texture_views_init(&texture->views, &s->vk, texture->image.image,
                                        &texture->info, texture->layer, s->caps.image_cube_array);
    if (result == SLUICE_SUCCESS && texture->layer == 0 && texture->producer.pfn)
        result = slc_level_views_init(&texture->level_views, &s->vk, &s->cb, &texture->image,
                                      slc_vk_format(texture->info.format), texture->layer_count);
    texture->layout.structSize = sizeof texture->layout;
    if (result == SLUICE_SUCCESS)
        result = sluiceGetStreamedTextureLayout(&texture->image.desc, &texture->layout);
    if (result == SLUICE_SUCCESS)
        result = take_regions(s, texture);
    if (result == SLUICE_SUCCESS)
        result = create_packed(s, texture);
    return result;
}

static float choose_anisotropy(const SluiceVulkanStreamer *s, float wanted, bool linear)
{
    const SluiceVulkanDeviceCapabilities *caps = &s->caps.public;
    float most = caps->samplerAnisotropy && linear ? caps->maxSamplerAnisotropy : 1.0f;
    return fmaxf(fminf(wanted, most), 1.0f);
}

/* Finds the sampler before the texture is added, because an array of textures shows both at once.
 */
static SluiceResult find_sampler(SluiceVulkanStreamer *s, const struct slc_sampler_kind *kind,
                                 uint32_t *index)
{
    SluiceResult result = slc_samplers_get(&s->samplers, &s->vk, &s->cb, kind, index);
    if (result != SLUICE_SUCCESS || s->info.textureArray != SLUICE_TEXTURE_ARRAY_SEPARATE ||
        *index < SLUICE_SAMPLER_COUNT)
        return result;
    slc_log(
        &s->vk.log, SLUICE_LOG_ERROR,
        "SLUICE_TEXTURE_ARRAY_SEPARATE has samplers of %d kinds; this texture needs another one",
        SLUICE_SAMPLER_COUNT);
    return SLUICE_ERROR_LIMIT_EXCEEDED;
}

static void choose_modes(SluiceVulkanStreamer *s, const SluiceVulkanTextureCreateInfo *info,
                         const SluiceImageInfo *image, VkSamplerAddressMode modes[2])
{
    modes[0] = modes[1] = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE; /* per face */
    if (image->cube)
        return;
    modes[0] =
        slc_address_mode(info->addressModeU, info->explicitAddressModes, image->addressModeU);
    modes[1] =
        slc_address_mode(info->addressModeV, info->explicitAddressModes, image->addressModeV);
    bool differs = slc_address_mode_differs(modes[0], image->addressModeU) ||
                   slc_address_mode_differs(modes[1], image->addressModeV);
    if (differs && !s->told_of_modes)
        slc_warn_of_address_modes(&s->vk.log, image, modes[0], modes[1]);
    s->told_of_modes |= differs;
}

static void choose_kind(SluiceVulkanStreamer *s, const SluiceVulkanTextureCreateInfo *info,
                        const SluiceImageInfo *image, struct slc_sampler_kind *kind)
{
    bool linear = slc_filters_linear(&s->vk, image->format);
    choose_modes(s, info, image, kind->modes);
    kind->max_anisotropy = choose_anisotropy(s, info->maxAnisotropy, linear);
    kind->nearest = !linear;
    kind->integer = slc_format_is_integer(image->format);
}

/* Makes all layers or none. Adds to the manager last: its textures are given back with frames only.
 */
static SluiceResult build_all(SluiceVulkanStreamer *s, uint32_t first,
                              const SluiceVulkanTextureCreateInfo *info,
                              const struct slc_tile_producer *producer,
                              const struct slc_image_use *use, const SluiceImageInfo *image,
                              uint32_t count)
{
    struct slc_residency_image residency_image;
    struct slc_residency *residency = NULL;
    struct slc_sampler_kind kind;
    uint32_t sampler = 0;
    SluiceResult result = SLUICE_SUCCESS;
    choose_kind(s, info, image, &kind);
    if (s->info.textureArray != SLUICE_TEXTURE_ARRAY_NONE)
        result = find_sampler(s, &kind, &sampler);
    bool forgettable = slc_forgetting_allows(s, info, image);
    if (result == SLUICE_SUCCESS && forgettable)
        result = slc_forgetting_describe(s, first, info->residencyMode, image, &residency,
                                         &residency_image);
    else if (result == SLUICE_SUCCESS)
        result = slc_texture_create_image(s, first, info->residencyMode, image, use, &residency,
                                          &residency_image);
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t i = 0; i < count; i++)
        s->textures[first + i] = (struct slc_texture){
            .source = info->source,
            .producer = *producer,
            .whole_shown = slc_settled_texel(SLUICE_MIP_UNTOUCHED),
            .primary_id = info->primaryId,
            .info = *image,
            .residency = residency,
            .image = residency_image,
            .first = first,
            .layer = i,
            .layer_count = count,
            .added_frame = s->frame,
            .presence = forgettable ? SLC_FORGOTTEN : SLC_PRESENT,
            .forgettable = forgettable,
            .sampler_kind = kind,
            .filter = kind.nearest ? SLUICE_TEXTURE_FILTER_LINEAR : info->filter,
            .sampler = sampler};
    for (uint32_t i = 0; i < count && residency->interface->set_source; i++)
        residency->interface->set_source(residency, first + i, info->source, i);
    for (uint32_t i = 0; i < count && result == SLUICE_SUCCESS; i++)
        result = build(s, &s->textures[first + i]);
    uint32_t added = 0;
    while (added < count && result == SLUICE_SUCCESS) {
        result = add_to_manager(s, &s->textures[first + added], info);
        added += result == SLUICE_SUCCESS;
    }
    if (result == SLUICE_SUCCESS)
        return result;
    while (added > 0)
        sluiceRemoveStreamedTexture(s->manager, s->textures[first + --added].id, s->frame);
    for (uint32_t i = 0; i < count; i++)
        destroy_parts(s, first + i);
    return result;
}

static void publish(SluiceVulkanStreamer *s, uint32_t index, SluiceVulkanTexture *public)
{
    struct slc_texture *texture = &s->textures[index];
    const struct slc_texture *first = &s->textures[texture->first];
    const struct slc_texture *face = texture - texture->layer % SLC_CUBE_FACES;
    texture->state = SLC_TEXTURE_LIVE;
    s->forgetting.absent_count += texture->presence != SLC_PRESENT;
    if (index >= s->texture_high)
        s->texture_high = index + 1;
    s->by_manager_index[(uint32_t)texture->id] = index;
    slc_feedback_add(s, texture);
    s->new_textures[s->new_texture_count++] = index;
    texture->primary_place = SLC_NONE;
    if (texture->primary_id == SLUICE_NO_TEXTURE)
        slc_feedback_join(s, index);
    else
        slc_forgetting_keep(s, s->by_manager_index[(uint32_t)texture->primary_id]);
    *public = (SluiceVulkanTexture){
        .textureId = texture->id,
        .image = texture->image.image,
        .imageView = texture->views.layer,
        .format = slc_vk_format(texture->info.format),
        .width = texture->info.width,
        .height = texture->info.height,
        .mipLevelCount = texture->info.mipLevelCount,
        .tableIndex = index,
        .arrayLayer = texture->layer,
        .arrayView = first->views.array,
        .addressModeU = texture->sampler_kind.modes[0],
        .addressModeV = texture->sampler_kind.modes[1],
        .maxAnisotropy = texture->sampler_kind.max_anisotropy,
        .cubeView = texture->info.cube ? face->views.cube : VK_NULL_HANDLE,
        .cubeArrayView = first->views.cube_array,
        .filter = texture->filter,
        .residencyMode = slc_texture_mode(s, texture),
    };
    /* Samplers of the array cannot sample integers: elements of such textures stay empty. */
    if (s->info.textureArray != SLUICE_TEXTURE_ARRAY_NONE && texture->image.image &&
        !slc_format_is_integer(texture->info.format))
        slc_texture_array_set(&s->texture_array, index, texture->views.layer, texture->views.cube,
                              s->samplers.list[texture->sampler].sampler);
}

/* Gets the image info from the source or the producer. */
static SluiceResult describe(const SluiceVulkanStreamer *s,
                             const SluiceVulkanTextureCreateInfo *info,
                             struct slc_tile_producer *producer, SluiceImageInfo *image)
{
    if (!info->pProducer)
        return info->source ? sluiceGetImageInfo(info->source, image) : SLUICE_ERROR_NULL_POINTER;
    if (!info->source)
        return slc_tile_producer_read(producer, image, info->pProducer, &s->vk.log);
    return slc_log_refusal(&s->vk.log, "a texture has either a source or a producer, not both");
}

SluiceResult sluiceAddVulkanTextureArray(SluiceVulkanStreamer *streamer,
                                         const SluiceVulkanTextureCreateInfo *pCreateInfo,
                                         uint32_t layerCount, SluiceVulkanTexture *pLayers)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s || !pCreateInfo || !pLayers)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceImageInfo image = {.structSize = sizeof image};
    struct slc_tile_producer producer = {0};
    struct slc_image_use use;
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceVulkanTextureCreateInfo), &info, pCreateInfo, &s->vk.log);
    if (result == SLUICE_SUCCESS)
        result = check_create_info(s, &info);
    if (result == SLUICE_SUCCESS)
        result = slc_image_use_init(&use, &s->vk.log, &info);
    if (result == SLUICE_SUCCESS)
        result = describe(s, &info, &producer, &image);
    image.cube |= info.cube;
    if (result == SLUICE_SUCCESS && image.cube && info.filter != SLUICE_TEXTURE_FILTER_LINEAR)
        result = slc_log_refusal(&s->vk.log, "%s: cube maps have no bicubic filter (filter is %d)",
                                 image.pName ? image.pName : "image", (int)info.filter);
    if (result == SLUICE_SUCCESS)
        result = slc_image_info_check(&image, SLC_LEVELS_TO_TAIL, &s->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t layers = image.arrayLayerCount ? image.arrayLayerCount : 1;
    if (layerCount != layers)
        return slc_log_refusal(&s->vk.log, "layerCount is %u; the source has %u layers", layerCount,
                               layers);
    uint32_t first = find_free(s, layerCount);
    if (first == SLC_NONE)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    s->manager_locked = false;
    use.produced = producer.pfn;
    result = build_all(s, first, &info, &producer, &use, &image, layerCount);
    s->manager_locked = true;
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t i = 0; i < layerCount; i++)
        publish(s, first + i, &pLayers[i]);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceAddVulkanTexture(SluiceVulkanStreamer *streamer,
                                    const SluiceVulkanTextureCreateInfo *pCreateInfo,
                                    SluiceVulkanTexture *pTexture)
{
    return sluiceAddVulkanTextureArray(streamer, pCreateInfo, 1, pTexture);
}

/* Detaches the followers of a texture: their own feedback is read from now on. */
static void free_followers(SluiceVulkanStreamer *s, SluiceTextureId primary)
{
    for (uint32_t i = 0; i < s->texture_high; i++) {
        struct slc_texture *texture = &s->textures[i];
        if (texture->state != SLC_TEXTURE_LIVE || texture->primary_id != primary)
            continue;
        texture->primary_id = SLUICE_NO_TEXTURE;
        slc_feedback_join(s, i);
    }
}

static void forget_new(SluiceVulkanStreamer *s, uint32_t index)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->new_texture_count; i++)
        if (s->new_textures[i] != index)
            s->new_textures[kept++] = s->new_textures[i];
    s->new_texture_count = kept;
}

static SluiceResult remove_layer(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    SluiceTextureId id = texture->id;
    SluiceResult result = sluiceRemoveStreamedTexture(s->manager, id, s->frame);
    if (result != SLUICE_SUCCESS)
        return slc_streamer_check(s, result, "sluiceRemoveStreamedTexture");
    slc_forgetting_drop(s, index);
    s->forgetting.absent_count -= texture->presence != SLC_PRESENT;
    texture->state = SLC_TEXTURE_REMOVED;
    texture->removed_frame = s->frame;
    s->removed_count++;
    slc_texture_array_clear(&s->texture_array, index, texture->views.cube);
    slc_loads_drop(s, index);
    slc_control_drop(s, texture);
    slc_feedback_leave(s, index);
    free_followers(s, id);
    forget_new(s, index);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceRemoveVulkanTexture(SluiceVulkanStreamer *streamer, SluiceTextureId textureId)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s)
        return SLUICE_ERROR_NULL_POINTER;
    /* The manager validates ids. */
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    SluiceResult result = sluiceGetTextureLayout(s->manager, textureId, &layout);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_texture *texture = &s->textures[s->by_manager_index[(uint32_t)textureId]];
    assert(texture->id == textureId && texture->state == SLC_TEXTURE_LIVE);
    uint32_t first = texture->first, count = texture->layer_count;
    const SluiceImageSource *source = texture->source;
    s->manager_locked = false;
    for (uint32_t i = 0; i < count && result == SLUICE_SUCCESS; i++)
        result = remove_layer(s, first + i);
    s->manager_locked = true;
    slc_loader_drop_texels(s->loader, source); /* the source may be destroyed before the texture */
    return result;
}

SluiceResult sluiceGetVulkanSampler(SluiceVulkanStreamer *streamer, SluiceTextureId textureId,
                                    VkSampler *pSampler)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s || !pSampler)
        return SLUICE_ERROR_NULL_POINTER;
    *pSampler = VK_NULL_HANDLE;
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    SluiceResult result = sluiceGetTextureLayout(s->manager, textureId, &layout);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_texture *texture = slc_streamer_texture(s, textureId);
    uint32_t index;
    result = find_sampler(s, &texture->sampler_kind, &index);
    if (result == SLUICE_SUCCESS)
        *pSampler = s->samplers.list[index].sampler;
    return result;
}

static bool is_over(const SluiceVulkanStreamer *s, const struct slc_texture *first)
{
    bool over = first->removed_frame <= s->completed_frame;
    for (uint32_t i = 0; i < first->layer_count && over; i++)
        over = first[i].unit_count == 0 &&
               first->residency->interface->image_is_idle(first->residency, first->first + i);
    return over;
}

/* Forgets a source that the application may destroy now. Another may have its address later. */
static void forget_source(SluiceVulkanStreamer *s, const SluiceImageSource *source)
{
    if (!source)
        return;
    for (uint32_t i = 0; i < s->texture_high; i++)
        if (s->textures[i].state != SLC_TEXTURE_FREE && s->textures[i].source == source)
            return;
    sluiceDropTileLoaderStatistics(s->loader, source); /* no read of the source is in progress */
}

uint64_t slc_textures_retire(SluiceVulkanStreamer *s, uint64_t limit)
{
    for (uint32_t i = 0; i < s->texture_high && s->removed_count; i++) {
        const struct slc_texture *texture = &s->textures[i];
        if (texture->state != SLC_TEXTURE_REMOVED || texture->layer != 0)
            continue;
        uint32_t count = texture->layer_count;
        if (is_over(s, texture)) {
            const SluiceImageSource *source = texture->source;
            for (uint32_t layer = 0; layer < count; layer++)
                destroy_parts(s, i + layer);
            s->removed_count -= count;
            forget_source(s, source);
        } else if (limit >= texture->removed_frame) {
            /* Pages stay bound to the texture's slots until it is destroyed. */
            limit = texture->removed_frame ? texture->removed_frame - 1 : 0;
        }
    }
    return limit;
}

void slc_texture_destroy(SluiceVulkanStreamer *s, uint32_t index)
{
    if (s->textures[index].state != SLC_TEXTURE_FREE)
        destroy_parts(s, index);
}

bool slc_texture_is_ragged(const struct slc_texture *texture)
{
    const SluiceStreamedTextureDesc *desc = &texture->layout.desc;
    return texture->image.uneven || desc->width % desc->feedbackRegionWidth ||
           desc->height % desc->feedbackRegionHeight;
}

/* Returns 4^(first packed level), with a margin for samplers that choose finer levels. */
static float quick_packed2(const SluiceStreamedTextureDesc *desc)
{
    return ldexpf(1.5f, 2 * (int)desc->regularMipCount);
}

/* Regions are tiles. If all levels are packed, there is one region. */
static float quick_reach2(const struct slc_texture *texture)
{
    const SluiceStreamedTextureDesc *desc = &texture->layout.desc;
    bool spline = texture->filter != SLUICE_TEXTURE_FILTER_LINEAR;
    if (desc->regularMipCount == 0)
        return 1e17f; /* samplers are not trusted with derivatives beyond 1e9 texels */
    float reach = (float)slc_min_u32(desc->feedbackRegionWidth, desc->feedbackRegionHeight) /
                  (spline ? SLUICE_REACH_SPLINE : SLUICE_REACH);
    return reach * reach;
}

static uint32_t page_table_offset(const SluiceVulkanStreamer *s, uint32_t index)
{
    const struct slc_residency *residency = slc_residency_of(s, index);
    return residency->interface->page_table_offset
               ? residency->interface->page_table_offset(residency, index)
               : 0;
}

static struct SluiceTextureEntry table_entry(const SluiceVulkanStreamer *s, uint32_t index)
{
    const struct slc_texture *texture = &s->textures[index];
    SluiceFormatInfo format = {.structSize = sizeof format, .channelCount = 4};
    (void)sluiceGetFormatInfo(texture->info.format, &format);
    const SluiceStreamedTextureDesc *desc = &texture->layout.desc;
    SluiceResidencyMode mode = slc_texture_mode(s, texture);
    struct SluiceTextureEntry entry = {
        .wholeShown = texture->whole_shown,
        .width = desc->width,
        .height = desc->height,
        .mipLevelCount = desc->mipLevelCount,
        .regularMipCount = desc->regularMipCount,
        .regionWidth = desc->feedbackRegionWidth,
        .regionHeight = desc->feedbackRegionHeight,
        .regionCountX = texture->layout.feedbackWidth,
        .regionCountY = texture->layout.feedbackHeight,
        .feedbackOffset = texture->region_first,
        .minMipOffset = texture->region_first,
        .addressModeU = (uint)texture->sampler_kind.modes[0],
        .addressModeV = (uint)texture->sampler_kind.modes[1],
        .pageTableOffset = page_table_offset(s, index),
        .tileShift = slc_log2_u32(desc->tileWidth) | slc_log2_u32(desc->tileHeight) << 8,
        .samplerIndex = texture->sampler,
        .quickReach2 = quick_reach2(texture),
        .quickPacked2 = quick_packed2(desc),
        .flags =
            (texture->image.uneven ? SLUICE_TEXTURE_FLAG_UNEVEN : 0u) |
            (texture->filter != SLUICE_TEXTURE_FILTER_LINEAR ? SLUICE_TEXTURE_FLAG_SPLINE : 0u) |
            (texture->filter == SLUICE_TEXTURE_FILTER_SMART_CUBIC ? SLUICE_TEXTURE_FLAG_SMART
                                                                  : 0u) |
            (mode == SLUICE_RESIDENCY_MODE_DENSE ? SLUICE_TEXTURE_FLAG_DENSE : 0u) |
            (mode == SLUICE_RESIDENCY_MODE_PAGED ? SLUICE_TEXTURE_FLAG_PAGED : 0u) |
            format.channelCount << SLUICE_TEXTURE_COMPONENTS_SHIFT,
    };
    slc_texture_entry_complete(&entry);
    return entry;
}

void slc_textures_record_new(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    for (uint32_t i = 0; i < s->new_texture_count; i++) {
        uint32_t index = s->new_textures[i];
        struct slc_texture *texture = &s->textures[index];
        struct SluiceTextureEntry entry = table_entry(s, index);
        s->vk.CmdUpdateBuffer(commands, s->texture_table.buffer, (uint64_t)index * sizeof entry,
                              sizeof entry, &entry);
        if (!texture->cleared_frame) { /* a texture made again keeps its marks */
            slc_feedback_record_new(s, texture, commands);
            texture->cleared_frame = s->frame;
        }
        texture->recorded_frame = s->frame;
    }
    s->new_texture_count = 0;
}

void slc_textures_abandon(SluiceVulkanStreamer *s, uint64_t frame)
{
    for (uint32_t i = 0; i < s->texture_high; i++) {
        struct slc_texture *texture = &s->textures[i];
        if (texture->state != SLC_TEXTURE_LIVE)
            continue;
        if (texture->cleared_frame >= frame)
            texture->cleared_frame = 0;
        if (texture->recorded_frame < frame)
            continue;
        texture->recorded_frame = 0;
        s->new_textures[s->new_texture_count++] = i;
    }
}
