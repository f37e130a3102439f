#include "report.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

struct figure {
    const char *name;
    uint64_t value;
    const char *unit;
};

#define FIGURES_MOST 20

static size_t get_manager_figures(const SluiceReplayResult *result,
                                  const SluiceStreamedTextureStatistics *s, struct figure *figures)
{
    const struct figure all[] = {
        {"events", result->eventCount, "calls"},
        {"textures", s->textureCount, "textures"},
        {"tiles", s->tileCount, "tiles"},
        {"tiles_requested", s->requestedTileCount, "tiles"},
        {"tiles_allocated", s->allocatedTileCount, "tiles"},
        {"tiles_mapped", s->mappedTileCount, "tiles"},
        {"tiles_standby", s->standbyTileCount, "tiles"},
        {"tiles_canceled", s->canceledTileCount, "tiles"},
        {"tiles_failed", s->failedTileCount, "tiles"},
        {"tiles_given_up", s->givenUpTileCount, "tiles"},
        {"slots_retiring", s->retiringSlotCount, "slots"},
        {"slots_free", s->freeSlotCount, "slots"},
        {"heaps", s->heapCount, "heaps"},
        {"handed_out_total", s->handedOutTotal, "tiles"},
        {"mapped_total", s->mappedTotal, "tiles"},
        {"unmapped_total", s->unmappedTotal, "tiles"},
        {"canceled_total", s->canceledTotal, "tiles"},
        {"failed_total", s->failedTotal, "tiles"},
        {"restored_total", s->restoredTotal, "tiles"},
        {"moved_total", s->movedTotal, "tiles"},
    };
    memcpy(figures, all, sizeof all);
    return sizeof all / sizeof *all;
}

static size_t get_demand_figures(const SluiceReplayResult *result, struct figure *figures)
{
    const SluiceDemandReplayStatistics *s = &result->demand;
    const struct figure all[] = {
        {"events", result->eventCount, "calls"},
        {"launches", s->launchCount, "launches"},
        {"uses", s->useCount, "pages"},
        {"requests", s->requestCount, "requests"},
        {"loads", s->loadCount, "pages"},
        {"refusals", s->refusalCount, "requests"},
        {"postponed", s->postponedCount, "requests"},
        {"failures", s->failureCount, "pages"},
        {"evicted_total", s->evictedCount, "pages"},
        {"restored_total", s->restoredCount, "pages"},
        {"pages_resident", s->residentCount, "pages"},
        {"pages_loading", s->loadingCount, "pages"},
        {"pages_refused", s->refusedCount, "pages"},
        {"lod_bias", (uint64_t)(4 * s->lodBias), "quarters"},
    };
    memcpy(figures, all, sizeof all);
    return sizeof all / sizeof *all;
}

static size_t get_figures(const SluiceReplayResult *result,
                          const SluiceStreamedTextureStatistics *s,
                          struct figure figures[FIGURES_MOST])
{
    return result->kind == SLUICE_TRACE_KIND_DEMAND_RECORDING
               ? get_demand_figures(result, figures)
               : get_manager_figures(result, s, figures);
}

static bool has_host_memory(const SluiceReplayResult *result)
{
    return result->kind != SLUICE_TRACE_KIND_DEMAND_RECORDING;
}

void print_report(const SluiceReplayResult *result, const SluiceStreamedTextureStatistics *s)
{
    struct figure figures[FIGURES_MOST];
    size_t count = get_figures(result, s, figures);
    for (size_t i = 0; i < count; i++)
        printf("%-18s %12" PRIu64 " %s\n", figures[i].name, figures[i].value, figures[i].unit);
    if (has_host_memory(result))
        printf("%-18s %12" PRIu64 " bytes\n", "host_memory", s->hostMemorySize);
    if (result->recordedHash)
        printf("%-18s %s\n", "as_recorded",
               result->decisionHash == result->recordedHash ? "yes, all decisions" : "no");
    printf("hash %016" PRIx64 " events %" PRIu64 "\n", result->decisionHash, result->eventCount);
}

void print_json(const SluiceReplayResult *result, const SluiceStreamedTextureStatistics *s)
{
    struct figure figures[FIGURES_MOST];
    size_t count = get_figures(result, s, figures);
    for (size_t i = 0; i < count; i++)
        printf("{\"name\": \"%s\", \"value\": %" PRIu64 ", \"unit\": \"%s\"}\n", figures[i].name,
               figures[i].value, figures[i].unit);
    if (has_host_memory(result))
        printf("{\"name\": \"host_memory\", \"value\": %" PRIu64 ", \"unit\": \"bytes\"}\n",
               s->hostMemorySize);
    printf("{\"name\": \"hash\", \"value\": \"%016" PRIx64 "\", \"unit\": \"fnv1a64\"}\n",
           result->decisionHash);
}
