/*
 * Launches. Before a launch, arrived pages are copied and shown. After it, its requests are
 * scanned. When it is complete, requests become reads.
 */
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "demand_vulkan/loader.h"
#include "demand_vulkan/pages.h"
#include "demand_vulkan/productions.h"
#include "demand_vulkan/refused_arguments.h"
#include "demand_vulkan/demand_strict.h"
#include "image/half.h"
#include "vulkan/compute.h"
#include "vulkan/page_leaving.h"

#include <sluice/shared/demand.h>

#include <assert.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define SHADER_ACCESS (VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT)

static uint32_t slot_of(const SluiceDemandLoader *loader, uint64_t launch)
{
    return (uint32_t)(launch % loader->info.launchesInFlight);
}

static bool is_aborted(SluiceDemandLoader *loader)
{
    return slc_ticket_is_canceled(&loader->tickets, 0);
}

static void complete_forgotten(SluiceDemandLoader *loader)
{
    uint32_t over = 0, count = loader->forgotten_count;
    while (over < count && loader->forgotten[over].launch &&
           loader->forgotten[over].launch <= loader->processed)
        over++;
    if (over == 0)
        return;
    memmove(loader->forgotten, loader->forgotten + over,
            (count - over) * sizeof *loader->forgotten);
    loader->forgotten_count -= over;
}

/* Frees everything that only launches up to `processed` named. */
static void end_retired(SluiceDemandLoader *loader)
{
    slc_page_space_complete(loader->space, loader->processed);
    slc_uploads_end_retired(loader);
    slc_images_end_retired(loader);
    slc_textures_end_retired(loader);
    slc_resources_end_retired(loader);
    complete_forgotten(loader);
    slc_table_mirror_complete(&loader->table, loader->processed);
    slc_table_mirror_complete(&loader->levels, loader->processed);
    slc_table_mirror_complete(&loader->grids, loader->processed);
}

/*
 * Whether shaders must report the pages that they use: as soon as memory could be full before a
 * launch that reports them is complete.
 */
static bool wants_used(SluiceDemandLoader *loader)
{
    struct slc_residency_counts counts;
    uint64_t limit = slc_tile_memory_limit(&loader->tiles);
    uint64_t soon = (uint64_t)loader->info.maxTilesInFlight * (loader->info.launchesInFlight + 1);
    if (loader->info.noEviction)
        return false;
    if (loader->info.forgetAfterLaunches)
        return true;
    slc_residency_get_counts(loader->residency, SLC_CLASS_TILES, &counts);
    uint64_t held = counts.resident + counts.loading;
    if (loader->memory_pressure.beyond + loader->memory_pressure.refused)
        return true;
    return loader->limited_count || slc_byte_memory_is_filling(&loader->bytes) ||
           held + soon > limit || held > limit / 4 * 3;
}

static void set_parameter(SluiceDemandLoader *loader, uint32_t index, uint32_t value)
{
    const struct slc_mirror_element *now = slc_table_mirror_get(&loader->levels, 0);
    if (now->words[index] == value)
        return;
    ((struct slc_mirror_element *)slc_table_mirror_change(&loader->levels, 0))->words[index] =
        value;
}

/* Collects finished jobs, and updates pages and textures. */
static void gather(SluiceDemandLoader *loader, uint64_t launch, bool tracking)
{
    slc_jobs_collect(loader);
    slc_productions_collect(loader);
    slc_retries_advance(loader);
    slc_images_refresh(loader);
    slc_preloads_continue(loader);
    slc_uploads_admit(loader);
    float bias = slc_residency_prepare(loader->residency, launch);
    slc_changes_apply(loader);
    slc_evicted_take(loader);
    set_parameter(loader, SLUICE_DEMAND_PARAMETER_LOD_BIAS, slc_float_bits(bias));
    set_parameter(loader, SLUICE_DEMAND_PARAMETER_TRACKING, tracking);
}

static int compare_runs(const void *a, const void *b)
{
    const struct slc_page_run *x = a, *y = b;
    return (x->first > y->first) - (x->first < y->first);
}

/* Counts the runs whose requests are not cleared yet. They are last in the list. */
static uint32_t count_forgotten(const SluiceDemandLoader *loader)
{
    uint32_t count = 0;
    while (count < loader->forgotten_count &&
           loader->forgotten[loader->forgotten_count - 1 - count].launch == 0)
        count++;
    return count;
}

/* Records the clearing of requests: whole words, each once. */
static void record_forgotten(SluiceDemandLoader *loader, VkCommandBuffer commands)
{
    const uint64_t unit = SLUICE_DEMAND_BLOCK_PAGES;
    uint32_t count = count_forgotten(loader);
    if (count == 0)
        return;
    struct slc_page_run *runs = loader->forgotten + loader->forgotten_count - count;
    qsort(runs, count, sizeof *runs, compare_runs);
    for (uint32_t i = 0; i < count;) {
        uint64_t first = runs[i].first / unit * unit, end = first;
        for (; i < count && runs[i].first / unit * unit <= end; i++) {
            uint64_t stop = (runs[i].first + runs[i].count + unit - 1) / unit * unit;
            end = stop > end ? stop : end;
            runs[i].launch = loader->launch;
        }
        slc_demand_scan_record_forget(&loader->scan, &loader->vk, commands, (uint32_t)first,
                                      end - first);
    }
}

static void transfers_to_shaders(SluiceDemandLoader *loader, VkCommandBuffer commands)
{
    slc_compute_barrier(&loader->vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                        SHADER_ACCESS | VK_ACCESS_TRANSFER_WRITE_BIT);
}

static void record_first(SluiceDemandLoader *loader, VkCommandBuffer commands)
{
    slc_page_pool_record_empty(loader->pages, loader->page_user, loader->launch, commands);
    slc_demand_scan_record_clear(&loader->scan, &loader->vk, commands);
    slc_compute_barrier(&loader->vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_WRITE_BIT);
    loader->cleared = true;
    loader->cleared_launch = loader->launch;
}

static void record_ranks(SluiceDemandLoader *loader, VkCommandBuffer commands)
{
    struct slc_rank_run *run = &loader->ranks[slot_of(loader, loader->launch)];
    if (slc_page_space_take_changes(loader->space, &run->first, &run->count))
        slc_demand_scan_record_ranks(&loader->scan, &loader->vk, commands,
                                     slc_page_space_ranks(loader->space), run->first, run->count);
}

static bool has_transfers(const SluiceDemandLoader *loader)
{
    return !loader->cleared || loader->has_shared || loader->space_changed ||
           count_forgotten(loader) || loader->admitted.first != SLC_NONE ||
           slc_productions_are_due(loader) || slc_table_mirror_has_changes(&loader->table) ||
           slc_table_mirror_has_changes(&loader->levels) ||
           slc_table_mirror_has_changes(&loader->grids);
}

/* Records all transfers except the page table; returns the tiles. No barrier without changes. */
static uint32_t record_transfers(SluiceDemandLoader *loader, VkCommandBuffer commands)
{
    slc_page_pool_record(loader->pages, loader->page_user, loader->launch, loader->processed,
                         commands);
    loader->ranks[slot_of(loader, loader->launch)] = (struct slc_rank_run){0};
    if (!has_transfers(loader))
        return 0;
    slc_compute_barrier(&loader->vk, commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                        SHADER_ACCESS | VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    if (!loader->cleared)
        record_first(loader, commands);
    if (loader->space_changed)
        record_ranks(loader, commands);
    loader->space_changed = loader->has_shared = false;
    record_forgotten(loader, commands);
    uint32_t tiles = slc_uploads_record(loader, commands);
    tiles += slc_productions_ask(loader, commands);
    slc_table_mirror_record(&loader->table, &loader->vk, commands, loader->launch);
    slc_table_mirror_record(&loader->levels, &loader->vk, commands, loader->launch);
    slc_table_mirror_record(&loader->grids, &loader->vk, commands, loader->launch);
    transfers_to_shaders(loader, commands);
    return tiles;
}

/* Adds the pages beyond their share to the pressure: byte pages may have taken part of the budget.
 */
static void note_pressure(SluiceDemandLoader *loader)
{
    struct slc_memory_pressure *pressure = &loader->memory_pressure;
    uint64_t excess = slc_page_pool_excess(loader->pages, loader->page_user);
    *pressure = slc_memory_client_begin(&loader->memory);
    if (excess > pressure->beyond)
        pressure->beyond = excess;
}

SluiceResult sluiceBeginDemandLaunch(SluiceDemandLoader *loader, VkCommandBuffer commandBuffer,
                                     SluiceDemandLaunch *pLaunch)
{
    if (!loader || !commandBuffer || !pLaunch)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked =
        slc_struct_check(SLC_STRUCT(SluiceDemandLaunch), pLaunch, &loader->vk.log);
    if (checked != SLUICE_SUCCESS)
        return checked;
    if (loader->launch > loader->ended) {
        slc_demand_strict_not_ended(loader);
        return slc_log_refusal(
            &loader->vk.log,
            "launch %llu was neither ended nor abandoned: no other one can be begun",
            (unsigned long long)loader->launch);
    }
    if (is_aborted(loader))
        return SLUICE_ERROR_CANCELED;
    if (loader->launch - loader->processed >= loader->info.launchesInFlight) {
        slc_demand_strict_not_ready(loader, loader->processed + 1);
        return SLUICE_NOT_READY;
    }
    uint64_t launch = loader->launch + 1;
    slc_loader_settings_apply(loader);
    bool tracking = wants_used(loader);
    bool probing = !tracking && slc_demand_strict_probes(loader, launch);
    slc_device_budget_turn(&loader->context->device_budget, &loader->context->budget);
    note_pressure(loader);
    end_retired(loader);
    slc_byte_pages_begin(loader, launch);
    slc_relieve_memory(loader);
    slc_staging_trim(&loader->staging); /* counts launches */
    if (loader->large.blocks)
        slc_staging_trim(&loader->large);
    gather(loader, launch, tracking || probing);
    SluiceResult result =
        slc_page_directory_record(&loader->directory, commandBuffer, slot_of(loader, launch));
    if (result != SLUICE_SUCCESS)
        return result; /* admitted uploads wait for the next launch */
    loader->launch = launch;
    loader->tracked[slot_of(loader, launch)] = tracking;
    loader->probed[slot_of(loader, launch)] = probing;
    SluiceDemandLaunch begun = {.structSize = sizeof begun,
                                .launchIndex = launch,
                                .semaphore = loader->semaphore,
                                .signalValue = launch,
                                .tileCount = record_transfers(loader, commandBuffer)};
    begun.descriptorSet =
        slc_descriptors_update(&loader->descriptors, &loader->vk, slot_of(loader, launch),
                               slc_page_pool_views(loader->pages, loader->page_user), NULL);
    slc_byte_pages_bind(loader, slot_of(loader, launch));
    slc_struct_write(SLC_STRUCT(SluiceDemandLaunch), pLaunch, &begun);
    loader->counts.launchCount++;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceEndDemandLaunch(SluiceDemandLoader *loader, VkCommandBuffer commandBuffer)
{
    if (!loader || !commandBuffer)
        return SLUICE_ERROR_NULL_POINTER;
    if (loader->launch == loader->ended) {
        slc_demand_strict_not_begun(loader);
        return slc_log_refusal(
            &loader->vk.log,
            "no launch can be ended: none was begun since the last one was ended or "
            "abandoned");
    }
    uint32_t slot = slot_of(loader, loader->launch);
    if (loader->tracked[slot] || loader->probed[slot])
        slc_page_directory_record_used(&loader->directory, commandBuffer, slot);
    slc_demand_scan_record(&loader->scan, &loader->vk, commandBuffer, slot,
                           slc_page_space_end(loader->space), loader->requests_per_launch);
    loader->ended = loader->launch;
    return SLUICE_SUCCESS;
}

static void put_ranks_back(SluiceDemandLoader *loader, uint64_t launch)
{
    const struct slc_rank_run *run = &loader->ranks[slot_of(loader, launch)];
    if (run->count == 0)
        return;
    slc_page_space_change_again(loader->space, run->first, run->count);
    loader->space_changed = true;
}

/* Restores the state before a launch. Only the page table can fail, and partly restored it is
 * valid. */
static SluiceResult put_back(SluiceDemandLoader *loader, uint64_t launch)
{
    for (uint64_t i = launch; i <= loader->launch; i++) {
        SluiceResult result = slc_page_directory_abandon(&loader->directory, slot_of(loader, i));
        if (result != SLUICE_SUCCESS)
            return result;
        put_ranks_back(loader, i);
    }
    loader->cleared &= loader->cleared_launch < launch;
    slc_page_pool_abandon(loader->pages, loader->page_user, launch);
    slc_uploads_abandon(loader, launch);
    slc_productions_ask_again(loader, launch);
    loader->has_shared = true;
    slc_table_mirror_abandon(&loader->table, launch);
    slc_table_mirror_abandon(&loader->levels, launch);
    slc_table_mirror_abandon(&loader->grids, launch);
    for (uint32_t i = 0; i < loader->forgotten_count; i++)
        if (loader->forgotten[i].launch >= launch)
            loader->forgotten[i].launch = 0;
    return SLUICE_SUCCESS;
}

static SluiceResult check_abandoned(SluiceDemandLoader *loader, uint64_t launch)
{
    uint64_t value = 0;
    SluiceResult result = slc_vk_result(
        &loader->vk,
        loader->vk.GetSemaphoreCounterValue(loader->vk.device, loader->semaphore, &value),
        "vkGetSemaphoreCounterValue");
    if (result != SLUICE_SUCCESS)
        return result;
    if (launch > loader->processed && launch <= loader->launch && value < launch)
        return SLUICE_SUCCESS;
    return slc_log_refusal(
        &loader->vk.log,
        "launch %llu cannot be abandoned: it is over, was abandoned or never begun",
        (unsigned long long)launch);
}

SluiceResult sluiceAbandonDemandLaunch(SluiceDemandLoader *loader,
                                       const SluiceDemandLaunch *pLaunch)
{
    if (!loader || !pLaunch)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDemandLaunch given = {.structSize = sizeof given};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceDemandLaunch), &given, pLaunch, &loader->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    uint64_t launch = given.launchIndex;
    result = check_abandoned(loader, launch);
    if (result == SLUICE_SUCCESS)
        result = put_back(loader, launch);
    if (result != SLUICE_SUCCESS)
        return result;
    loader->counts.launchCount -= loader->launch - (launch - 1);
    loader->launch = launch - 1;
    loader->strict.awaited = 0; /* the next launch has the number of this one */
    if (loader->ended > loader->launch)
        loader->ended = loader->launch;
    slc_residency_abandon(loader->residency, launch);
    return SLUICE_SUCCESS;
}

static SluiceResult wait_for(SluiceDemandLoader *loader, uint64_t launch, uint64_t timeout)
{
    const VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &loader->semaphore,
                                      .pValues = &launch};
    uint64_t patience = slc_demand_strict_patience(loader, launch, timeout);
    VkResult result = loader->vk.WaitSemaphores(loader->vk.device, &info, patience);
    if (result == VK_TIMEOUT)
        slc_demand_strict_not_ready(loader, launch);
    if (result == VK_TIMEOUT && patience < timeout)
        result = loader->vk.WaitSemaphores(loader->vk.device, &info,
                                           timeout == UINT64_MAX ? timeout : timeout - patience);
    if (result == VK_TIMEOUT)
        return SLUICE_NOT_READY;
    return slc_vk_result(&loader->vk, result, "vkWaitSemaphores");
}

SluiceResult sluiceProcessDemandRequests(SluiceDemandLoader *loader,
                                         const SluiceDemandLaunch *pLaunch, uint64_t timeoutNs,
                                         SluiceDemandRequests *pRequests,
                                         SluiceDemandTicket *pTicket)
{
    SluiceDemandTicket ticket;
    if (!loader || !pLaunch || !pRequests)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDemandLaunch given = {.structSize = sizeof given};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceDemandLaunch), &given, pLaunch, &loader->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_struct_check(SLC_STRUCT(SluiceDemandRequests), pRequests, &loader->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (given.launchIndex <= loader->processed || given.launchIndex > loader->ended)
        return slc_demand_refuse(loader, __func__,
                                 "launch %" PRIu64
                                 " was not ended, or was processed before: %" PRIu64
                                 " is processed, %" PRIu64 " is ended",
                                 given.launchIndex, loader->processed, loader->ended);
    if (is_aborted(loader))
        return SLUICE_ERROR_CANCELED;
    result = wait_for(loader, given.launchIndex, timeoutNs);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_ticket_open(&loader->tickets, &ticket);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    while (loader->processed < given.launchIndex) {
        loader->processed++;
        end_retired(loader);
        slc_requests_process(loader, loader->processed, ticket, &requests);
    }
    requests.lodBias = slc_residency_lod_bias(loader->residency);
    slc_struct_write(SLC_STRUCT(SluiceDemandRequests), pRequests, &requests);
    ticket = slc_ticket_close(&loader->tickets, ticket);
    if (pTicket)
        *pTicket = ticket;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetDemandTicketStatus(SluiceDemandLoader *loader, SluiceDemandTicket ticket,
                                         SluiceDemandTicketStatus *pStatus)
{
    if (!loader || !pStatus)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked =
        slc_struct_check(SLC_STRUCT(SluiceDemandTicketStatus), pStatus, &loader->vk.log);
    if (checked != SLUICE_SUCCESS)
        return checked;
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    if (slc_ticket_get_status(&loader->tickets, ticket, &status) != SLUICE_SUCCESS)
        return slc_demand_refuse_ticket(loader, __func__, ticket);
    slc_struct_write(SLC_STRUCT(SluiceDemandTicketStatus), pStatus, &status);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceWaitDemandTicket(SluiceDemandLoader *loader, SluiceDemandTicket ticket,
                                    uint64_t timeoutNs, SluiceDemandTicketStatus *pStatus)
{
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    if (pStatus) {
        SluiceResult checked =
            slc_struct_check(SLC_STRUCT(SluiceDemandTicketStatus), pStatus, &loader->vk.log);
        if (checked != SLUICE_SUCCESS)
            return checked;
    }
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    SluiceResult result = slc_ticket_wait(&loader->tickets, ticket, timeoutNs, &status);
    if (result == SLUICE_ERROR_INVALID_ARGUMENT)
        return slc_demand_refuse_ticket(loader, __func__, ticket);
    if (pStatus)
        slc_struct_write(SLC_STRUCT(SluiceDemandTicketStatus), pStatus, &status);
    return result;
}
