#include "facts.h"

#include "played_facts.h"
#include "traced.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MB 1e6
#define TILE_SIZE 65536u
/* Limits per frame. Textures take turns, so that a frame takes little time. */
#define TEXELS_PER_FRAME 16384u
#define READS_PER_FRAME 16u

static const char *const names[SERIES_COUNT] = {
    "resident_mb",    "wanted_mb", "standby_mb", "budget_mb", "read_mb_s",
    "uploaded_mb_s",  "mapped",    "unmapped",   "canceled",  "failed",
    "sharp_percent",  "bias",      "frame_ms",   "host_ms",   "gpu_ms",
    "stale",          "restored",  "bind_calls", "bind_runs", "feedback_words",
    "missing_percent"};

const char *facts_series_name(enum facts_series series)
{
    return names[series];
}

static size_t map_size_of(const SluiceStreamedTextureManager *manager, SluiceTextureId id,
                          SluiceStreamedTextureLayout *layout)
{
    *layout = (SluiceStreamedTextureLayout){.structSize = sizeof *layout};
    if (sluiceGetTextureLayout(manager, id, layout) != SLUICE_SUCCESS)
        return 0;
    return (size_t)layout->minMipWidth * layout->minMipHeight;
}

static bool create_log(struct view_facts *f, const struct stage *stage)
{
    SluiceTextureId *ids = malloc((f->texture_count + 1u) * sizeof *ids);
    uint32_t *tiles = calloc(f->texture_count + 1u, sizeof *tiles);
    for (uint32_t i = 0; ids && tiles && i < f->texture_count; i++) {
        SluiceStreamedTextureLayout layout;
        ids[i] = stage_texture(stage, i)->id;
        if (map_size_of(stage_manager(stage), ids[i], &layout) > 0)
            tiles[i] = layout.tileCount;
    }
    const bool created = ids && tiles && tile_log_create(ids, tiles, f->texture_count, &f->log);
    free(ids);
    free(tiles);
    return created;
}

bool facts_create(struct view_facts *f, const struct stage *stage)
{
    *f = (struct view_facts){.texture_count = stage_texture_count(stage)};
    if (stage_played(stage)) {
        if (played_facts_create(stage, f))
            return true;
        fprintf(stderr, "sluice-view: out of memory\n");
        facts_destroy(f);
        return false;
    }
    f->textures = calloc(f->texture_count + 1, sizeof *f->textures);
    f->events = calloc(FACTS_EVENTS, sizeof *f->events);
    for (uint32_t i = 0; !stage_traced(stage) && i < f->texture_count; i++) {
        SluiceStreamedTextureLayout layout;
        size_t size = map_size_of(stage_manager(stage), stage_texture(stage, i)->id, &layout);
        f->tails_size += (uint64_t)layout.desc.packedTileCount * TILE_SIZE;
        f->map_size = size > f->map_size ? size : f->map_size;
        f->all_size += stage_texture(stage, i)->size;
    }
    f->maps = malloc(2 * f->map_size + 1);
    if (history_create(SERIES_COUNT, &f->history) && create_log(f, stage) && f->textures &&
        f->events && f->maps)
        return true;
    fprintf(stderr, "sluice-view: out of memory\n");
    facts_destroy(f);
    return false;
}

void facts_destroy(struct view_facts *f)
{
    history_destroy(&f->history);
    if (!f->borrows) {
        tile_log_destroy(&f->log);
        free(f->events);
    }
    free(f->textures);
    free(f->maps);
    *f = (struct view_facts){0};
}

static void read_events(struct view_facts *f, const SluiceStreamedTextureManager *manager,
                        uint64_t timeout)
{
    SluiceResult result;
    f->stale_before = f->log.stale;
    do {
        uint32_t count = FACTS_EVENTS - f->event_next;
        uint64_t lost = 0;
        result = sluiceReadTileEvents(manager, &f->event_cursor, &count, f->events + f->event_next,
                                      &lost);
        for (uint32_t i = 0; i < count; i++)
            tile_log_take(&f->log, &f->events[f->event_next + i], timeout);
        f->event_next = (f->event_next + count) % FACTS_EVENTS;
        f->event_count =
            f->event_count + count > FACTS_EVENTS ? FACTS_EVENTS : f->event_count + count;
    } while (result == SLUICE_INCOMPLETE);
}

/* Compares requested and resident levels for each tile of level 0. */
static size_t compare_maps(struct view_facts *f, const SluiceStreamedTextureManager *manager,
                           SluiceTextureId id, struct facts_texture *texture)
{
    SluiceStreamedTextureLayout layout;
    const size_t size = map_size_of(manager, id, &layout);
    const uint32_t width = layout.minMipWidth;
    uint8_t *resident = f->maps, *wanted = f->maps + f->map_size;
    texture->finest_level = SLUICE_MIP_UNTOUCHED;
    if (size == 0 || size > f->map_size ||
        sluiceWriteMinMipData(manager, id, width, size, resident) != SLUICE_SUCCESS ||
        sluiceWriteRequestedLevels(manager, id, width, size, wanted) != SLUICE_SUCCESS)
        return 1;
    for (size_t i = 0; i < size; i++) {
        if (resident[i] < texture->finest_level)
            texture->finest_level = resident[i];
        f->seen_count += wanted[i] != SLUICE_MIP_UNTOUCHED;
        f->sharp_count += wanted[i] != SLUICE_MIP_UNTOUCHED && resident[i] <= wanted[i];
    }
    return size;
}

static void look_at_maps(struct view_facts *f, const struct stage *stage)
{
    const SluiceStreamedTextureManager *manager = stage_manager(stage);
    for (size_t done = 0, i = 0; i < f->texture_count && done < TEXELS_PER_FRAME; i++) {
        done += compare_maps(f, manager, stage_texture(stage, f->map_texture)->id,
                             &f->textures[f->map_texture]);
        if (++f->map_texture < f->texture_count)
            continue;
        f->sharp_known = f->seen_count > 0;
        f->sharp = f->sharp_known ? (double)f->sharp_count / (double)f->seen_count : 0.0;
        f->map_texture = 0;
        f->seen_count = f->sharp_count = 0;
    }
}

static void sum_textures(struct view_facts *f, const struct stage *stage)
{
    const SluiceStreamedTextureManager *manager = stage_manager(stage);
    f->resident_size = f->wanted_size = 0;
    for (uint32_t i = 0; i < f->texture_count; i++) {
        struct facts_texture *texture = &f->textures[i];
        texture->statistics = (SluiceTextureStatistics){.structSize = sizeof texture->statistics};
        if (sluiceGetTextureStatistics(manager, stage_texture(stage, i)->id,
                                       &texture->statistics) != SLUICE_SUCCESS)
            continue;
        f->resident_size += texture->statistics.residentSize;
        f->wanted_size += texture->statistics.wantedSize;
        texture->thrash =
            texture->statistics.residentTileCount
                ? texture->statistics.mappedTotal / (double)texture->statistics.residentTileCount
                : 0.0;
    }
}

struct budget_need facts_budget_need(const struct view_facts *f, const struct stage *stage)
{
    struct budget_need need = {0};
    const SluiceStreamedTextureManager *manager = stage_manager(stage);
    for (uint32_t i = 0; i < f->texture_count; i++) {
        SluiceStreamedTextureLayout layout;
        const SluiceTextureId id = stage_texture(stage, i)->id;
        const size_t size = map_size_of(manager, id, &layout);
        if (size == 0 || sluiceWriteRequestedLevels(manager, id, layout.minMipWidth, size,
                                                    f->maps) != SLUICE_SUCCESS)
            continue;
        budget_need_add(&need, f->maps, layout.minMipWidth, layout.minMipHeight,
                        layout.desc.regularMipCount, layout.desc.packedTileCount);
    }
    return need;
}

void facts_look_at_all(struct view_facts *f, const struct stage *stage)
{
    sum_textures(f, stage);
    f->seen_count = f->sharp_count = 0;
    for (uint32_t i = 0; i < f->texture_count; i++)
        compare_maps(f, stage_manager(stage), stage_texture(stage, i)->id, &f->textures[i]);
    f->sharp_known = f->seen_count > 0;
    f->sharp = f->sharp_known ? (double)f->sharp_count / (double)f->seen_count : 0.0;
}

/* Updates the figures of some sources per frame, since each takes a lock of the loader. */
static void look_at_reads(struct view_facts *f, const struct stage *stage)
{
    f->reads = (SluiceTileLoaderStatistics){.structSize = sizeof f->reads};
    sluiceGetVulkanReadStatistics(stage_streamer(stage), NULL, &f->reads);
    for (uint32_t i = 0; i < f->texture_count && i < READS_PER_FRAME; i++) {
        SluiceTileLoaderStatistics *reads = &f->textures[f->reads_texture].reads;
        *reads = (SluiceTileLoaderStatistics){.structSize = sizeof *reads};
        sluiceGetVulkanReadStatistics(stage_streamer(stage), stage_source(stage, f->reads_texture),
                                      reads);
        f->reads_texture = (f->reads_texture + 1) % f->texture_count;
    }
}

static void remember(struct view_facts *f, double seconds)
{
    const SluiceVulkanStreamerStatistics *now = &f->now, *before = &f->before;
    const double took = f->real_seconds > 0 ? f->real_seconds : seconds;
    const double values[SERIES_COUNT] = {
        [SERIES_RESIDENT] = (double)f->resident_size / MB,
        [SERIES_WANTED] = (double)f->wanted_size / MB,
        [SERIES_STANDBY] = (double)f->standby_size / MB,
        [SERIES_BUDGET] = (double)f->budget / MB,
        [SERIES_READ] = (double)(now->bytesRead - before->bytesRead) / MB / took,
        [SERIES_UPLOADED] = (double)(now->bytesUploaded - before->bytesUploaded) / MB / took,
        [SERIES_MAPPED] = (double)(now->tilesMapped - before->tilesMapped),
        [SERIES_UNMAPPED] = (double)(now->tilesUnmapped - before->tilesUnmapped),
        [SERIES_CANCELED] = (double)(now->tilesCanceled - before->tilesCanceled),
        [SERIES_FAILED] = (double)(now->tilesFailed - before->tilesFailed),
        [SERIES_SHARP] = 100.0 * f->sharp,
        [SERIES_BIAS] = now->globalMipBias / 16.0,
        [SERIES_FRAME] = 1e3 * took,
        [SERIES_HOST] = 1e3 * f->host_seconds,
        [SERIES_GPU] = 1e3 * f->gpu_seconds,
        [SERIES_STALE] = (double)(f->log.stale - f->stale_before),
        [SERIES_RESTORED] = (double)(now->tilesRestored - before->tilesRestored),
        [SERIES_BIND_CALLS] = (double)(now->bindCalls - before->bindCalls),
        [SERIES_BIND_RUNS] = (double)(now->bindRuns - before->bindRuns),
        [SERIES_FEEDBACK_WORDS] = (double)(now->feedbackWords - before->feedbackWords),
        [SERIES_MISSING] = 100.0 - 100.0 * f->sharp};
    for (int i = 0; i < SERIES_COUNT; i++)
        f->latest[i] = (float)values[i];
    history_add(&f->history, took, f->latest);
}

static void look_at_streamer(struct view_facts *f, const struct stage *stage,
                             const struct view_settings *settings)
{
    f->before = f->now;
    f->now = (SluiceVulkanStreamerStatistics){.structSize = sizeof f->now};
    f->stages = (SluiceVulkanLoadStages){.structSize = sizeof f->stages};
    sluiceGetVulkanStreamerStatistics(stage_streamer(stage), &f->now);
    sluiceGetVulkanLoadStages(stage_streamer(stage), &f->stages);
    if (f->frame == 0)
        f->before = f->now;
    f->standby_size = (uint64_t)f->now.standbyTileCount * TILE_SIZE;
    f->memory_size = f->now.tileMemorySize;
    sum_textures(f, stage);
    look_at_maps(f, stage);
    look_at_reads(f, stage);
    read_events(f, stage_manager(stage), (uint64_t)(settings->timeout * STAGE_TICKS_PER_SECOND));
}

void facts_update(struct view_facts *f, const struct stage *stage,
                  const struct view_settings *settings, double seconds)
{
    if (stage_played(stage)) {
        played_facts_update(stage, f);
        f->seconds += seconds;
        f->frame++;
        return;
    }
    f->budget = settings->budget;
    f->context = (SluiceVulkanContextStatistics){.structSize = sizeof f->context};
    sluiceGetVulkanContextStatistics(stage_context(stage), &f->context);
    if (stage_traced(stage))
        traced_facts_update(stage_traced(stage), f);
    else
        look_at_streamer(f, stage, settings);
    f->seconds += seconds;
    const double took = f->real_seconds > 0 ? f->real_seconds : seconds;
    f->frame_seconds = f->frame == 0 ? took : f->frame_seconds * 0.9 + took * 0.1;
    remember(f, seconds);
    f->frame++;
}
