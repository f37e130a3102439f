#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "core/observer.h"
#include "core/managed_textures.h"
#include "core/texture_tiles.h"
#include "core/tile_events.h"
#include "residency/create.h"
#include "residency/standby.h"

#include <inttypes.h>

static void *count_allocate(void *user, size_t size, size_t alignment)
{
    slc_manager *m = user;
    void *memory = m->given.pfnAllocate(m->given.pUserData, size, alignment);
    if (memory)
        m->host_memory_size += size;
    return memory;
}

static void count_free(void *user, void *memory, size_t size)
{
    slc_manager *m = user;
    m->host_memory_size -= size;
    m->given.pfnFree(m->given.pUserData, memory, size);
}

#define MAX_HEAP_CAPACITY (1u << 20)

static SluiceResult check_create_info(const SluiceStreamedTextureManagerCreateInfo *info)
{
    if (!info->heapAllocator.pfnAllocateHeap || !info->heapAllocator.pfnReleaseHeap)
        return SLUICE_ERROR_NULL_POINTER;
    if (info->heapTileCapacity == 0 || info->tileSize == 0)
        return SLUICE_ERROR_ZERO_HEAP_CAPACITY;
    if (info->heapTileCapacity > MAX_HEAP_CAPACITY)
        return slc_log_refusal(&info->log, "heapTileCapacity %" PRIu32 " is above %u",
                               info->heapTileCapacity, MAX_HEAP_CAPACITY);
    if (!slc_allocator_is_valid(info->pAllocator))
        return slc_log_refusal(&info->log, "pAllocator lacks pfnAllocate or pfnFree");
    return SLUICE_SUCCESS;
}

static void set_limits(slc_manager *m)
{
    const SluiceStreamedTextureManagerConfig *c = &m->config;
    m->residency.limits = (struct slc_machine_limits){
        .standby = c->numExtraStandbyTiles,
        .load_attempts = c->maxLoadAttempts ? c->maxLoadAttempts : 5,
        .retry_delay = c->retryDelayTicks,
    };
}

void slc_manager_take_config(SluiceStreamedTextureManager *manager,
                             const SluiceStreamedTextureManagerConfig *config)
{
    manager->config = *config;
    set_limits(manager);
}

static void destroy(slc_manager *m)
{
    slc_textures_finish(m);
    slc_machine_finish(&m->residency);
    slc_tile_events_finish(&m->events, &m->cb);
    slc_free(&m->cb, m->scratch, m->scratch_room, 1);
    slc_free(&m->cb, m->reports.list, m->reports.room, sizeof *m->reports.list);
    slc_map_finish(&m->reports.tiles, &m->cb);
    SluiceAllocationCallbacks given = m->given;
    slc_free(&given, m, 1, sizeof *m);
}

SluiceResult
sluiceCreateStreamedTextureManager(const SluiceStreamedTextureManagerCreateInfo *pCreateInfo,
                                   SluiceStreamedTextureManager **pManager)
{
    if (pManager)
        *pManager = NULL;
    if (!pCreateInfo || !pManager)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceStreamedTextureManagerCreateInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceStreamedTextureManagerCreateInfo), &info,
                                          pCreateInfo, NULL);
    if (result == SLUICE_SUCCESS)
        result = check_create_info(&info);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    slc_manager *m = slc_calloc(&cb, 1, sizeof *m);
    if (!m)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    m->info = info;
    m->given = cb;
    m->info.pAllocator = info.pAllocator ? &m->given : NULL;
    m->cb = (SluiceAllocationCallbacks){m, count_allocate, count_free};
    m->host_memory_size = sizeof *m;
    m->dirty_first = m->dirty_last = m->visit_first = m->visit_last = SLC_NONE;
    set_limits(m);
    struct slc_machine_user user = slc_tiles_user(m);
    result = slc_machine_init(&m->residency, &m->cb, &user, &info.heapAllocator,
                              info.heapTileCapacity, info.tileSize);
    if (result != SLUICE_SUCCESS)
        goto fail;
    *pManager = m;
    return SLUICE_SUCCESS;

fail:
    destroy(m); /* even if it is locked */
    return result;
}

void sluiceDestroyStreamedTextureManager(SluiceStreamedTextureManager *manager)
{
    if (manager && !slc_is_locked(manager))
        destroy(manager);
}

SluiceResult sluiceSetConfig(SluiceStreamedTextureManager *manager,
                             const SluiceStreamedTextureManagerConfig *pConfig)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config};
    struct slc_call call = {.kind = SLC_CALL_SET_CONFIG, .config = pConfig ? &config : NULL};
    if (!pConfig) {
        call.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceStreamedTextureManagerConfig),
                                              &config, pConfig, &manager->info.log);
        if (result != SLUICE_SUCCESS)
            return result; /* a recording has no form for it */
        manager->config = config;
        manager->config_count++;
        set_limits(manager);
        slc_limit_standby(&manager->residency);
    }
    slc_notify(manager, &call);
    return call.result;
}
