#include "report.h"

#include <inttypes.h>
#include <stdio.h>

struct figure {
    const char *name;
    uint64_t value;
    const char *unit;
};

#define FIGURE_COUNT 20

static void get_figures(const SluiceReplayResult *result, struct figure figures[FIGURE_COUNT])
{
    const SluiceStreamedTextureStatistics *s = &result->statistics;
    const struct figure all[FIGURE_COUNT] = {
        {"events", result->eventCount, "calls"},
        {"textures", s->textureCount, "textures"},
        {"tiles", s->tileCount, "tiles"},
        {"tiles_requested", s->requestedTileCount, "tiles"},
        {"tiles_allocated", s->allocatedTileCount, "tiles"},
        {"tiles_mapped", s->mappedTileCount, "tiles"},
        {"tiles_standby", s->standbyTileCount, "tiles"},
        {"tiles_cancelled", s->cancelledTileCount, "tiles"},
        {"tiles_failed", s->failedTileCount, "tiles"},
        {"tiles_given_up", s->givenUpTileCount, "tiles"},
        {"slots_retiring", s->retiringSlotCount, "slots"},
        {"slots_free", s->freeSlotCount, "slots"},
        {"heaps", s->heapCount, "heaps"},
        {"handed_out_total", s->handedOutTotal, "tiles"},
        {"mapped_total", s->mappedTotal, "tiles"},
        {"unmapped_total", s->unmappedTotal, "tiles"},
        {"cancelled_total", s->cancelledTotal, "tiles"},
        {"failed_total", s->failedTotal, "tiles"},
        {"restored_total", s->restoredTotal, "tiles"},
        {"moved_total", s->movedTotal, "tiles"},
    };
    for (int i = 0; i < FIGURE_COUNT; i++)
        figures[i] = all[i];
}

void print_report(const SluiceReplayResult *result)
{
    struct figure figures[FIGURE_COUNT];
    get_figures(result, figures);
    for (int i = 0; i < FIGURE_COUNT; i++)
        printf("%-18s %12" PRIu64 " %s\n", figures[i].name, figures[i].value, figures[i].unit);
    printf("%-18s %12" PRIu64 " bytes\n", "host_memory", result->statistics.hostMemorySize);
    printf("hash %016" PRIx64 " events %" PRIu64 "\n", result->decisionHash, result->eventCount);
}

void print_json(const SluiceReplayResult *result)
{
    struct figure figures[FIGURE_COUNT];
    get_figures(result, figures);
    for (int i = 0; i < FIGURE_COUNT; i++)
        printf("{\"name\": \"%s\", \"value\": %" PRIu64 ", \"unit\": \"%s\"}\n", figures[i].name,
               figures[i].value, figures[i].unit);
    printf("{\"name\": \"host_memory\", \"value\": %" PRIu64 ", \"unit\": \"bytes\"}\n",
           result->statistics.hostMemorySize);
    printf("{\"name\": \"hash\", \"value\": \"%016" PRIx64 "\", \"unit\": \"fnv1a64\"}\n",
           result->decisionHash);
}
