/* Pages of bytes: a callback writes them into staging memory, shaders get their address. */
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "demand_vulkan/loader.h"
#include "demand_vulkan/pages.h"
#include "vulkan/sparse_layout.h"

#include <assert.h>

_Static_assert(SLUICE_DEMAND_BYTE_CHUNKS <= SLC_DESCRIPTOR_ARRAY, "chunks fit");

#define SPARE_BUFFERS 16u /* storage buffers per stage that are left to the application */

static void list_buffers(SluiceDemandLoader *loader)
{
    struct slc_buffer_array *list = &loader->byte_buffers;
    if (list->generation == loader->bytes.generation)
        return;
    for (uint32_t i = 0; i < SLUICE_DEMAND_BYTE_CHUNKS; i++) {
        const struct slc_byte_chunk *chunk = &loader->bytes.chunks[i];
        list->buffers[i] = chunk->state == SLC_BYTE_CHUNK_LIVE
                               ? chunk->buffer
                               : loader->directory.blocks.buffer; /* not read by shaders */
    }
    list->generation = loader->bytes.generation;
}

SluiceResult slc_byte_pages_init(SluiceDemandLoader *loader)
{
    SluiceDemandLoaderCreateInfo *info = &loader->info;
    uint64_t quarter = info->memoryBudget / 4 / SLC_BYTE_SLAB_SIZE * SLC_BYTE_SLAB_SIZE;
    if (info->bufferDeviceAddress && !loader->caps.buffer_device_address) {
        slc_log(&loader->vk.log, SLUICE_LOG_ERROR, "bufferDeviceAddress: %s has no such feature",
                loader->caps.public.deviceName);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    if (info->byteMemoryBudget == 0)
        info->byteMemoryBudget = quarter ? quarter : SLC_BYTE_SLAB_SIZE;
    if (info->byteMemoryBudget > info->memoryBudget)
        return slc_log_refusal(
            &loader->vk.log,
            "byteMemoryBudget is %llu; it can be at most memoryBudget, which is %llu",
            (unsigned long long)info->byteMemoryBudget, (unsigned long long)info->memoryBudget);
    slc_byte_memory_init(&loader->bytes, &loader->vk, &loader->caps, &loader->cb,
                         info->byteMemoryBudget, info->bufferDeviceAddress);
    loader->byte_interface = slc_byte_memory_interface(&loader->bytes);
    list_buffers(loader);
    return SLUICE_SUCCESS;
}

uint32_t slc_byte_pages_binding_count(const SluiceDemandLoader *loader)
{
    uint32_t needed =
        SLUICE_DEMAND_BINDING_BUFFER_COUNT + SLUICE_DEMAND_BYTE_CHUNKS + SPARE_BUFFERS;
    return needed <= loader->caps.max_stage_storage_buffers ? SLUICE_DEMAND_BYTE_CHUNKS : 0;
}

/* Makes staging memory for pages above 64 KiB with the first resource that has such pages. */
static SluiceResult prepare_large(SluiceDemandLoader *loader)
{
    if (loader->large.blocks)
        return SLUICE_SUCCESS;
    uint32_t slots = (loader->job_count - loader->first_large) * SLC_LARGE_SLOTS;
    SluiceResult result = slc_staging_init(&loader->large, &loader->context->shared.staging,
                                           &loader->vk, &loader->caps, &loader->cb, slots);
    if (result != SLUICE_SUCCESS)
        slc_staging_finish(&loader->large);
    return result;
}

SluiceResult slc_byte_pages_prepare(SluiceDemandLoader *loader, uint32_t page_size)
{
    if (page_size > SLC_MAX_BYTE_PAGE_SIZE)
        return slc_log_refusal(&loader->vk.log, "pageSize is %u; it can be 0 to %u", page_size,
                               SLC_MAX_BYTE_PAGE_SIZE);
    uint32_t kind;
    if (!slc_byte_memory_kind(&loader->bytes, slc_byte_stride(page_size), &kind)) {
        slc_log(&loader->vk.log, SLUICE_LOG_ERROR,
                "pageSize is %u; the loader has pages of %u other sizes already", page_size,
                SLC_BYTE_KINDS);
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    }
    return page_size > SLC_TILE_SIZE ? prepare_large(loader) : SLUICE_SUCCESS;
}

void slc_byte_pages_describe(SluiceDemandLoader *loader, struct slc_demand_resource *resource)
{
    uint32_t size = resource->info.pageSize;
    resource->stride = slc_byte_stride(size);
    resource->byte_kind = 0;
    if (size)
        slc_byte_memory_kind(&loader->bytes, resource->stride, &resource->byte_kind);
    resource->produced = resource->info.pfnRecordPages;
    resource->addresses = loader->bytes.get_address && !resource->info.byteOffsets;
    resource->job_kind = size == 0              ? SLC_JOB_RESOURCE
                         : size > SLC_TILE_SIZE ? SLC_JOB_LARGE
                                                : SLC_JOB_BYTES;
}

void slc_byte_job_back(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult result)
{
    struct slc_demand_resource *resource = loader->resources[job->owner];
    loader->reading_count--;
    if (result == SLUICE_SUCCESS)
        loader->counts.bytesRead += resource->info.pageSize;
    if (result == SLUICE_SUCCESS && !job->stale) {
        slc_resource_note_success(loader, resource, job->page);
        slc_job_list_append(loader, &loader->arrived, job);
        return;
    }
    slc_resource_fail(loader, resource, job, result,
                      result != SLUICE_SUCCESS && !job->stale && !slc_result_may_pass(result));
    slc_job_free(loader, job);
    slc_resource_release(loader, resource->index);
}

uint64_t slc_byte_pages_value(const SluiceDemandLoader *loader, uint32_t page, uint64_t value)
{
    uint32_t index;
    if (slc_pages_find(loader, page, &index) != SLC_OWNER_RESOURCE)
        return value;
    const struct slc_demand_resource *resource = loader->resources[index];
    if (!resource->stride)
        return value;
    return slc_byte_value(&loader->bytes, (uint32_t)value, resource->stride, resource->addresses);
}

/* Divides the budget. Byte pages have a share from the first resource until the last chunk is
 * freed. */
static void share_budget(SluiceDemandLoader *loader)
{
    bool shared = loader->byte_resource_count || loader->bytes.size;
    uint64_t reserve = shared ? loader->info.byteMemoryBudget : 0;
    if (reserve == loader->byte_reserve)
        return;
    uint64_t rest = loader->info.memoryBudget - reserve;
    loader->byte_reserve = reserve;
    slc_tile_memory_set_budget(&loader->tiles, rest);
    /* 0 would mean no limit */
    slc_page_pool_set_max_size(loader->pages, loader->page_user, rest ? rest : 1);
}

void slc_byte_pages_add_resource(SluiceDemandLoader *loader)
{
    loader->byte_resource_count++;
    share_budget(loader);
}

void slc_byte_pages_remove_resource(SluiceDemandLoader *loader)
{
    assert(loader->byte_resource_count > 0);
    loader->byte_resource_count--;
}

void slc_byte_pages_begin(SluiceDemandLoader *loader, uint64_t launch)
{
    slc_byte_memory_begin(&loader->bytes, launch, loader->processed,
                          loader->memory_pressure.beyond || loader->memory_pressure.refused);
    share_budget(loader);
}

void slc_byte_pages_bind(SluiceDemandLoader *loader, uint32_t slot)
{
    list_buffers(loader);
    slc_descriptors_update_array(&loader->descriptors, &loader->vk, slot, &loader->byte_buffers);
}

void slc_byte_pages_count(const SluiceDemandLoader *loader, SluiceDemandStatistics *statistics)
{
    for (uint32_t i = SLC_CLASS_BYTES; i < SLC_DEMAND_CLASSES; i++) {
        struct slc_residency_counts counts;
        if (i != SLC_CLASS_BYTES && !(loader->classes[i] && loader->byte_classes[i]))
            continue;
        slc_residency_get_counts(loader->residency, i, &counts);
        statistics->residentBytePageCount += counts.resident;
    }
    statistics->evictedCount += loader->bytes.evicted_count;
    statistics->byteMemorySize = loader->bytes.size;
    statistics->byteChunkCount = loader->bytes.chunk_count;
}

SluiceResult sluiceGetDemandByteBuffers(const SluiceDemandLoader *loader,
                                        SluiceDemandByteBuffers *pBuffers)
{
    if (!loader || !pBuffers)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked =
        slc_struct_check(SLC_STRUCT(SluiceDemandByteBuffers), pBuffers, &loader->vk.log);
    if (checked != SLUICE_SUCCESS)
        return checked;
    const SluiceDemandByteBuffers buffers = {.structSize = sizeof buffers,
                                             .bufferCount = SLUICE_DEMAND_BYTE_CHUNKS,
                                             .pBuffers = loader->byte_buffers.buffers,
                                             .generation = loader->byte_buffers.generation};
    slc_struct_write(SLC_STRUCT(SluiceDemandByteBuffers), pBuffers, &buffers);
    return SLUICE_SUCCESS;
}
