#include "bake/baker.h"

#include "bake/texels.h"
#include "bake/vips_warnings.h"
#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "platform/thread.h"

#include <vips/vips.h>

#define DEFAULT_MEMORY ((uint64_t)1 << 30)
#define MAX_THREADS 256u

static uint32_t count_threads(uint32_t wanted)
{
    if (wanted == 0)
        wanted = slc_get_processor_count();
    return wanted < MAX_THREADS ? wanted : MAX_THREADS;
}

static SluiceResult start_vips(const SluiceLogCallback *log)
{
    if (VIPS_INIT("sluice-bake") != 0) {
        slc_log(log, SLUICE_LOG_ERROR, "libvips does not start: %s", vips_error_buffer());
        vips_error_clear();
        return SLUICE_ERROR_UNSUPPORTED;
    }
    vips_cache_set_max(0); /* pictures are read once, and the cache would keep them open */
    return SLUICE_SUCCESS;
}

SluiceResult sluiceCreateBaker(const SluiceBakerCreateInfo *pInfo, SluiceBaker **pBaker)
{
    if (!pInfo || !pBaker || !slc_allocator_is_valid(pInfo->pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceBakerCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceBakerCreateInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    result = start_vips(&info.log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceBaker *baker = slc_calloc(&cb, 1, sizeof *baker);
    float *decoded16 = slc_alloc(&cb, 65536, sizeof *decoded16);
    result = baker && decoded16 ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS)
        result = slc_bake_jobs_init(&baker->jobs, &cb, count_threads(info.threadCount) - 1);
    if (result != SLUICE_SUCCESS) {
        slc_free(&cb, decoded16, 65536, sizeof *decoded16);
        slc_free(&cb, baker, 1, sizeof *baker);
        return result;
    }
    slc_vips_warnings_listen();
    slc_decode_srgb16(decoded16);
    slc_astc_pool_init(&baker->astc, &cb);
    baker->allocator = cb;
    baker->log = info.log;
    baker->max_memory = info.maxMemory ? info.maxMemory : DEFAULT_MEMORY;
    baker->decoded16 = decoded16;
    *pBaker = baker;
    return SLUICE_SUCCESS;
}

void sluiceDestroyBaker(SluiceBaker *baker)
{
    if (!baker)
        return;
    SluiceAllocationCallbacks cb = baker->allocator;
    slc_bake_jobs_finish(&baker->jobs);
    slc_vips_warnings_end();
    slc_astc_pool_finish(&baker->astc);
    slc_free(&cb, baker->decoded16, 65536, sizeof *baker->decoded16);
    slc_free(&cb, baker, 1, sizeof *baker);
}

struct reservation {
    const SluiceBaker *baker;
    uint64_t size;
};

static bool fits(void *user)
{
    const struct reservation *reservation = user;
    const SluiceBaker *baker = reservation->baker;
    return reservation->size <= baker->max_memory - baker->used_memory;
}

/* Takes memory if it is free. Called again after each wait, because other bakes may have taken it.
 */
static bool take(struct reservation *reservation, SluiceBaker *baker)
{
    slc_bake_jobs_lock(&baker->jobs);
    bool has_room = fits(reservation);
    if (has_room)
        baker->used_memory += reservation->size;
    slc_mutex_unlock(&baker->jobs.mutex);
    return has_room;
}

SluiceResult slc_baker_reserve(SluiceBaker *baker, uint64_t size, const SluiceBakeInfo *info)
{
    struct reservation reservation = {baker, size};
    if (size > baker->max_memory)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    while (!take(&reservation, baker)) {
        if (info->pfnProgress && !info->pfnProgress(info->pUserData, 0, 0))
            return SLUICE_ERROR_CANCELED;
        slc_bake_jobs_help_a_while(&baker->jobs, fits, &reservation);
    }
    return SLUICE_SUCCESS;
}

void slc_baker_give_back(SluiceBaker *baker, uint64_t size)
{
    slc_bake_jobs_lock(&baker->jobs);
    baker->used_memory -= size;
    slc_bake_jobs_unlock_and_wake(&baker->jobs);
}
