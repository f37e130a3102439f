#include "demand_vulkan/demand_strict.h"

#include "base/log.h"
#include "base/struct_size.h"
#include "image/pooled_reads.h"
#include "platform/time_now.h"
#include "vulkan/page_pool.h"

#include <stdarg.h>
#include <stdio.h>

#define DEFAULT_LAUNCHES 600
#define DEFAULT_UNSIGNALED UINT64_C(5000000000)
#define PROBES 8u /* launches per period that report their uses although they request nothing */

typedef unsigned long long number;

#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
static void
report(const SluiceDemandLoader *loader, SluiceDemandMisuseKind kind, uint64_t value,
       const char *format, ...)
{
    char text[400];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    const SluiceDemandMisuse misuse = {kind, value, text};
    loader->strict.mode.pfnReport(loader->strict.mode.pUserData, &misuse);
}

static bool is_on(const SluiceDemandLoader *loader)
{
    return loader->strict.mode.pfnReport;
}

void slc_demand_strict_not_ended(SluiceDemandLoader *loader)
{
    if (is_on(loader))
        report(loader, SLUICE_DEMAND_MISUSE_LAUNCH_NOT_ENDED, loader->launch,
               "launch %llu was begun and not ended: call sluiceEndDemandLaunch after its "
               "dispatches, or sluiceAbandonDemandLaunch, before the next sluiceBeginDemandLaunch",
               (number)loader->launch);
}

void slc_demand_strict_not_begun(SluiceDemandLoader *loader)
{
    if (is_on(loader))
        report(loader, SLUICE_DEMAND_MISUSE_LAUNCH_NOT_BEGUN, loader->launch,
               "sluiceEndDemandLaunch ends no launch: launch %llu was the last one, and was ended "
               "or abandoned. Call sluiceBeginDemandLaunch first, and end the launch only if it "
               "returned SLUICE_SUCCESS",
               (number)loader->launch);
}

/* Notes a wait. The time of a launch begins with the first call that waits for it. */
static void note_wait(SluiceDemandLoader *loader, uint64_t launch, uint64_t now)
{
    struct slc_demand_strict *strict = &loader->strict;
    if (strict->awaited == launch)
        return;
    strict->awaited = launch;
    strict->awaited_since = now;
    strict->awaited_told = false;
}

uint64_t slc_demand_strict_patience(SluiceDemandLoader *loader, uint64_t launch, uint64_t timeout)
{
    const struct slc_demand_strict *strict = &loader->strict;
    if (!is_on(loader) || timeout == 0)
        return timeout;
    uint64_t now = slc_monotonic_time();
    note_wait(loader, launch, now);
    if (strict->awaited_told)
        return timeout;
    uint64_t waited = now - strict->awaited_since, most = strict->mode.unsignaledNs;
    uint64_t rest = waited < most ? most - waited : 0;
    return rest < timeout ? rest : timeout;
}

void slc_demand_strict_not_ready(SluiceDemandLoader *loader, uint64_t launch)
{
    struct slc_demand_strict *strict = &loader->strict;
    uint64_t now, value = 0;
    if (!is_on(loader))
        return;
    now = slc_monotonic_time();
    note_wait(loader, launch, now);
    if (strict->awaited_told || now - strict->awaited_since < strict->mode.unsignaledNs)
        return;
    if (loader->vk.GetSemaphoreCounterValue(loader->vk.device, loader->semaphore, &value) !=
        VK_SUCCESS)
        return;
    strict->awaited_told = true;
    if (value >= strict->awaited)
        report(loader, SLUICE_DEMAND_MISUSE_LAUNCH_NOT_PROCESSED, strict->awaited,
               "launch %llu is complete and is not processed: call sluiceProcessDemandRequests "
               "for each launch. At most launchesInFlight, %u, may be unprocessed",
               (number)strict->awaited, loader->info.launchesInFlight);
    else
        report(loader, SLUICE_DEMAND_MISUSE_LAUNCH_NOT_SIGNALED, value + 1,
               "launch %llu is not complete after %llu ms, and the semaphore has the value %llu: "
               "submit its commands with signalValue %llu, or call sluiceAbandonDemandLaunch. "
               "Raise unsignaledNs if launches take as long",
               (number)(value + 1), (number)((now - strict->awaited_since) / 1000000),
               (number)value, (number)(value + 1));
}

bool slc_demand_strict_probes(const SluiceDemandLoader *loader, uint64_t launch)
{
    const SluiceDemandStrictMode *mode = &loader->strict.mode;
    return is_on(loader) && launch % (mode->launchesWithoutRequests / PROBES + 1) == 0;
}

static uint32_t count_resources(const SluiceDemandLoader *loader)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < loader->resource_high; i++)
        count += loader->resources[i]->state == SLC_RESOURCE_LIVE;
    return count;
}

static void check_requests(SluiceDemandLoader *loader, bool marked)
{
    struct slc_demand_strict *strict = &loader->strict;
    uint64_t launches = loader->processed - strict->marked;
    if (marked)
        strict->marked = loader->processed;
    if (marked || launches < strict->mode.launchesWithoutRequests)
        return;
    uint32_t resources = count_resources(loader);
    strict->marked = loader->processed;
    if (loader->texture_count + resources)
        report(loader, SLUICE_DEMAND_MISUSE_NO_REQUESTS, launches,
               "no shader has requested or used any page of %u textures and %u resources in the "
               "last %llu launches: bind the launch's descriptor set, sample with the functions of "
               "demand.glsl, and end launches after the dispatches",
               loader->texture_count, resources, (number)launches);
}

static bool may_repeat(const SluiceDemandLoader *loader, uint64_t *told)
{
    if (*told && loader->processed - *told < loader->strict.mode.repeatLaunches)
        return false;
    *told = loader->processed;
    return true;
}

static void check_tiles(SluiceDemandLoader *loader)
{
    uint64_t refused = slc_residency_overflow_count(loader->residency);
    float bias = slc_residency_lod_bias(loader->residency);
    if ((refused == 0 && bias == 0) || !may_repeat(loader, &loader->strict.tiles_told))
        return;
    report(loader, SLUICE_DEMAND_MISUSE_TILES_EXHAUSTED, loader->tile_limit,
           "tiles exceed memory, which has room for %llu: textures are %.2f levels coarser, and "
           "%llu tiles are refused. Raise memoryBudget, or request less",
           (number)loader->tile_limit, (double)bias, (number)refused);
}

static void check_memory(SluiceDemandLoader *loader, uint64_t turned_away)
{
    struct slc_demand_strict *strict = &loader->strict;
    struct slc_page_pool_counts pool = slc_page_pool_get_counts(loader->pages);
    check_tiles(loader);
    if (turned_away && may_repeat(loader, &strict->pages_told))
        report(loader, SLUICE_DEMAND_MISUSE_PAGES_EXHAUSTED, turned_away,
               "%llu pages of resources wait: all others are pinned or in use. Raise "
               "maxResidentPageCount of the resource or byteMemoryBudget, or request less",
               (number)turned_away);
    if (pool.shortages > strict->shortages && may_repeat(loader, &strict->chunks_told))
        report(loader, SLUICE_DEMAND_MISUSE_CHUNKS_EXHAUSTED, pool.chunk_count,
               "tiles found no page: all %u images of pages are in use. Raise maxPageChunkCount of "
               "the context, or use fewer formats",
               pool.chunk_count);
    strict->shortages = pool.shortages;
}

void slc_demand_strict_processed(SluiceDemandLoader *loader, bool marked, uint64_t turned_away)
{
    if (!is_on(loader))
        return;
    check_requests(loader, marked);
    check_memory(loader, turned_away);
}

void slc_demand_strict_no_texture(SluiceDemandLoader *loader)
{
    if (is_on(loader))
        report(loader, SLUICE_DEMAND_MISUSE_TEXTURES_EXHAUSTED, loader->info.maxTextureCount,
               "a texture, variant or grid is added beyond maxTextureCount, %u, of which removed "
               "ones count until their launches are processed. Raise it, or remove textures",
               loader->info.maxTextureCount);
}

void slc_demand_strict_no_ids(SluiceDemandLoader *loader, const char *name)
{
    if (is_on(loader) && may_repeat(loader, &loader->strict.ids_told))
        report(loader, SLUICE_DEMAND_MISUSE_IDS_EXHAUSTED, loader->info.pageCapacity,
               "%s: the texture finds no virtual pages, of which there are %llu. Raise "
               "pageCapacity, or remove textures",
               name, (number)loader->info.pageCapacity);
}

SluiceResult sluiceSetDemandStrictMode(SluiceDemandLoader *loader,
                                       const SluiceDemandStrictMode *pMode)
{
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDemandStrictMode mode = {.structSize = sizeof mode};
    if (pMode) {
        SluiceResult result =
            slc_struct_read(SLC_STRUCT(SluiceDemandStrictMode), &mode, pMode, &loader->vk.log);
        if (result != SLUICE_SUCCESS)
            return result;
        if (!mode.pfnReport)
            return slc_log_refusal(&loader->vk.log, "SluiceDemandStrictMode lacks pfnReport");
    }
    if (!mode.launchesWithoutRequests)
        mode.launchesWithoutRequests = DEFAULT_LAUNCHES;
    if (!mode.unsignaledNs)
        mode.unsignaledNs = DEFAULT_UNSIGNALED;
    if (!mode.repeatLaunches)
        mode.repeatLaunches = DEFAULT_LAUNCHES;
    loader->strict =
        (struct slc_demand_strict){.mode = mode,
                                   .marked = loader->processed,
                                   .shortages = slc_page_pool_get_counts(loader->pages).shortages};
    return SLUICE_SUCCESS;
}

/* A worker writes the source of an image that is being opened. */
static bool is_used(const SluiceDemandLoader *loader, const SluiceImageSource *source)
{
    for (uint32_t i = 1; i < loader->texture_high; i++)
        if (loader->textures[i].kind == SLC_TEXTURE_IMAGE &&
            loader->textures[i].source.source == source)
            return true;
    for (uint32_t i = 0; i < loader->image_high; i++) {
        const struct slc_demand_image *image = loader->images[i];
        bool open = image->state == SLC_IMAGE_OPEN || image->state == SLC_IMAGE_DETACHED;
        if (open && !image->origin.source && image->source == source)
            return true;
    }
    return false;
}

SluiceResult sluiceIsDemandSourceInUse(const SluiceDemandLoader *loader,
                                       const SluiceImageSource *source, bool *pInUse)
{
    if (!loader || !source || !pInUse)
        return SLUICE_ERROR_NULL_POINTER;
    *pInUse = is_used(loader, source);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceReleaseDemandSource(SluiceDemandLoader *loader, SluiceImageSource *source)
{
    bool in_use = false;
    SluiceResult result = sluiceIsDemandSourceInUse(loader, source, &in_use);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!in_use) {
        slc_loader_drop_texels(loader->reader, source);
        sluiceDestroyImageSource(source);
        return SLUICE_SUCCESS;
    }
    SluiceImageInfo info = {.structSize = sizeof info};
    bool named = sluiceGetImageInfo(source, &info) == SLUICE_SUCCESS && info.pName;
    if (is_on(loader))
        report(loader, SLUICE_DEMAND_MISUSE_SOURCE_IN_USE, (uint64_t)(uintptr_t)source,
               "%s: the source is destroyed while a texture has it. Remove the texture or replace "
               "its image first, and call again",
               named ? info.pName : "image");
    return SLUICE_NOT_READY;
}
