#include "tile_log.h"

#include <stdlib.h>
#include <string.h>

struct head {
    size_t tiles, waits; ///< entries
    uint64_t loads, stale, wait_count;
};

struct tile_entry {
    size_t at;
    struct tile_log_tile tile;
    uint32_t listed;
};

struct wait_entry {
    uint32_t histogram, frames;
    uint64_t count;
};

#define HISTOGRAMS 3u

static uint64_t *histogram_of(struct tile_log *log, uint32_t number)
{
    uint64_t *const all[HISTOGRAMS] = {log->waits, log->stages->queue, log->stages->load};
    return all[number];
}

static bool is_blank(const struct tile_log *log, size_t at)
{
    const struct tile_log_tile *tile = &log->tiles[at];
    return tile->loads == 0 && tile->failures == 0 && tile->requested == 0 &&
           log->stages->listed[at] == 0;
}

static struct head count_entries(struct tile_log *log)
{
    struct head head = {0, 0, log->loads, log->stale, log->wait_count};
    for (size_t at = 0; at < log->tile_count; at++)
        head.tiles += !is_blank(log, at);
    for (uint32_t i = 0; i < HISTOGRAMS; i++)
        for (uint32_t frames = 0; frames <= TILE_LOG_MOST_WAIT; frames++)
            head.waits += histogram_of(log, i)[frames] > 0;
    return head;
}

static void write_entries(struct tile_log *log, struct tile_entry *tiles, struct wait_entry *waits)
{
    for (size_t at = 0; at < log->tile_count; at++)
        if (!is_blank(log, at))
            *tiles++ = (struct tile_entry){at, log->tiles[at], log->stages->listed[at]};
    for (uint32_t i = 0; i < HISTOGRAMS; i++)
        for (uint32_t frames = 0; frames <= TILE_LOG_MOST_WAIT; frames++)
            if (histogram_of(log, i)[frames] > 0)
                *waits++ = (struct wait_entry){i, frames, histogram_of(log, i)[frames]};
}

bool tile_log_keep(const struct tile_log *from, struct tile_log_kept *kept)
{
    struct tile_log log = *from; /* its arrays are only read */
    const struct head head = count_entries(&log);
    kept->size = sizeof head + head.tiles * sizeof(struct tile_entry) +
                 head.waits * sizeof(struct wait_entry);
    kept->bytes = malloc(kept->size);
    if (!kept->bytes)
        return false;
    memcpy(kept->bytes, &head, sizeof head);
    struct tile_entry *tiles = (struct tile_entry *)((char *)kept->bytes + sizeof head);
    write_entries(&log, tiles, (struct wait_entry *)(tiles + head.tiles));
    return true;
}

void tile_log_restore(struct tile_log *log, const struct tile_log_kept *kept)
{
    struct head head;
    memcpy(&head, kept->bytes, sizeof head);
    const struct tile_entry *tiles =
        (const struct tile_entry *)((const char *)kept->bytes + sizeof head);
    const struct wait_entry *waits = (const struct wait_entry *)(tiles + head.tiles);
    memset(log->tiles, 0, log->tile_count * sizeof *log->tiles);
    memset(log->stages->listed, 0, log->tile_count * sizeof *log->stages->listed);
    for (uint32_t i = 0; i < HISTOGRAMS; i++)
        memset(histogram_of(log, i), 0, sizeof log->waits);
    for (size_t i = 0; i < head.tiles; i++) {
        log->tiles[tiles[i].at] = tiles[i].tile;
        log->stages->listed[tiles[i].at] = tiles[i].listed;
    }
    for (size_t i = 0; i < head.waits; i++)
        histogram_of(log, waits[i].histogram)[waits[i].frames] = waits[i].count;
    log->loads = head.loads;
    log->stale = head.stale;
    log->wait_count = head.wait_count;
}

void tile_log_kept_finish(struct tile_log_kept *kept)
{
    free(kept->bytes);
    *kept = (struct tile_log_kept){0};
}
