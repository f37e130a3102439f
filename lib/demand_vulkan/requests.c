/* Requests of launches become reads, and decisions of the residency become page table entries. */
#include "base/log.h"
#include "demand_vulkan/loader.h"
#include "demand_vulkan/pages.h"
#include "demand_vulkan/demand_strict.h"

#include <sluice/shared/demand.h>

#define BATCH 256u

enum slc_request_answer slc_page_request_any(SluiceDemandLoader *loader, uint32_t page,
                                             SluiceDemandTicket ticket, SluiceResult *result)
{
    uint32_t index;
    switch (slc_pages_find(loader, page, &index)) {
    case SLC_OWNER_OPENING:
        loader->unasked_count++; /* not a request for a tile */
        return slc_image_request(loader, index, ticket, result);
    case SLC_OWNER_TAIL: index = SLUICE_DEMAND_BLOCK_PAGES * index + page % 32u; break;
    case SLC_OWNER_LEVEL: break;
    case SLC_OWNER_RESOURCE: return slc_resource_request(loader, index, page, ticket, result);
    case SLC_OWNER_NOBODY: *result = SLUICE_SUCCESS; return SLC_REQUEST_RESIDENT;
    }
    *result = SLUICE_SUCCESS;
    if (index >= loader->image_high)
        return SLC_REQUEST_RESIDENT;
    return slc_tile_request(loader, loader->images[index], page, ticket, result);
}

static void count(SluiceDemandRequests *requests, enum slc_request_answer answer)
{
    switch (answer) {
    case SLC_REQUEST_LOAD: requests->servedCount++; break;
    case SLC_REQUEST_PENDING:
    case SLC_REQUEST_RESIDENT: requests->pendingCount++; break;
    case SLC_REQUEST_RESTORED: requests->restoredCount++; break;
    case SLC_REQUEST_REFUSED: requests->refusedCount++; break;
    case SLC_REQUEST_POSTPONED: requests->postponedCount++; break;
    }
}

/* True if the page is of a resource. Shaders request its missing values in every launch. */
static bool is_resource(const SluiceDemandLoader *loader, uint32_t page)
{
    uint32_t index;
    return slc_pages_find(loader, page, &index) == SLC_OWNER_RESOURCE;
}

/* Passes the used pages of a launch to the residency. True if there are any. */
static bool feed_used(SluiceDemandLoader *loader, uint32_t slot)
{
    struct slc_page_used_iterator iterator = {0};
    bool any = false;
    uint32_t page;
    while (slc_page_directory_next_used(&loader->directory, slot, &iterator, &page)) {
        slc_residency_use(loader->residency, page);
        slc_image_touch_page(loader, page, loader->processed);
        any = true;
    }
    return any;
}

/* True if a launch used pages. For strict mode, which must not influence evictions. */
static bool has_used(const SluiceDemandLoader *loader, uint32_t slot)
{
    struct slc_page_used_iterator iterator = {0};
    uint32_t page;
    return loader->probed[slot] &&
           slc_page_directory_next_used(&loader->directory, slot, &iterator, &page);
}

static void add_counts(SluiceDemandStatistics *counts, const SluiceDemandRequests *requests)
{
    counts->requestCount += requests->missingCount;
    counts->servedCount += requests->servedCount;
    counts->pendingCount += requests->pendingCount;
    counts->restoredCount += requests->restoredCount;
    counts->refusedCount += requests->refusedCount;
    counts->postponedCount += requests->postponedCount;
}

void slc_requests_process(SluiceDemandLoader *loader, uint64_t launch, SluiceDemandTicket ticket,
                          SluiceDemandRequests *requests)
{
    uint32_t slot = (uint32_t)(launch % loader->info.launchesInFlight);
    const uint32_t *pages;
    struct SluiceDemandScanResult scan = slc_demand_scan_result(&loader->scan, slot, &pages);
    SluiceDemandRequests now = {.structSize = sizeof now,
                                .missingCount = scan.requestCount,
                                .postponedCount = scan.postponedCount};
    (void)slc_tile_memory_limit(&loader->tiles); /* the pool may have more pages now, or fewer */
    slc_tiles_limit(loader);
    slc_residency_begin(loader->residency, launch);
    bool marked = scan.requestCount != 0 || has_used(loader, slot);
    if (loader->tracked[slot])
        marked |= feed_used(loader, slot);
    else
        loader->known_since = launch;
    for (uint32_t i = 0; i < scan.listedCount; i++)
        slc_image_touch_page(loader, pages[i], launch);
    loader->knows_use = loader->tracked[slot];
    loader->unasked_count = 0;
    loader->miss_count = scan.listedCount;
    for (uint32_t i = 0; i < scan.listedCount; i++)
        loader->misses[i] = pages[i];
    slc_jobs_begin_batch(loader);
    for (uint32_t i = 0; i < scan.listedCount; i++) {
        SluiceResult result; /* ignored: without host memory the page is postponed */
        enum slc_request_answer answer = slc_page_request_any(loader, pages[i], ticket, &result);
        count(&now, answer);
        now.missingCount -= answer == SLC_REQUEST_REFUSED && is_resource(loader, pages[i]);
    }
    slc_jobs_end_batch(loader);
    slc_images_forget_old(loader);
    loader->knows_use = false;
    /* The residency counts requests that did not reach it as tiles; unasked pages are no tiles. */
    slc_residency_settle(loader->residency, scan.requestCount - loader->unasked_count);
    slc_evicted_take(loader);
    if (scan.postponedCount == 0)
        loader->listed_launch = launch;
    add_counts(&loader->counts, &now);
    slc_demand_strict_processed(loader, marked, slc_residency_turned_away_count(loader->residency));
    requests->missingCount += now.missingCount;
    requests->servedCount += now.servedCount;
    requests->pendingCount += now.pendingCount;
    requests->restoredCount += now.restoredCount;
    requests->refusedCount += now.refusedCount;
    requests->postponedCount += now.postponedCount;
}

/* Applies a change. If the page table has no free block, the page is forgotten. */
static void apply(SluiceDemandLoader *loader, const struct slc_page_change *change)
{
    SluiceResult result = SLUICE_SUCCESS;
    bool tile = change->class_index == SLC_CLASS_TILES;
    if (change->shown == SLC_SHOW_RESIDENT)
        result = slc_page_directory_show(
            &loader->directory, change->page,
            tile ? change->value : slc_byte_pages_value(loader, change->page, change->value),
            !tile);
    else if (change->shown == SLC_SHOW_REFUSED && tile)
        result = slc_page_directory_refuse(&loader->directory, change->page);
    else
        slc_page_directory_hide(&loader->directory, change->page);
    if (result == SLUICE_SUCCESS)
        return;
    if (!loader->page_table_was_full)
        slc_log(&loader->vk.log, SLUICE_LOG_WARNING,
                "no room in the page table for page %u and perhaps others: %s", change->page,
                sluiceGetResultName(result));
    loader->page_table_was_full = true;
    slc_residency_forget(loader->residency, change->page, 1);
}

void slc_changes_apply(SluiceDemandLoader *loader)
{
    struct slc_page_change changes[BATCH];
    uint32_t taken = BATCH;
    while (taken == BATCH) {
        taken = slc_residency_take_changes(loader->residency, changes, BATCH);
        /* hides pages first, which may free their blocks */
        for (uint32_t i = 0; i < taken; i++)
            if (changes[i].shown == SLC_SHOW_ABSENT)
                apply(loader, &changes[i]);
        for (uint32_t i = 0; i < taken; i++)
            if (changes[i].shown != SLC_SHOW_ABSENT)
                apply(loader, &changes[i]);
    }
}

void slc_evicted_take(SluiceDemandLoader *loader)
{
    struct slc_page_evicted evicted[BATCH];
    uint32_t taken = BATCH, index;
    while (taken == BATCH) {
        taken = slc_residency_take_evicted(loader->residency, evicted, BATCH);
        for (uint32_t i = 0; i < taken; i++)
            if (slc_pages_find(loader, evicted[i].page, &index) == SLC_OWNER_RESOURCE)
                slc_resource_evicted(loader, index, evicted[i].page, evicted[i].value);
    }
}
