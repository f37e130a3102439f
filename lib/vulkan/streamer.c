/* Creation and destruction of a streamer, and queries of it. */
#include "vulkan/streamer.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "vulkan/around.h"
#include "vulkan/create_checks.h"
#include "vulkan/shared_parts.h"
#include "vulkan/timeline.h"

#include <sluice/shared/bindings.h>

#include <string.h>

/* Warns once if the streamer cannot allocate its first heap: without one nothing is shown. */
static void tell_of_refused_heap(SluiceVulkanStreamer *s, uint64_t size)
{
    SluiceStreamedTextureStatistics stats = {.structSize = sizeof stats};
    sluiceGetStatistics(s->manager, &stats);
    if (s->told_of_heaps || stats.heapCount > 0 || !s->residency->interface->going_size)
        return;
    s->told_of_heaps = true;
    slc_log(&s->vk.log, SLUICE_LOG_WARNING,
            "no heap of %llu bytes can be allocated: heapTileCapacity is %u, the limit of tile "
            "memory is %llu bytes, of which %llu are in use; nothing is loaded until there is one",
            (unsigned long long)size, s->info.heapTileCapacity,
            (unsigned long long)slc_memory_budget_limit(&s->context->budget),
            (unsigned long long)slc_memory_budget_tile_memory(&s->context->budget));
}

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    SluiceVulkanStreamer *s = user;
    SluiceResult result = s->residency->interface->allocate_heap(s->residency, size, heap_id);
    if (result == SLUICE_ERROR_OUT_OF_DEVICE_MEMORY)
        tell_of_refused_heap(s, size);
    s->forgetting.heap_refused |= result == SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    return result;
}

static void release_heap(void *user, uint32_t heap_id)
{
    SluiceVulkanStreamer *s = user;
    s->residency->interface->release_heap(s->residency, heap_id);
}

static void set_default(uint32_t *value, uint32_t otherwise)
{
    if (*value == 0)
        *value = otherwise;
}

/* Bounds keep every size below 2^32 bytes of staging and 2^30 regions. */
static SluiceResult check_limits(const SluiceLogCallback *log,
                                 const SluiceVulkanStreamerCreateInfo *info)
{
    const struct slc_limit limits[] = {
        {"framesInFlight", info->framesInFlight, 1, SLC_MAX_FRAMES},
        {"maxTextureCount", info->maxTextureCount, 1, 1u << 20},
        {"tilesPerFrame", info->tilesPerFrame, 1, SLC_MAX_TILES_PER_FRAME},
        {"maxLoadsInFlight", info->maxLoadsInFlight, 1, 1u << 16},
        {"heapTileCapacity", info->heapTileCapacity, 1, 1u << 20},
        {"maxRegionCount", info->maxRegionCount, SLC_REGION_ALIGNMENT, 1u << 28},
        {"feedbackEncoding", (uint32_t)info->feedbackEncoding, 0, SLUICE_FEEDBACK_ENCODING_MASKS},
        {"residencyFadeTicks", info->residencyFadeTicks, 0, SLC_MAX_FADE_TIME},
        {"residencyMode", (uint32_t)info->residencyMode, 0, SLUICE_RESIDENCY_MODE_DENSE},
        {"textureArray", (uint32_t)info->textureArray, 0, SLUICE_TEXTURE_ARRAY_SEPARATE},
    };
    return slc_check_limits(log, limits, sizeof limits / sizeof limits[0]);
}

static SluiceResult fill_in(SluiceVulkanStreamerCreateInfo *info)
{
    const SluiceLogCallback *log = &info->context->vk.log;
    set_default(&info->framesInFlight, 3);
    set_default(&info->maxTextureCount, SLC_DEFAULT_TEXTURE_COUNT);
    set_default(&info->texturesPerFrame, 10);
    set_default(&info->tilesPerFrame, 256);
    set_default(&info->maxLoadsInFlight,
                slc_max_u32(64, 4 * slc_min_u32(info->tilesPerFrame, SLC_MAX_TILES_PER_FRAME)));
    set_default(&info->heapTileCapacity, SLUICE_DEFAULT_HEAP_TILE_CAPACITY);
    set_default(&info->maxRegionCount, 1u << 20);
    set_default(&info->maxTexturesPerFrame, info->texturesPerFrame);
    info->maxTexturesPerFrame = slc_min_u32(info->maxTexturesPerFrame, info->maxTextureCount);
    info->texturesPerFrame = slc_min_u32(info->texturesPerFrame, info->maxTextureCount);
    set_default(&info->feedbackReadbackSize, slc_min_u32(info->maxRegionCount, 1u << 22));
    SluiceResult result = check_limits(log, info);
    if (result == SLUICE_SUCCESS && info->maxTexturesPerFrame < info->texturesPerFrame)
        result = slc_log_refusal(
            log, "maxTexturesPerFrame is %u; it must be texturesPerFrame, %u, at least",
            info->maxTexturesPerFrame, info->texturesPerFrame);
    if (result == SLUICE_SUCCESS)
        result = slc_forgetting_fill_in(info, log);
    return result == SLUICE_SUCCESS ? slc_fill_in_times(info, log) : result;
}

/* Returns the largest possible heap. Heaps without memory are limited by the device's memory. */
static uint64_t largest_heap(const SluiceVulkanStreamer *s)
{
    uint64_t limit = slc_device_memory_size(&s->caps);
    if (!s->residency->interface->going_size)
        return limit;
    limit = slc_min_u64(limit, slc_memory_budget_limit(&s->context->budget));
    return s->caps.max_allocation_size ? slc_min_u64(limit, s->caps.max_allocation_size) : limit;
}

/* Makes heaps smaller if none of heapTileCapacity tiles can be allocated. */
static void fit_heaps(SluiceVulkanStreamer *s)
{
    uint64_t limit = largest_heap(s);
    uint64_t most = limit / SLC_TILE_SIZE, given = s->info.heapTileCapacity;
    if (given <= most)
        return;
    uint32_t fitting = slc_max_u32(1, (uint32_t)(most / 4));
    s->info.heapTileCapacity = slc_min_u32(SLUICE_DEFAULT_HEAP_TILE_CAPACITY, fitting);
    slc_log(&s->vk.log, SLUICE_LOG_WARNING,
            "heapTileCapacity is %u, heaps of %llu bytes; the limit of a heap is %llu bytes: heaps "
            "have %u tiles instead",
            (unsigned)given, (unsigned long long)given * SLC_TILE_SIZE, (unsigned long long)limit,
            s->info.heapTileCapacity);
}

static SluiceResult create_manager(SluiceVulkanStreamer *s)
{
    fit_heaps(s);
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {s, allocate_heap, release_heap},
        .pAllocator = &s->cb,
        .heapTileCapacity = s->info.heapTileCapacity,
        .tileSize = SLC_TILE_SIZE,
        .alwaysMapPackedTiles = !s->info.packedLevelsOnDemand,
        .pLocked = &s->manager_locked,
        .log = s->vk.log,
    };
    SluiceResult result = sluiceCreateStreamedTextureManager(&info, &s->manager);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceStreamedTextureManagerConfig config = {
        .structSize = sizeof config,
        .numExtraStandbyTiles = s->info.numExtraStandbyTiles,
        .maxHeapCount = s->info.maxHeapCount,
        .retryDelayTicks = s->info.retryDelayTicks,
        .givenUpRetryDelayTicks = s->info.givenUpRetryDelayTicks,
        .separatePackedTiles = true,
    };
    result = sluiceSetConfig(s->manager, &config);
    if (result == SLUICE_SUCCESS && s->residency->interface->prepare_heaps)
        s->residency->interface->prepare_heaps(
            s->residency, (uint64_t)s->info.heapTileCapacity * SLC_TILE_SIZE, s->info.maxHeapCount);
    return result;
}

static SluiceResult create_arrays(SluiceVulkanStreamer *s)
{
    const SluiceAllocationCallbacks *cb = &s->cb;
    uint32_t textures = s->info.maxTextureCount, tiles = s->info.tilesPerFrame;
    s->textures = slc_calloc(cb, textures, sizeof *s->textures);
    s->by_manager_index = slc_calloc(cb, textures, sizeof *s->by_manager_index);
    s->primaries = slc_alloc(cb, textures, sizeof *s->primaries);
    s->due_maps = slc_alloc(cb, textures, sizeof *s->due_maps);
    s->new_textures = slc_alloc(cb, textures, sizeof *s->new_textures);
    s->packed_queue = slc_alloc(cb, textures, sizeof *s->packed_queue);
    s->frame_units = slc_alloc(cb, tiles, sizeof *s->frame_units);
    s->tiles = slc_alloc(cb, tiles, sizeof *s->tiles);
    s->tile_indices = slc_alloc(cb, tiles, sizeof *s->tile_indices);
    s->copy_capacity = tiles * SLUICE_MAX_READ_REGIONS;
    s->copies = slc_alloc(cb, s->copy_capacity, sizeof *s->copies);
    s->min_mip_texels = slc_alloc(cb, s->info.maxRegionCount, sizeof *s->min_mip_texels);
    s->min_mip_levels = slc_alloc(cb, s->info.maxRegionCount, 1);
    s->fades = slc_alloc(cb, textures, sizeof *s->fades);
    s->around_row = slc_alloc(cb, SLC_AROUND_SCRATCH, sizeof *s->around_row);
    s->around_words = slc_alloc(cb, SLC_MAX_MAP_WIDTH, sizeof *s->around_words);
    s->turns = slc_calloc(cb, 1, slc_turns_size(s));
    s->min_mip_staging = slc_calloc(cb, s->info.framesInFlight, sizeof *s->min_mip_staging);
    s->feedback_levels = slc_alloc(cb, s->info.maxRegionCount, 1);
    if (s->debug.mapEverything)
        s->zero_map = slc_calloc(cb, s->info.maxRegionCount, 1);
    if (!s->textures || !s->by_manager_index || !s->primaries || !s->due_maps || !s->new_textures ||
        !s->packed_queue || !s->frame_units || !s->tiles || !s->tile_indices || !s->copies ||
        !s->min_mip_texels || !s->min_mip_levels || !s->fades || !s->around_row ||
        !s->feedback_levels || !s->turns || !s->min_mip_staging || !s->around_words ||
        (s->debug.mapEverything && !s->zero_map))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memset(s->min_mip_texels, 0xFF, s->info.maxRegionCount * sizeof *s->min_mip_texels);
    memset(s->min_mip_levels, SLUICE_MIP_UNTOUCHED, s->info.maxRegionCount);
    s->fade_clock.time_per_level = s->info.residencyFadeTicks;
    s->most_textures_per_frame = s->info.maxTexturesPerFrame;
    s->next_textures_per_frame = s->info.texturesPerFrame;
    s->next_frames_per_round = s->info.framesPerRound;
    return slc_region_arena_init(&s->regions, cb, s->info.maxRegionCount, textures);
}

static struct slc_resolve_create_info resolve_info(const SluiceVulkanStreamer *s)
{
    return (struct slc_resolve_create_info){.feedback = s->feedback.buffer,
                                            .readback = s->readback.buffer.buffer,
                                            .region_capacity = s->regions.size,
                                            .slot_count = s->info.framesInFlight,
                                            .max_items = s->most_textures_per_frame,
                                            .encoding = (uint32_t)s->info.feedbackEncoding};
}

/* Shaders see each of the storage buffers as a whole. */
static SluiceResult check_buffer_sizes(const SluiceVulkanStreamer *s)
{
    uint64_t limit = s->caps.max_storage_buffer_range;
    struct slc_resolve_create_info resolve = resolve_info(s);
    const char *setting = NULL;
    if ((uint64_t)s->info.maxTextureCount * sizeof(struct SluiceTextureEntry) > limit)
        setting = "maxTextureCount";
    else if (slc_feedback_size(s, s->regions.size) > limit)
        setting = "maxRegionCount";
    else if (slc_resolve_table_size(&resolve) > limit || slc_resolve_scratch_size(&resolve) > limit)
        setting = "maxTexturesPerFrame";
    else if (slc_readback_ring_size(s->info.framesInFlight, s->most_textures_per_frame,
                                    s->info.feedbackReadbackSize / 4) > limit)
        setting = "feedbackReadbackSize";
    if (!setting)
        return SLUICE_SUCCESS;
    slc_log(&s->vk.log, SLUICE_LOG_ERROR, "%s needs a storage buffer beyond the %llu bytes of %s",
            setting, (unsigned long long)limit, s->caps.public.deviceName);
    return SLUICE_ERROR_LIMIT_EXCEEDED;
}

static void name_buffers(const SluiceVulkanStreamer *s)
{
    slc_buffer_set_name(&s->texture_table, &s->vk, "texture table");
    slc_buffer_set_name(&s->feedback, &s->vk, "feedback");
    slc_buffer_set_name(&s->feedback_turns, &s->vk, "feedback turns");
    slc_buffer_set_name(&s->min_mip, &s->vk, "MinMip maps");
}

static SluiceResult create_buffers(SluiceVulkanStreamer *s)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    uint64_t min_mip_size = (uint64_t)s->regions.size * sizeof(uint32_t);
    SluiceResult result = check_buffer_sizes(s);
    if (result == SLUICE_SUCCESS)
        result =
            slc_buffer_init(&s->texture_table, &s->vk, &s->caps,
                            (uint64_t)s->info.maxTextureCount * sizeof(struct SluiceTextureEntry),
                            usage, SLC_BUFFER_DEVICE);
    if (result == SLUICE_SUCCESS)
        result = slc_buffer_init(&s->feedback, &s->vk, &s->caps,
                                 slc_feedback_size(s, s->regions.size), usage, SLC_BUFFER_DEVICE);
    if (result == SLUICE_SUCCESS)
        result = slc_buffer_init(&s->feedback_turns, &s->vk, &s->caps, slc_turns_size(s), usage,
                                 SLC_BUFFER_DEVICE);
    if (result == SLUICE_SUCCESS)
        result =
            slc_buffer_init(&s->min_mip, &s->vk, &s->caps, min_mip_size, usage, SLC_BUFFER_DEVICE);
    if (result == SLUICE_SUCCESS)
        result =
            slc_readback_ring_init(&s->readback, &s->vk, &s->caps, &s->cb, s->info.framesInFlight,
                                   s->most_textures_per_frame, s->info.feedbackReadbackSize / 4);
    name_buffers(s);
    struct slc_resolve_create_info resolve = resolve_info(s);
    if (result == SLUICE_SUCCESS)
        result = slc_resolve_init(&s->resolve, &s->vk, &s->caps, &resolve);
    return result;
}

/* Without pages one element makes the layout that the shaders expect. */
static SluiceResult create_descriptors(SluiceVulkanStreamer *s)
{
    bool paged = slc_residency_of_pages(s) != NULL;
    struct slc_descriptors_create_info info = {.buffer_count = SLUICE_BINDING_BUFFER_COUNT,
                                               .page_count = paged ? s->pages->views.count : 1,
                                               .textures = &s->texture_array,
                                               .set_count = s->info.framesInFlight};
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    slc_streamer_fill_buffers(s, &buffers);
    info.buffers[SLUICE_BINDING_TEXTURE_TABLE] = buffers.textureTable;
    info.buffers[SLUICE_BINDING_MIN_MIP] = buffers.minMip;
    info.buffers[SLUICE_BINDING_FEEDBACK] = buffers.feedback;
    info.buffers[SLUICE_BINDING_FEEDBACK_TURNS] = buffers.feedbackTurns;
    info.buffers[SLUICE_BINDING_PAGE_TABLE] = buffers.pageTable;
    SluiceResult result = slc_texture_array_init(
        &s->texture_array, &s->vk, &s->cb, s->info.textureArray, s->info.maxTextureCount,
        s->pages->views.image.image, s->pages->views.sampler, &s->samplers);
    if (result == SLUICE_SUCCESS)
        result = slc_descriptors_init(&s->descriptors, &s->vk, &s->caps, &info);
    return result;
}

static SluiceResult create_device_parts(SluiceVulkanStreamer *s)
{
    SluiceResult result = slc_timeline_create(&s->vk, "frames", &s->semaphore);
    if (result == SLUICE_SUCCESS)
        result = slc_use_pages(&s->context->shared, &s->pages);
    if (result == SLUICE_SUCCESS)
        result = slc_page_pool_add_user(s->pages, s->semaphore, 0, &s->memory, &s->page_user);
    if (result == SLUICE_SUCCESS)
        result = slc_residencies_create(s);
    if (result == SLUICE_SUCCESS)
        result = create_buffers(s);
    if (result == SLUICE_SUCCESS)
        result = create_descriptors(s);
    if (result == SLUICE_SUCCESS)
        result = create_manager(s);
    if (result == SLUICE_SUCCESS)
        result = slc_loads_init(s);
    if (result == SLUICE_SUCCESS && s->context->upload_queue)
        result = slc_upload_queue_init(&s->uploads, &s->vk, s->context->upload_queue,
                                       s->context->upload_family);
    return result;
}

SluiceResult sluiceCreateVulkanStreamer(const SluiceVulkanStreamerCreateInfo *pCreateInfo,
                                        SluiceVulkanStreamer **pStreamer)
{
    if (!pStreamer)
        return SLUICE_ERROR_NULL_POINTER;
    *pStreamer = NULL;
    if (!pCreateInfo || !pCreateInfo->context)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceVulkanContext *context = pCreateInfo->context;
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info};
    SluiceVulkanStreamerDebugInfo debug = {.structSize = sizeof debug};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceVulkanStreamerCreateInfo), &info,
                                          pCreateInfo, &context->vk.log);
    if (result == SLUICE_SUCCESS && info.pDebug)
        result = slc_struct_read(SLC_STRUCT(SluiceVulkanStreamerDebugInfo), &debug, info.pDebug,
                                 &context->vk.log);
    info.pDebug = NULL; /* `debug` has a copy */
    if (result == SLUICE_SUCCESS)
        result = fill_in(&info);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceVulkanStreamer *s = slc_calloc(&context->cb, 1, sizeof *s);
    if (!s)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    slc_context_add_child(context);
    s->context = context;
    s->cb = context->cb;
    s->vk = context->vk;
    slc_memory_client_init(&s->memory, &context->budget);
    s->vk.memory_client = &s->memory;
    s->caps = context->caps;
    s->info = info;
    s->debug = debug;
    s->page_user = SLC_MAX_PAGE_USERS;
    s->time_check.on = pCreateInfo->ticksPerSecond == 0;
    result = slc_streamer_use_addresses(s);
    if (result == SLUICE_SUCCESS)
        result = create_arrays(s);
    if (result == SLUICE_SUCCESS)
        result = slc_forgetting_init(s);
    if (result == SLUICE_SUCCESS)
        result = create_device_parts(s);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyVulkanStreamer(s);
        return result;
    }
    s->manager_locked = true;
    *pStreamer = s;
    return SLUICE_SUCCESS;
}

static void free_arrays(SluiceVulkanStreamer *s)
{
    const SluiceAllocationCallbacks *cb = &s->cb;
    uint32_t textures = s->info.maxTextureCount, tiles = s->info.tilesPerFrame;
    slc_forgetting_finish(s);
    slc_control_finish(s);
    slc_region_arena_finish(&s->regions, cb);
    slc_free(cb, s->zero_map, s->info.maxRegionCount, 1);
    slc_free(cb, s->min_mip_staging, s->info.framesInFlight, sizeof *s->min_mip_staging);
    slc_free(cb, s->turns, 1, slc_turns_size(s));
    slc_free(cb, s->feedback_levels, s->info.maxRegionCount, 1);
    slc_free(cb, s->fades, textures, sizeof *s->fades);
    slc_free(cb, s->around_words, SLC_MAX_MAP_WIDTH, sizeof *s->around_words);
    slc_free(cb, s->around_row, SLC_AROUND_SCRATCH, sizeof *s->around_row);
    slc_free(cb, s->min_mip_levels, s->info.maxRegionCount, 1);
    slc_free(cb, s->min_mip_texels, s->info.maxRegionCount, sizeof *s->min_mip_texels);
    slc_free(cb, s->copies, s->copy_capacity, sizeof *s->copies);
    slc_free(cb, s->tile_indices, tiles, sizeof *s->tile_indices);
    slc_free(cb, s->tiles, tiles, sizeof *s->tiles);
    slc_free(cb, s->frame_units, tiles, sizeof *s->frame_units);
    slc_free(cb, s->packed_queue, textures, sizeof *s->packed_queue);
    slc_free(cb, s->new_textures, textures, sizeof *s->new_textures);
    slc_free(cb, s->primaries, textures, sizeof *s->primaries);
    slc_free(cb, s->by_manager_index, textures, sizeof *s->by_manager_index);
    slc_free(cb, s->textures, textures, sizeof *s->textures);
}

/* Waits for frames that were ended. Others cannot have been submitted. */
static void wait_for_own_work(SluiceVulkanStreamer *s)
{
    uint64_t frame = slc_streamer_last_submittable(s);
    if (frame > s->completed_frame)
        slc_timeline_wait(&s->vk, s->semaphore, frame, "frame");
    if (s->residency)
        s->residency->interface->wait(s->residency);
    slc_upload_queue_drain(&s->uploads, &s->vk);
}

static void destroy_device_parts(SluiceVulkanStreamer *s)
{
    wait_for_own_work(s);
    slc_upload_queue_finish(&s->uploads, &s->vk);
    slc_loads_finish(s);
    for (uint32_t i = 0; i < s->texture_high; i++)
        slc_texture_destroy(s, i);
    s->manager_locked = false;
    sluiceDestroyStreamedTextureManager(s->manager); /* releases its heaps */
    slc_descriptors_finish(&s->descriptors, &s->vk);
    slc_texture_array_finish(&s->texture_array, &s->vk, &s->cb);
    slc_samplers_finish(&s->samplers, &s->vk, &s->cb);
    slc_resolve_finish(&s->resolve, &s->vk);
    slc_readback_ring_finish(&s->readback, &s->vk, &s->cb);
    for (uint32_t i = 0; s->min_mip_staging && i < s->info.framesInFlight; i++)
        slc_buffer_finish(&s->min_mip_staging[i], &s->vk);
    slc_buffer_finish(&s->min_mip, &s->vk);
    slc_buffer_finish(&s->feedback_turns, &s->vk);
    slc_buffer_finish(&s->feedback, &s->vk);
    slc_buffer_finish(&s->texture_table, &s->vk);
    slc_residencies_destroy(s);
    if (s->page_user < SLC_MAX_PAGE_USERS)
        slc_page_pool_remove_user(s->pages, s->page_user);
    slc_drop_pages(&s->context->shared, s->pages);
    s->vk.DestroySemaphore(s->vk.device, s->semaphore, NULL);
}

void sluiceDestroyVulkanStreamer(SluiceVulkanStreamer *streamer)
{
    if (!streamer)
        return;
    SluiceVulkanContext *context = streamer->context;
    destroy_device_parts(streamer);
    slc_memory_client_finish(&streamer->memory);
    free_arrays(streamer);
    slc_free(&context->cb, streamer, 1, sizeof *streamer);
    slc_context_remove_child(context);
}

SluiceResult sluiceWaitVulkanStreamerIdle(SluiceVulkanStreamer *streamer)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s)
        return SLUICE_ERROR_NULL_POINTER;
    sluiceWaitTileLoaderIdle(s->loader);
    SluiceResult result = slc_upload_queue_wait(&s->uploads, &s->vk);
    return result == SLUICE_SUCCESS ? s->residency->interface->wait(s->residency) : result;
}

SluiceResult sluiceGetVulkanDescriptorSetLayout(const SluiceVulkanStreamer *streamer,
                                                VkDescriptorSetLayout *pLayout)
{
    if (!streamer || !pLayout)
        return SLUICE_ERROR_NULL_POINTER;
    return slc_descriptors_get_layout(&streamer->descriptors, &streamer->vk, &streamer->caps,
                                      pLayout);
}

SluiceResult sluiceGetVulkanPages(const SluiceVulkanStreamer *streamer, SluiceVulkanPages *pPages)
{
    if (!streamer || !pPages)
        return SLUICE_ERROR_NULL_POINTER;
    return slc_page_pool_write_views(streamer->pages, streamer->page_user, pPages);
}

static void take_manager_counts(const SluiceStreamedTextureManager *manager,
                                SluiceVulkanStreamerStatistics *out)
{
    SluiceStreamedTextureStatistics s = {.structSize = sizeof s};
    sluiceGetStatistics(manager, &s);
    out->textureCount = s.textureCount;
    out->tileCount = s.tileCount;
    out->requestedTileCount = s.requestedTileCount;
    out->allocatedTileCount = s.allocatedTileCount;
    out->mappedTileCount = s.mappedTileCount;
    out->standbyTileCount = s.standbyTileCount;
    out->canceledTileCount = s.canceledTileCount;
    out->failedTileCount = s.failedTileCount;
    out->givenUpTileCount = s.givenUpTileCount;
    out->retiringSlotCount = s.retiringSlotCount;
    out->heapCount = s.heapCount;
    out->globalMipBias = s.globalMipBias;
}

SluiceResult sluiceGetVulkanStreamerStatistics(const SluiceVulkanStreamer *streamer,
                                               SluiceVulkanStreamerStatistics *pStatistics)
{
    if (!streamer || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked = slc_struct_check(SLC_STRUCT(SluiceVulkanStreamerStatistics), pStatistics,
                                            &streamer->vk.log);
    if (checked != SLUICE_SUCCESS)
        return checked;
    SluiceVulkanStreamerStatistics statistics = streamer->counts;
    take_manager_counts(streamer->manager, &statistics);
    const struct slc_residency_counters *counters = &streamer->residency->counters;
    statistics.bindCalls = counters->bind_calls;
    statistics.bindRuns = counters->bind_runs;
    statistics.unbinds = counters->unbinds;
    statistics.unbindsSaved = counters->unbinds_saved;
    statistics.tileMemorySize = slc_memory_client_tiles(streamer->vk.memory_client) +
                                slc_page_pool_get_counts(streamer->pages).tile_memory_size;
    slc_memory_client_get(streamer->vk.memory_client, &statistics.deviceMemorySize,
                          &statistics.hostVisibleMemorySize);
    statistics.deviceMemorySize += slc_page_pool_get_counts(streamer->pages).device_memory_size;
    if (slc_residency_of_pages(streamer))
        counters = &slc_residency_of_pages(streamer)->counters;
    statistics.pageChunkCount = counters->page_chunks;
    statistics.pageChunkShortages = counters->page_chunk_shortages;
    statistics.fadingTextures = streamer->fade_count;
    statistics.absentTextureCount = streamer->forgetting.absent_count;
    uint32_t uploaded = 0;
    for (uint32_t unit = streamer->uploaded.first; unit != SLC_NONE;
         unit = streamer->units[unit].next)
        uploaded++;
    statistics.loadsInFlight =
        streamer->info.maxLoadsInFlight - streamer->free_unit_count - uploaded;
    slc_struct_write(SLC_STRUCT(SluiceVulkanStreamerStatistics), pStatistics, &statistics);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetVulkanReadStatistics(SluiceVulkanStreamer *streamer,
                                           const SluiceImageSource *source,
                                           SluiceTileLoaderStatistics *pStatistics)
{
    return streamer ? sluiceGetTileLoaderStatistics(streamer->loader, source, pStatistics)
                    : SLUICE_ERROR_NULL_POINTER;
}

SluiceResult sluiceGetVulkanResidencyMode(const SluiceVulkanStreamer *streamer,
                                          SluiceResidencyMode *pMode)
{
    if (!streamer || !pMode)
        return SLUICE_ERROR_NULL_POINTER;
    *pMode = streamer->info.residencyMode;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetVulkanStreamerManager(SluiceVulkanStreamer *streamer,
                                            SluiceStreamedTextureManager **pManager)
{
    if (!streamer || !pManager)
        return SLUICE_ERROR_NULL_POINTER;
    *pManager = streamer->manager;
    return SLUICE_SUCCESS;
}
