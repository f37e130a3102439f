/* Creation and destruction of a demand loader, and queries of it. */
#include "demand_vulkan/loader.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "vulkan/create_checks.h"
#include "vulkan/format_caps.h"
#include "vulkan/region_arena.h"
#include "vulkan/shared_parts.h"
#include "vulkan/sparse_layout.h"
#include "vulkan/timeline.h"

#include <sluice/shared/bindings.h>
#include <sluice/shared/demand.h>

#include <string.h>

#define MAX_TEXTURES (1u << 24)
#define MAX_PAGES (UINT64_C(1) << 31)
#define MAX_REQUESTS (1u << 20)
#define MAX_TILES_IN_FLIGHT (1u << 16)
#define MIN_BUDGET (UINT64_C(4) << 20)
#define MAX_GRIDS (1u << 16) /* separate ranges of cells */

static uint32_t or_default(uint32_t value, uint32_t otherwise)
{
    return value ? value : otherwise;
}

static SluiceResult check_limits(const SluiceLogCallback *log,
                                 const SluiceDemandLoaderCreateInfo *info)
{
    const struct slc_limit limits[] = {
        {"launchesInFlight", info->launchesInFlight, 1, SLC_MAX_LAUNCHES},
        {"maxTextureCount", info->maxTextureCount, 1, MAX_TEXTURES},
        {"pageCapacity", info->pageCapacity, 1, MAX_PAGES},
        {"maxRequestsPerLaunch", info->maxRequestsPerLaunch, 1, MAX_REQUESTS},
        {"maxTilesInFlight", info->maxTilesInFlight, 1, MAX_TILES_IN_FLIGHT},
        {"byteMemoryBudget", info->byteMemoryBudget ? info->byteMemoryBudget : SLC_BYTE_SLAB_SIZE,
         SLC_BYTE_SLAB_SIZE, UINT64_MAX},
        {"memoryBudget", info->memoryBudget ? info->memoryBudget : MIN_BUDGET, MIN_BUDGET,
         UINT64_MAX},
    };
    return slc_check_limits(log, limits, sizeof limits / sizeof limits[0]);
}

static SluiceResult fill_in(SluiceDemandLoaderCreateInfo *info)
{
    const uint64_t section = SLUICE_DEMAND_SECTION_PAGES;
    info->launchesInFlight = or_default(info->launchesInFlight, 2);
    info->maxTextureCount = or_default(info->maxTextureCount, 1u << 17);
    info->maxRequestsPerLaunch = or_default(info->maxRequestsPerLaunch, 8192);
    info->maxTilesInFlight = or_default(info->maxTilesInFlight, 1024);
    if (info->failureRetryDelayNs == 0)
        info->failureRetryDelayNs = UINT64_C(30000000000);
    if (info->pageCapacity == 0)
        info->pageCapacity = UINT64_C(1) << 26;
    SluiceResult result = check_limits(&info->context->vk.log, info);
    if (result != SLUICE_SUCCESS)
        return result;
    info->pageCapacity = (info->pageCapacity + section - 1) / section * section;
    return SLUICE_SUCCESS;
}

static void choose_budget(SluiceDemandLoader *loader)
{
    SluiceDemandLoaderCreateInfo *info = &loader->info;
    uint32_t chunks = loader->context->shared.max_page_chunks;
    uint64_t most =
        slc_page_chunks_capacity(chunks, loader->caps.max_image_array_layers) * SLC_TILE_SIZE;
    if (info->memoryBudget > most)
        slc_log(&loader->vk.log, SLUICE_LOG_WARNING,
                "maxPageChunkCount %u images of tiles use at most %llu MiB of the memoryBudget",
                chunks, (unsigned long long)(most >> 20));
    if (info->memoryBudget == 0)
        info->memoryBudget = slc_device_memory_size(&loader->caps) / 2;
}

static SluiceResult check_device(SluiceDemandLoader *loader)
{
    const char *missing = slc_missing_for_mode(&loader->caps, SLUICE_RESIDENCY_MODE_PAGED);
    if (missing) {
        slc_log(&loader->vk.log, SLUICE_LOG_ERROR, "%s has no %s", loader->caps.public.deviceName,
                missing);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    for (uint32_t i = 1; i < SLUICE_FORMAT_COUNT; i++) {
        SluiceVulkanFormatCapabilities format = {.structSize = sizeof format};
        slc_format_caps_init(&format, &loader->vk, (SluiceFormat)i);
        loader->usable[i] = format.sampled && format.linearFilter;
    }
    choose_budget(loader);
    return SLUICE_SUCCESS;
}

static SluiceResult create_semaphore(SluiceDemandLoader *loader)
{
    return slc_timeline_create(&loader->vk, "launches", &loader->semaphore);
}

static SluiceResult create_buffer(SluiceDemandLoader *loader, struct slc_buffer *buffer,
                                  uint64_t elements)
{
    uint64_t size = elements * SLC_MIRROR_ELEMENT;
    if (size > loader->caps.max_storage_buffer_range)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    return slc_buffer_init(buffer, &loader->vk, &loader->caps, size,
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           SLC_BUFFER_DEVICE);
}

/* Creates the tables. Elements without a texture are read only through invalid ids. */
static SluiceResult create_tables(SluiceDemandLoader *loader)
{
    uint32_t textures = loader->info.maxTextureCount;
    loader->max_image_count = textures + textures / 8 + 64; /* includes images being closed */
    uint32_t grids = textures / 4 + 1024, images = 1 + loader->max_image_count;
    SluiceResult result = create_buffer(loader, &loader->table_buffer, (uint64_t)textures + 1);
    if (result == SLUICE_SUCCESS)
        result = create_buffer(loader, &loader->levels_buffer, (uint64_t)images + grids);
    if (result == SLUICE_SUCCESS)
        result = slc_region_arena_init(&loader->grid_arena, &loader->cb, grids,
                                       slc_min_u32(grids, MAX_GRIDS));
    slc_buffer_set_name(&loader->table_buffer, &loader->vk, "demand textures");
    slc_buffer_set_name(&loader->levels_buffer, &loader->vk, "demand levels");
    if (result != SLUICE_SUCCESS)
        return result;
    slc_table_mirror_init(&loader->table, &loader->cb, loader->table_buffer.buffer, 0,
                          textures + 1);
    slc_table_mirror_init(&loader->levels, &loader->cb, loader->levels_buffer.buffer, 0, images);
    slc_table_mirror_init(&loader->grids, &loader->cb, loader->levels_buffer.buffer,
                          (uint64_t)images * SLC_MIRROR_ELEMENT, grids);
    result = slc_table_mirror_reserve(&loader->table, 1);
    if (result == SLUICE_SUCCESS)
        result = slc_table_mirror_reserve(&loader->levels, 1);
    if (result != SLUICE_SUCCESS)
        return result;
    struct SluiceDemandTexture *none = slc_table_mirror_change(&loader->table, 0);
    none->state = SLUICE_DEMAND_TEXTURE_FAILED; /* for shaders that name no texture */
    slc_table_mirror_change(&loader->levels, 0);
    return SLUICE_SUCCESS;
}

/* Returns the blocks of the page table. At worst every resident tile has a block of its own. Pages
 * of resources and refused pages are close together. */
static uint32_t block_capacity(const SluiceDemandLoader *loader)
{
    uint64_t blocks = loader->info.pageCapacity / SLUICE_DEMAND_BLOCK_PAGES;
    uint64_t wanted = loader->tiles.limit + 32768;
    wanted = wanted < blocks ? wanted : blocks;
    return (uint32_t)(wanted < SLC_PAGE_BLOCKS_MAX ? wanted : SLC_PAGE_BLOCKS_MAX);
}

static SluiceResult create_page_table(SluiceDemandLoader *loader)
{
    const SluiceDemandLoaderCreateInfo *info = &loader->info;
    const struct slc_demand_scan_create_info scan = {.page_capacity = info->pageCapacity,
                                                     .slot_count = info->launchesInFlight,
                                                     .list_capacity = info->maxRequestsPerLaunch};
    const struct slc_page_directory_create_info directory = {.page_capacity = info->pageCapacity,
                                                             .block_capacity =
                                                                 block_capacity(loader),
                                                             .slot_count = info->launchesInFlight};
    SluiceResult result = slc_demand_scan_init(&loader->scan, &loader->vk, &loader->caps, &scan);
    if (result == SLUICE_SUCCESS)
        result = slc_page_directory_init(&loader->directory, &loader->vk, &loader->caps,
                                         &loader->cb, &directory);
    return result;
}

/* Creates page ids. The first ids open textures: page i opens the texture at index i. */
static SluiceResult create_pages(SluiceDemandLoader *loader)
{
    uint32_t first, count = loader->info.maxTextureCount + 1;
    SluiceResult result =
        slc_page_space_create(&loader->cb, loader->info.pageCapacity, &loader->space);
    if (result == SLUICE_SUCCESS)
        result = slc_page_space_allocate(loader->space, 0, count, &first);
    if (result != SLUICE_SUCCESS)
        return result;
    loader->texture_page_count =
        slc_div_up_u32(count, SLUICE_DEMAND_BLOCK_PAGES) * SLUICE_DEMAND_BLOCK_PAGES;
    const struct slc_page_residency_create_info info = {.cb = &loader->cb,
                                                        .class_count = SLC_DEMAND_CLASSES,
                                                        .no_eviction = loader->info.noEviction,
                                                        .no_lod_bias = loader->info.noLodBias};
    result = slc_residency_create(&info, &loader->residency);
    if (result != SLUICE_SUCCESS)
        return result;
    loader->tile_interface = slc_tile_memory_interface(&loader->tiles);
    (void)slc_tile_memory_limit(&loader->tiles);
    slc_tiles_limit(loader);
    result = slc_residency_set_class(loader->residency, SLC_CLASS_UNBOUND, UINT64_MAX, NULL);
    if (result == SLUICE_SUCCESS)
        result = slc_residency_set_class(loader->residency, SLC_CLASS_BYTES, UINT64_MAX,
                                         &loader->byte_interface);
    return result;
}

static SluiceResult create_memory(SluiceDemandLoader *loader)
{
    SluiceResult result = slc_use_pages(&loader->context->shared, &loader->pages);
    if (result == SLUICE_SUCCESS)
        result = slc_page_pool_add_user(loader->pages, loader->semaphore, loader->info.memoryBudget,
                                        &loader->memory, &loader->page_user);
    if (result != SLUICE_SUCCESS)
        return result;
    return slc_tile_memory_init(&loader->tiles, loader->pages, loader->page_user,
                                loader->info.memoryBudget, &loader->cb);
}

static void fill_buffers(const SluiceDemandLoader *loader, SluiceDemandBuffers *buffers)
{
    *buffers = (SluiceDemandBuffers){.structSize = sizeof(SluiceDemandBuffers),
                                     .textures = loader->table_buffer.buffer,
                                     .levels = loader->levels_buffer.buffer,
                                     .directory = loader->directory.directory.buffer,
                                     .blocks = loader->directory.blocks.buffer,
                                     .masks = loader->directory.masks.buffer,
                                     .requests = loader->scan.requests.buffer,
                                     .sections = loader->scan.sections.buffer};
}

static SluiceResult create_descriptors(SluiceDemandLoader *loader)
{
    struct slc_descriptors_create_info info = {.buffer_count = SLUICE_DEMAND_BINDING_BUFFER_COUNT,
                                               .page_count = loader->pages->views.count,
                                               .array_count = slc_byte_pages_binding_count(loader),
                                               .set_count = loader->info.launchesInFlight};
    SluiceDemandBuffers buffers = {.structSize = sizeof buffers};
    fill_buffers(loader, &buffers);
    info.buffers[SLUICE_DEMAND_BINDING_TEXTURES] = buffers.textures;
    info.buffers[SLUICE_DEMAND_BINDING_LEVELS] = buffers.levels;
    info.buffers[SLUICE_DEMAND_BINDING_DIRECTORY] = buffers.directory;
    info.buffers[SLUICE_DEMAND_BINDING_BLOCKS] = buffers.blocks;
    info.buffers[SLUICE_DEMAND_BINDING_MASKS] = buffers.masks;
    info.buffers[SLUICE_DEMAND_BINDING_REQUESTS] = buffers.requests;
    info.buffers[SLUICE_DEMAND_BINDING_SECTIONS] = buffers.sections;
    return slc_descriptors_init(&loader->descriptors, &loader->vk, &loader->caps, &info);
}

static SluiceResult create_parts(SluiceDemandLoader *loader)
{
    static SluiceResult (*const steps[])(SluiceDemandLoader *) = {
        check_device,        create_semaphore,   create_memory, create_tables, create_page_table,
        slc_byte_pages_init, create_descriptors, create_pages,  slc_jobs_init};
    SluiceResult result = SLUICE_SUCCESS;
    for (size_t i = 0; i < sizeof steps / sizeof steps[0] && result == SLUICE_SUCCESS; i++)
        result = steps[i](loader);
    return result;
}

static SluiceDemandLoader *allocate(const SluiceDemandLoaderCreateInfo *info)
{
    SluiceVulkanContext *context = info->context;
    SluiceDemandLoader *loader = slc_calloc(&context->cb, 1, sizeof *loader);
    if (!loader)
        return NULL;
    loader->tile_limit = UINT64_MAX; /* no limit is set yet, and the first one may be 0 */
    loader->context = context;
    loader->cb = context->cb;
    loader->vk = context->vk;
    slc_memory_client_init(&loader->memory, &context->budget);
    loader->vk.memory_client = &loader->memory;
    loader->caps = context->caps;
    loader->info = *info;
    loader->page_user = SLC_MAX_PAGE_USERS;
    loader->texture_high = 1; /* index 0 is not used */
    loader->free_texture = loader->first_retired_texture = SLC_NONE;
    loader->free_image = loader->first_retired_image = loader->first_refresh = SLC_NONE;
    loader->orders[0] = loader->orders[1] = (struct slc_image_order){SLC_NONE, SLC_NONE};
    loader->free_resource = SLC_NONE;
    slc_image_opener_init(&loader->opener);
    if (slc_tickets_init(&loader->tickets, &loader->cb) != SLUICE_SUCCESS) {
        slc_memory_client_finish(&loader->memory);
        slc_free(&context->cb, loader, 1, sizeof *loader);
        return NULL;
    }
    slc_context_add_child(context);
    return loader;
}

SluiceResult sluiceCreateDemandLoader(const SluiceDemandLoaderCreateInfo *pCreateInfo,
                                      SluiceDemandLoader **pLoader)
{
    if (!pLoader)
        return SLUICE_ERROR_NULL_POINTER;
    *pLoader = NULL;
    if (!pCreateInfo || !pCreateInfo->context)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceDemandLoaderCreateInfo), &info,
                                          pCreateInfo, &pCreateInfo->context->vk.log);
    if (result == SLUICE_SUCCESS)
        result = fill_in(&info);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceDemandLoader *loader = allocate(&info);
    if (!loader)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    loader->misses =
        slc_alloc(&loader->cb, loader->info.maxRequestsPerLaunch, sizeof *loader->misses);
    result = loader->misses ? create_parts(loader) : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyDemandLoader(loader);
        return result;
    }
    loader->settings =
        (SluiceDemandLoaderSettings){.structSize = sizeof loader->settings,
                                     .maxRequestsPerLaunch = info.maxRequestsPerLaunch,
                                     .failureRetryDelayNs = info.failureRetryDelayNs,
                                     .noEviction = info.noEviction,
                                     .noLodBias = info.noLodBias,
                                     .forgetAfterLaunches = info.forgetAfterLaunches};
    *pLoader = loader;
    return SLUICE_SUCCESS;
}

/* Stops the workers first: they write into staging memory, and hold jobs. */
static void stop_workers(SluiceDemandLoader *loader)
{
    if (!loader->reader)
        return;
    sluiceAbortDemandLoader(loader);
    sluiceWaitTileLoaderIdle(loader->reader);
    slc_jobs_collect(loader);
}

static void destroy_device_parts(SluiceDemandLoader *loader)
{
    slc_descriptors_finish(&loader->descriptors, &loader->vk);
    slc_byte_memory_finish(&loader->bytes);
    slc_tile_memory_finish(&loader->tiles);
    slc_page_directory_finish(&loader->directory);
    slc_demand_scan_finish(&loader->scan, &loader->vk);
    if (loader->page_user < SLC_MAX_PAGE_USERS)
        slc_page_pool_remove_user(loader->pages, loader->page_user);
    slc_drop_pages(&loader->context->shared, loader->pages);
    slc_buffer_finish(&loader->table_buffer, &loader->vk);
    slc_buffer_finish(&loader->levels_buffer, &loader->vk);
    loader->vk.DestroySemaphore(loader->vk.device, loader->semaphore, NULL);
}

void sluiceDestroyDemandLoader(SluiceDemandLoader *loader)
{
    if (!loader)
        return;
    stop_workers(loader);
    if (loader->ended > loader->processed)
        slc_timeline_wait(&loader->vk, loader->semaphore, loader->ended, "launch");
    slc_resources_finish(loader);
    slc_images_finish(loader);
    slc_demand_textures_finish(loader);
    slc_preloads_finish(loader);
    slc_retries_finish(loader);
    slc_destroy_shared_loader(&loader->context->shared, loader->reader);
    slc_jobs_finish(loader);
    slc_residency_destroy(loader->residency);
    slc_page_space_destroy(loader->space);
    destroy_device_parts(loader);
    slc_memory_client_finish(&loader->memory);
    slc_table_mirror_finish(&loader->table);
    slc_table_mirror_finish(&loader->levels);
    slc_table_mirror_finish(&loader->grids);
    slc_region_arena_finish(&loader->grid_arena, &loader->cb);
    slc_tickets_finish(&loader->tickets);
    slc_free(&loader->cb, loader->owners, loader->owner_capacity, sizeof *loader->owners);
    slc_free(&loader->cb, loader->forgotten, loader->forgotten_capacity, sizeof *loader->forgotten);
    slc_free(&loader->cb, loader->misses, loader->info.maxRequestsPerLaunch,
             sizeof *loader->misses);
    SluiceVulkanContext *context = loader->context;
    slc_free(&context->cb, loader, 1, sizeof *loader);
    slc_context_remove_child(context);
}

SluiceResult sluiceGetDemandBuffers(const SluiceDemandLoader *loader, SluiceDemandBuffers *pBuffers)
{
    if (!loader || !pBuffers)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked =
        slc_struct_check(SLC_STRUCT(SluiceDemandBuffers), pBuffers, &loader->vk.log);
    if (checked != SLUICE_SUCCESS)
        return checked;
    SluiceDemandBuffers buffers = {.structSize = sizeof buffers};
    fill_buffers(loader, &buffers);
    slc_struct_write(SLC_STRUCT(SluiceDemandBuffers), pBuffers, &buffers);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetDemandDescriptorSetLayout(const SluiceDemandLoader *loader,
                                                VkDescriptorSetLayout *pLayout)
{
    if (!loader || !pLayout)
        return SLUICE_ERROR_NULL_POINTER;
    return slc_descriptors_get_layout(&loader->descriptors, &loader->vk, &loader->caps, pLayout);
}

SluiceResult sluiceGetDemandPages(const SluiceDemandLoader *loader, SluiceVulkanPages *pPages)
{
    if (!loader || !pPages)
        return SLUICE_ERROR_NULL_POINTER;
    return slc_page_pool_write_views(loader->pages, loader->page_user, pPages);
}

SluiceResult sluiceGetDemandStatistics(SluiceDemandLoader *loader,
                                       SluiceDemandStatistics *pStatistics)
{
    if (!loader || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked =
        slc_struct_check(SLC_STRUCT(SluiceDemandStatistics), pStatistics, &loader->vk.log);
    if (checked != SLUICE_SUCCESS)
        return checked;
    struct slc_residency_counts tiles;
    slc_residency_get_counts(loader->residency, SLC_CLASS_TILES, &tiles);
    SluiceDemandStatistics statistics = loader->counts;
    statistics.evictedCount = tiles.evicted + loader->counts.evictedCount;
    statistics.virtualPageCount = slc_page_space_used(loader->space);
    statistics.residentTileCount = tiles.resident;
    statistics.tailPageCount = loader->tiles.tails.page_count;
    statistics.residentResourcePageCount = loader->held_count;
    slc_byte_pages_count(loader, &statistics);
    struct slc_page_pool_counts pool = slc_page_pool_get_counts(loader->pages);
    slc_memory_client_get(&loader->memory, &statistics.deviceMemorySize,
                          &statistics.hostVisibleMemorySize);
    statistics.tileMemorySize = pool.tile_memory_size;
    statistics.deviceMemorySize += pool.device_memory_size;
    statistics.pageChunkCount = pool.chunk_count;
    statistics.pageChunkShortages = pool.shortages;
    statistics.lodBias = slc_residency_lod_bias(loader->residency);
    slc_mutex_lock(&loader->tickets.mutex);
    memcpy(statistics.latencyHistogram, loader->tickets.latency,
           sizeof statistics.latencyHistogram);
    slc_mutex_unlock(&loader->tickets.mutex);
    slc_struct_write(SLC_STRUCT(SluiceDemandStatistics), pStatistics, &statistics);
    return SLUICE_SUCCESS;
}
