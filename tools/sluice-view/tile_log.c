#include "tile_log.h"

#include <stdlib.h>
#include <string.h>

static int compare(const void *left, const void *right)
{
    const struct tile_log_texture *a = left, *b = right;
    return a->id < b->id ? -1 : a->id > b->id;
}

bool tile_log_create(const SluiceTextureId *ids, const uint32_t *tile_counts, uint32_t count,
                     struct tile_log *log)
{
    size_t tiles = 0;
    *log = (struct tile_log){.texture_count = count, .texture_capacity = count + 1};
    log->textures = calloc(count + 1u, sizeof *log->textures);
    for (uint32_t i = 0; log->textures && i < count; i++) {
        log->textures[i] = (struct tile_log_texture){ids[i], tile_counts[i], i, tiles};
        tiles += tile_counts[i];
    }
    log->tiles = calloc(tiles + 1, sizeof *log->tiles);
    log->tile_count = tiles;
    log->tile_capacity = tiles + 1;
    if (!log->textures || !log->tiles) {
        tile_log_destroy(log);
        return false;
    }
    qsort(log->textures, count, sizeof *log->textures, compare);
    return true;
}

bool tile_log_keep_stages(struct tile_log *log)
{
    log->stages = calloc(1, sizeof *log->stages);
    if (log->stages)
        log->stages->listed = calloc(log->tile_capacity + 1, sizeof *log->stages->listed);
    return log->stages && log->stages->listed;
}

static bool reserve_texture(struct tile_log *log)
{
    if (log->texture_count < log->texture_capacity)
        return true;
    const uint32_t capacity = 2 * log->texture_capacity + 16;
    struct tile_log_texture *textures = realloc(log->textures, capacity * sizeof *textures);
    if (!textures)
        return false;
    log->textures = textures;
    log->texture_capacity = capacity;
    return true;
}

static bool reserve_tiles(struct tile_log *log, size_t count)
{
    if (count <= log->tile_capacity)
        return true;
    const size_t old = log->tile_capacity, capacity = 2 * old > count ? 2 * old : count;
    struct tile_log_tile *tiles = realloc(log->tiles, capacity * sizeof *tiles);
    if (!tiles)
        return false;
    memset(tiles + old, 0, (capacity - old) * sizeof *tiles);
    log->tiles = tiles;
    if (log->stages) {
        uint32_t *listed = realloc(log->stages->listed, (capacity + 1) * sizeof *listed);
        if (!listed)
            return false;
        memset(listed + old, 0, (capacity + 1 - old) * sizeof *listed);
        log->stages->listed = listed;
    }
    log->tile_capacity = capacity;
    return true;
}

bool tile_log_add(struct tile_log *log, SluiceTextureId id, uint32_t tile_count)
{
    if (!reserve_texture(log) || !reserve_tiles(log, log->tile_count + tile_count))
        return false;
    uint32_t at = log->texture_count;
    for (; at > 0 && log->textures[at - 1].id > id; at--)
        log->textures[at] = log->textures[at - 1];
    log->textures[at] =
        (struct tile_log_texture){id, tile_count, log->texture_count, log->tile_count};
    log->texture_count++;
    log->tile_count += tile_count;
    return true;
}

void tile_log_destroy(struct tile_log *log)
{
    free(log->textures);
    free(log->tiles);
    if (log->stages)
        free(log->stages->listed);
    free(log->stages);
    *log = (struct tile_log){0};
}

static const struct tile_log_texture *find_texture(const struct tile_log *log, SluiceTextureId id)
{
    const struct tile_log_texture key = {.id = id};
    return log->texture_count == 0
               ? NULL
               : bsearch(&key, log->textures, log->texture_count, sizeof *log->textures, compare);
}

bool tile_log_index(const struct tile_log *log, SluiceTextureId id, uint32_t *index)
{
    const struct tile_log_texture *found = find_texture(log, id);
    if (found)
        *index = found->index;
    return found;
}

static struct tile_log_tile *find(const struct tile_log *log, SluiceTextureId id, uint32_t tile)
{
    const struct tile_log_texture *found = find_texture(log, id);
    return found && tile < found->tile_count ? &log->tiles[found->first_tile + tile] : NULL;
}

static void count(uint16_t *counter)
{
    *counter += *counter < UINT16_MAX;
}

static void count_wait(uint64_t *counts, uint32_t wait)
{
    counts[wait < TILE_LOG_MOST_WAIT ? wait : TILE_LOG_MOST_WAIT]++;
}

/* Notes stages of a load. Call before tile->requested is cleared. */
static void note_stages(struct tile_log *log, const struct tile_log_tile *tile,
                        const SluiceTileEvent *event)
{
    struct tile_log_stages *stages = log->stages;
    if (!stages)
        return;
    uint32_t *listed = &stages->listed[tile - log->tiles];
    const uint32_t now = (uint32_t)event->mark + 1;
    if (event->to == SLUICE_TILE_STATE_ALLOCATED && event->reason == SLUICE_TILE_EVENT_LISTED) {
        *listed = now;
        count_wait(stages->queue, now - tile->requested);
    }
    if (event->reason == SLUICE_TILE_EVENT_ANSWERED) {
        if (*listed > 0 &&
            (event->to == SLUICE_TILE_STATE_MAPPED || event->to == SLUICE_TILE_STATE_STANDBY))
            count_wait(stages->load, now - *listed);
        *listed = 0;
    }
}

static void note_load(struct tile_log *log, struct tile_log_tile *tile,
                      const SluiceTileEvent *event)
{
    count(&tile->loads);
    tile->loaded_time = event->timeStamp;
    log->loads++;
    if (tile->requested > 0) {
        count_wait(log->waits, (uint32_t)event->mark + 1 - tile->requested);
        log->wait_count++;
    }
    tile->requested = 0;
}

void tile_log_take(struct tile_log *log, const SluiceTileEvent *event, uint64_t timeout)
{
    struct tile_log_tile *tile = find(log, event->textureId, event->tileIndex);
    if (!tile)
        return;
    const bool arrives = event->reason == SLUICE_TILE_EVENT_ANSWERED;
    /* Requests from before the log began are known when a frame takes them up. */
    if ((event->to == SLUICE_TILE_STATE_REQUESTED && event->from == SLUICE_TILE_STATE_FREE) ||
        (event->to == SLUICE_TILE_STATE_ALLOCATED && tile->requested == 0))
        tile->requested = (uint32_t)event->mark + 1;
    note_stages(log, tile, event);
    if (arrives &&
        (event->to == SLUICE_TILE_STATE_MAPPED || event->to == SLUICE_TILE_STATE_STANDBY))
        note_load(log, tile, event);
    if (arrives && event->to == SLUICE_TILE_STATE_FAILED)
        count(&tile->failures);
    if (event->to == SLUICE_TILE_STATE_FREE)
        tile->requested = 0;
    const bool expires = event->from == SLUICE_TILE_STATE_MAPPED &&
                         event->to == SLUICE_TILE_STATE_STANDBY &&
                         event->reason == SLUICE_TILE_EVENT_FEEDBACK;
    const bool unwanted = event->from == SLUICE_TILE_STATE_CANCELED &&
                          event->to == SLUICE_TILE_STATE_STANDBY && arrives;
    if (unwanted || (expires && tile->loads > 0 && event->timeStamp - tile->loaded_time <= timeout))
        log->stale++;
}

const struct tile_log_tile *tile_log_get(const struct tile_log *log, SluiceTextureId id,
                                         uint32_t tile)
{
    return find(log, id, tile);
}

uint32_t tile_log_wait_of(const uint64_t *counts, double part)
{
    uint64_t all = 0, sum = 0;
    for (uint32_t frames = 0; frames <= TILE_LOG_MOST_WAIT; frames++)
        all += counts[frames];
    for (uint32_t frames = 0; all > 0 && frames <= TILE_LOG_MOST_WAIT; frames++) {
        sum += counts[frames];
        if ((double)sum >= part * (double)all)
            return frames;
    }
    return 0;
}

uint32_t tile_log_wait(const struct tile_log *log, double part)
{
    return tile_log_wait_of(log->waits, part);
}
