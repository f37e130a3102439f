#include "vulkan/texture_forgetting.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "core/forget_texture.h"
#include "image/format_size.h"
#include "vulkan/texture_mode.h"

#include <assert.h>

#define FORGOTTEN_PER_FRAME 256u
#define LOOKED_AT_PER_FRAME 1024u
#define MAX_HUNGER 8u
#define FORGOTTEN_FOR_HEAP 64u /* a guess: how many textures make room for a heap is unknown */

SluiceResult slc_forgetting_fill_in(SluiceVulkanStreamerCreateInfo *info,
                                    const SluiceLogCallback *log)
{
    if (info->forgetAfterFrames && !info->forgetTextures)
        return slc_log_refusal(log, "forgetAfterFrames is %u, and forgetTextures is not set",
                               info->forgetAfterFrames);
    if (info->forgetTextures && info->textureArray == SLUICE_TEXTURE_ARRAY_NONE)
        return slc_log_refusal(log,
                               "forgetTextures is set, and textureArray is %d: images that "
                               "come and go need the array",
                               (int)info->textureArray);
    info->packedLevelsOnDemand |= info->forgetTextures;
    return SLUICE_SUCCESS;
}

SluiceResult slc_forgetting_init(SluiceVulkanStreamer *s)
{
    struct slc_forgetting *f = &s->forgetting;
    f->first = f->last = SLC_NONE;
    if (!s->info.forgetTextures)
        return SLUICE_SUCCESS;
    f->leaving = slc_alloc(&s->cb, s->info.maxTextureCount, sizeof *f->leaving);
    return f->leaving ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_forgetting_finish(SluiceVulkanStreamer *s)
{
    slc_free(&s->cb, s->forgetting.leaving, s->info.maxTextureCount, sizeof(uint32_t));
}

/* The order of use --------------------------------------------------------------------------- */

static void unlink_texture(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_forgetting *f = &s->forgetting;
    struct slc_texture *texture = &s->textures[index];
    if (!texture->in_order)
        return;
    if (texture->used_before == SLC_NONE)
        f->first = texture->used_after;
    else
        s->textures[texture->used_before].used_after = texture->used_after;
    if (texture->used_after == SLC_NONE)
        f->last = texture->used_before;
    else
        s->textures[texture->used_after].used_before = texture->used_before;
    texture->in_order = false;
    f->count--;
}

static void append_texture(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_forgetting *f = &s->forgetting;
    struct slc_texture *texture = &s->textures[index];
    assert(!texture->in_order);
    texture->used_before = f->last;
    texture->used_after = SLC_NONE;
    if (f->last == SLC_NONE)
        f->first = index;
    else
        s->textures[f->last].used_after = index;
    f->last = index;
    texture->used_frame = s->frame;
    texture->in_order = true;
    f->count++;
}

static void use(SluiceVulkanStreamer *s, uint32_t index)
{
    unlink_texture(s, index);
    append_texture(s, index);
}

void slc_forgetting_used(SluiceVulkanStreamer *s, uint32_t index)
{
    if (s->textures[index].in_order && slc_manager_wants_texture(s->manager, s->textures[index].id))
        use(s, index);
}

/* Adding ------------------------------------------------------------------------------------- */

bool slc_forgetting_allows(const SluiceVulkanStreamer *s, const SluiceVulkanTextureCreateInfo *info,
                           const SluiceImageInfo *image)
{
    return s->info.forgetTextures && info->source && info->primaryId == SLUICE_NO_TEXTURE &&
           image->arrayLayerCount <= 1 && !image->cube && !info->mutableFormat &&
           info->viewFormatCount == 0 && !slc_format_is_integer(image->format);
}

/* Computes the layout that residency_dense.c or residency_paged.c would make, without an image. */
static SluiceResult describe_without_memory(const SluiceVulkanStreamer *s,
                                            const struct slc_residency *residency,
                                            const SluiceImageInfo *image,
                                            struct slc_residency_image *out)
{
    struct slc_sparse_layout layout;
    if (!residency->interface->ordinary_images && !residency->interface->page_table)
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    SluiceResult result = residency == s->plain ? slc_whole_layout_init(&layout, image)
                                                : slc_standard_layout_init(&layout, image);
    bool paged = residency->interface->page_table;
    if (result != SLUICE_SUCCESS)
        return result;
    layout.desc.packedTilesOutside |= residency == s->paged;
    *out = (struct slc_residency_image){
        .desc = layout.desc,
        .uneven = layout.uneven,
        .first_level = paged ? layout.desc.regularMipCount : 0,
    };
    return SLUICE_SUCCESS;
}

SluiceResult slc_forgetting_describe(SluiceVulkanStreamer *s, uint32_t index,
                                     SluiceResidencyMode mode, const SluiceImageInfo *image,
                                     struct slc_residency **residency,
                                     struct slc_residency_image *out)
{
    SluiceResult result = slc_texture_try_image(s, index, mode, image, residency, out);
    if (result == SLUICE_ERROR_OUT_OF_DEVICE_MEMORY) /* other errors stand */
        return describe_without_memory(s, *residency, image, out);
    if (result == SLUICE_SUCCESS) {
        (*residency)->interface->destroy_image(*residency, index);
        out->image = VK_NULL_HANDLE;
    }
    return result;
}

void slc_forgetting_keep(SluiceVulkanStreamer *s, uint32_t index)
{
    unlink_texture(s, index);
    s->textures[index].forgettable = false;
}

void slc_forgetting_drop(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_forgetting *f = &s->forgetting;
    unlink_texture(s, index);
    for (uint32_t i = 0; i < f->leaving_count; i++)
        if (f->leaving[i] == index) {
            f->leaving[i] = f->leaving[--f->leaving_count];
            return;
        }
}

/* Waking ------------------------------------------------------------------------------------- */

static SluiceResult make_image(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    struct slc_residency *residency = texture->residency;
    const struct slc_residency_interface *interface = residency->interface;
    const struct slc_image_use sampled = {0};
    struct slc_residency_image image;
    SluiceResult result =
        interface->create_image(residency, index, &texture->info, &sampled, NULL, &image);
    if (result != SLUICE_SUCCESS)
        return result;
    assert(image.desc.regularMipCount == texture->image.desc.regularMipCount);
    result = slc_texture_views_init(&texture->views, &s->vk, image.image, &texture->info, 0,
                                    s->caps.image_cube_array);
    if (result != SLUICE_SUCCESS) {
        slc_texture_views_finish(&texture->views, &s->vk);
        interface->destroy_image(residency, index);
        return result;
    }
    texture->image = image;
    if (interface->set_source)
        interface->set_source(residency, index, texture->source, 0);
    return SLUICE_SUCCESS;
}

bool slc_forgetting_wake(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    if (texture->presence == SLC_PRESENT)
        return true;
    if (texture->presence == SLC_LEAVING || s->forgetting.refused_frame == s->frame)
        return false;
    if (make_image(s, index) != SLUICE_SUCCESS) { /* tried again in the next frame */
        s->forgetting.refused_frame = s->frame;
        return false;
    }
    texture->presence = SLC_PRESENT;
    s->forgetting.absent_count--;
    if (texture->forgettable)
        append_texture(s, index);
    slc_texture_array_set(&s->texture_array, index, texture->views.layer, VK_NULL_HANDLE,
                          s->samplers.list[texture->sampler].sampler);
    if (texture->recorded_frame) {
        texture->recorded_frame = 0;
        s->new_textures[s->new_texture_count++] = index;
    }
    return true;
}

/* Forgetting --------------------------------------------------------------------------------- */

/* True if no load of the texture is in progress, and its first frame was recorded. */
static bool is_at_rest(const struct slc_texture *texture)
{
    return texture->unit_count == 0 && texture->packed_state == SLC_PACKED_COLLECTING &&
           texture->packed_collected == 0 && texture->recorded_frame;
}

static bool forget(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_forgetting *f = &s->forgetting;
    struct slc_texture *texture = &s->textures[index];
    const struct slc_residency_interface *interface = texture->residency->interface;
    if (!is_at_rest(texture))
        return false;
    SluiceResult result = sluiceForgetStreamedTexture(s->manager, texture->id, s->frame);
    if (result != SLUICE_SUCCESS) {
        slc_streamer_check(s, result, "sluiceForgetStreamedTexture");
        return false;
    }
    unlink_texture(s, index);
    if (interface->leave_source)
        interface->leave_source(texture->residency, index);
    slc_texture_array_clear(&s->texture_array, index, false);
    texture->packed_mapped = 0;
    texture->presence = SLC_LEAVING;
    texture->removed_frame = s->frame;
    f->leaving[f->leaving_count++] = index;
    f->absent_count++;
    s->counts.texturesForgotten++;
    return true;
}

static uint32_t count_waiting(const SluiceVulkanStreamer *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->packed_queue_count; i++)
        count += s->textures[s->packed_queue[i]].presence != SLC_PRESENT;
    return count;
}

/* Returns how many textures to forget because memory is short. Doubles with each frame that still
 * lacks memory: a large image may need the memory of many textures. */
static uint32_t count_lacking(SluiceVulkanStreamer *s)
{
    struct slc_forgetting *f = &s->forgetting;
    bool refused = f->refused_frame && f->refused_frame + 1 == s->frame;
    f->hunger = refused ? slc_min_u32(f->hunger + 1, MAX_HUNGER) : 0;
    uint32_t count = refused ? count_waiting(s) << (f->hunger - 1) : 0;
    if (f->heap_refused || s->memory_pressure.beyond)
        count = slc_max_u32(count, FORGOTTEN_FOR_HEAP);
    f->heap_refused = false;
    count = slc_min_u32(count, FORGOTTEN_PER_FRAME);
    return count > f->leaving_count ? count - f->leaving_count : 0;
}

/* Adds memory pressure, because all textures are in use: an unneeded heap or chunk is then freed.
 * Warns if that does not help. */
static void ask_others(SluiceVulkanStreamer *s)
{
    if (s->memory_pressure.refused == 0)
        s->memory_pressure.refused = 1;
    if (s->forgetting.hunger < MAX_HUNGER || s->forgetting.told)
        return;
    s->forgetting.told = true;
    slc_log(&s->vk.log, SLUICE_LOG_WARNING,
            "no memory for the images of %u textures that are sampled, and no other texture can be "
            "forgotten: they show the fallback color",
            count_waiting(s));
}

SluiceResult slc_forgetting_step(SluiceVulkanStreamer *s)
{
    struct slc_forgetting *f = &s->forgetting;
    const uint32_t age = s->info.forgetAfterFrames;
    uint32_t lacking = s->info.forgetTextures ? count_lacking(s) : 0, gone = 0;
    uint32_t left = slc_min_u32(f->count, LOOKED_AT_PER_FRAME);
    for (; left > 0 && gone < FORGOTTEN_PER_FRAME; left--) {
        uint32_t index = f->first;
        bool old = age && s->frame - s->textures[index].used_frame > age;
        if (!old && gone >= lacking)
            break;
        if (forget(s, index))
            gone++;
        else
            use(s, index); /* tiles of the texture are wanted or loading */
    }
    if (lacking && gone == 0 && f->leaving_count == 0)
        ask_others(s);
    return SLUICE_SUCCESS;
}

static void destroy_image(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_texture *texture = &s->textures[index];
    slc_texture_views_finish(&texture->views, &s->vk);
    texture->residency->interface->destroy_image(texture->residency, index);
    texture->image.image = VK_NULL_HANDLE;
    texture->presence = SLC_FORGOTTEN;
}

uint64_t slc_forgetting_retire(SluiceVulkanStreamer *s, uint64_t limit)
{
    struct slc_forgetting *f = &s->forgetting;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < f->leaving_count; i++) {
        uint32_t index = f->leaving[i];
        const struct slc_texture *texture = &s->textures[index];
        if (texture->removed_frame <= s->completed_frame &&
            texture->residency->interface->image_is_idle(texture->residency, index)) {
            destroy_image(s, index);
            continue;
        }
        /* Pages stay bound to the texture's slots until its image is destroyed. */
        limit = slc_min_u64(limit, texture->removed_frame - 1);
        f->leaving[kept++] = index;
    }
    f->leaving_count = kept;
    return limit;
}
