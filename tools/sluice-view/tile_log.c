#include "tile_log.h"

#include <stdlib.h>

struct tile_log_texture {
    SluiceTextureId id;
    uint32_t tile_count, index;
    size_t first_tile;
};

static int compare(const void *left, const void *right)
{
    const struct tile_log_texture *a = left, *b = right;
    return a->id < b->id ? -1 : a->id > b->id;
}

bool tile_log_create(const SluiceTextureId *ids, const uint32_t *tile_counts, uint32_t count,
                     struct tile_log *log)
{
    size_t tiles = 0;
    *log = (struct tile_log){.texture_count = count};
    log->textures = calloc(count + 1u, sizeof *log->textures);
    for (uint32_t i = 0; log->textures && i < count; i++) {
        log->textures[i] = (struct tile_log_texture){ids[i], tile_counts[i], i, tiles};
        tiles += tile_counts[i];
    }
    log->tiles = calloc(tiles + 1, sizeof *log->tiles);
    if (!log->textures || !log->tiles) {
        tile_log_destroy(log);
        return false;
    }
    qsort(log->textures, count, sizeof *log->textures, compare);
    return true;
}

void tile_log_destroy(struct tile_log *log)
{
    free(log->textures);
    free(log->tiles);
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

static void note_load(struct tile_log *log, struct tile_log_tile *tile,
                      const SluiceTileEvent *event)
{
    count(&tile->loads);
    tile->loaded_time = event->timeStamp;
    log->loads++;
    if (tile->requested > 0) {
        const uint32_t wait = (uint32_t)event->mark + 1 - tile->requested;
        log->waits[wait < TILE_LOG_MOST_WAIT ? wait : TILE_LOG_MOST_WAIT]++;
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

uint32_t tile_log_wait(const struct tile_log *log, double part)
{
    uint64_t sum = 0;
    for (uint32_t frames = 0; frames <= TILE_LOG_MOST_WAIT; frames++) {
        sum += log->waits[frames];
        if (log->wait_count > 0 && (double)sum >= part * (double)log->wait_count)
            return frames;
    }
    return 0;
}
