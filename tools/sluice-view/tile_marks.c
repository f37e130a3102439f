#include "tile_marks.h"

#include <stdlib.h>
#include <string.h>

#define HEADER_WORDS 4u
#define MOST_EVENTS 256u
#define EVENT_CAPACITY 32768u
/* Limits per frame, since explaining a tile takes about a microsecond. Textures take turns. */
#define EXPLAINED_PER_FRAME 1024u
#define CELLS_PER_FRAME 65536u
#define TILE_HEIGHT_SHIFT 16

struct mark_texture {
    SluiceTextureId id;
    SluiceStreamedTextureLayout layout;
    uint32_t first_word, first_tile;
};

struct mark_order {
    SluiceTextureId id;
    uint32_t index;
};

/** A tile: time stamps of its last loads, a ring. */
struct mark_tile {
    uint64_t times[MARK_THRASH_LOADS];
    uint32_t count;
};

static SluiceStreamedTextureManager *manager_of(const struct tile_marks *m)
{
    SluiceStreamedTextureManager *manager = NULL;
    sluiceGetVulkanStreamerManager(m->streamer, &manager);
    return manager;
}

static int compare(const void *left, const void *right)
{
    const struct mark_order *a = left, *b = right;
    return a->id < b->id ? -1 : a->id > b->id;
}

/* Computes sizes. False if a texture is too large or unknown. */
static bool measure(struct tile_marks *m, const SluiceTextureId *ids)
{
    m->word_count = (size_t)HEADER_WORDS * (m->texture_count + 1u);
    for (uint32_t i = 0; i < m->texture_count; i++) {
        struct mark_texture *t = &m->textures[i];
        *t = (struct mark_texture){.id = ids[i],
                                   .layout = {.structSize = sizeof t->layout},
                                   .first_word = (uint32_t)m->word_count,
                                   .first_tile = (uint32_t)m->tile_count};
        m->order[i] = (struct mark_order){ids[i], i};
        if (sluiceGetTextureLayout(manager_of(m), ids[i], &t->layout) != SLUICE_SUCCESS)
            return false;
        const size_t cells = (size_t)t->layout.minMipWidth * t->layout.minMipHeight;
        m->map_size = cells > m->map_size ? cells : m->map_size;
        m->word_count += cells;
        m->tile_count += t->layout.tileCount;
        if (m->word_count > UINT32_MAX / 4 || m->tile_count > UINT32_MAX)
            return false;
    }
    qsort(m->order, m->texture_count, sizeof *m->order, compare);
    return true;
}

bool tile_marks_create(SluiceVulkanStreamer *streamer, const SluiceTextureId *ids, uint32_t count,
                       struct tile_marks *m)
{
    *m = (struct tile_marks){.streamer = streamer, .texture_count = count};
    m->textures = calloc(count + 1u, sizeof *m->textures);
    m->order = calloc(count + 1u, sizeof *m->order);
    if (m->textures && m->order && measure(m, ids)) {
        m->words = calloc(m->word_count, sizeof *m->words);
        m->tiles = calloc(m->tile_count + 1, sizeof *m->tiles);
        m->maps = malloc(2 * m->map_size + 1);
    }
    if (!m->words || !m->tiles || !m->maps) {
        tile_marks_destroy(m);
        return false;
    }
    sluiceSetTileEventCapacity(manager_of(m), EVENT_CAPACITY);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *header = m->words + (size_t)HEADER_WORDS * i;
        header[0] = m->textures[i].first_word;
        header[1] = m->textures[i].layout.minMipWidth;
        header[2] = m->textures[i].layout.minMipHeight;
        header[3] = m->textures[i].layout.desc.tileWidth | m->textures[i].layout.desc.tileHeight
                                                               << TILE_HEIGHT_SHIFT;
    }
    return true;
}

void tile_marks_destroy(struct tile_marks *m)
{
    free(m->textures);
    free(m->order);
    free(m->tiles);
    free(m->words);
    free(m->maps);
    *m = (struct tile_marks){0};
}

static void take_event(struct tile_marks *m, const SluiceTileEvent *event)
{
    const struct mark_order key = {event->textureId, 0};
    const struct mark_order *found =
        bsearch(&key, m->order, m->texture_count, sizeof *m->order, compare);
    if (!found || event->from != SLUICE_TILE_STATE_ALLOCATED ||
        event->to != SLUICE_TILE_STATE_MAPPED)
        return;
    struct mark_tile *tile = &m->tiles[m->textures[found->index].first_tile + event->tileIndex];
    tile->times[tile->count++ % MARK_THRASH_LOADS] = event->timeStamp;
}

static void take_events(struct tile_marks *m)
{
    SluiceTileEvent events[MOST_EVENTS];
    SluiceResult result;
    do {
        uint32_t count = MOST_EVENTS;
        result = sluiceReadTileEvents(manager_of(m), &m->event_cursor, &count, events, NULL);
        for (uint32_t i = 0; i < count; i++)
            take_event(m, &events[i]);
    } while (result == SLUICE_INCOMPLETE);
}

/* Returns the tile of `level` that covers a level 0 tile. */
static const struct mark_tile *tile_over(const struct tile_marks *m, const struct mark_texture *t,
                                         uint32_t x, uint32_t y, uint32_t level)
{
    const SluiceStreamedTextureLayout *layout = &t->layout;
    uint32_t index = layout->regularTileCount;
    if (level < layout->desc.regularMipCount) {
        const uint32_t width = layout->levelWidthInTiles[level];
        const uint32_t height = layout->levelHeightInTiles[level];
        const uint32_t column = x >> level < width ? x >> level : width - 1;
        const uint32_t row = y >> level < height ? y >> level : height - 1;
        index = layout->levelFirstTile[level] + row * width + column;
    }
    return index < layout->tileCount ? &m->tiles[t->first_tile + index] : NULL;
}

static bool thrashes(const struct mark_tile *tile, uint64_t now)
{
    return tile->count >= MARK_THRASH_LOADS &&
           now - tile->times[tile->count % MARK_THRASH_LOADS] < MARK_THRASH_MICROSECONDS;
}

static uint64_t age_of(const struct mark_tile *tile, uint64_t now)
{
    if (!tile || tile->count == 0)
        return UINT64_MAX;
    const uint64_t then = tile->times[(tile->count - 1) % MARK_THRASH_LOADS];
    return now > then ? now - then : 0;
}

static enum mark_reason explain(const struct tile_marks *m, const struct mark_texture *t,
                                uint32_t x, uint32_t y)
{
    SluiceVulkanExplanation why = {.structSize = sizeof why};
    const SluiceStreamedTextureDesc *desc = &t->layout.desc;
    const SluiceTextureRect rect = {x * desc->tileWidth, y * desc->tileHeight, 1, 1};
    if (sluiceExplainVulkanTexture(m->streamer, t->id, &rect, &why) != SLUICE_SUCCESS)
        return MARK_NOTHING;
    return mark_reason_of(why.reason);
}

/* Returns true if a global mip bias applies. Requested levels include the bias. */
static bool is_biased(const struct tile_marks *m)
{
    SluiceStreamedTextureStatistics now = {.structSize = sizeof now};
    return sluiceGetStatistics(manager_of(m), &now) == SLUICE_SUCCESS && now.globalMipBias > 0;
}

/* Writes the words of a texture. Returns the number of explained tiles. */
static size_t write_words(struct tile_marks *m, const struct mark_texture *t, uint64_t now)
{
    const uint32_t width = t->layout.minMipWidth, height = t->layout.minMipHeight;
    const size_t size = (size_t)width * height;
    uint8_t *resident = m->maps, *wanted = m->maps + m->map_size;
    size_t explained = 0;
    const bool biased = is_biased(m);
    if (sluiceWriteMinMipData(manager_of(m), t->id, width, size, resident) != SLUICE_SUCCESS ||
        sluiceWriteRequestedLevels(manager_of(m), t->id, width, size, wanted) != SLUICE_SUCCESS)
        return 0;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const size_t cell = (size_t)y * width + x;
            const struct mark_tile *tile = tile_over(m, t, x, y, resident[cell]);
            enum mark_reason reason = MARK_NOTHING;
            if (resident[cell] > 0 && (wanted[cell] < resident[cell] || biased)) {
                reason = explain(m, t, x, y);
                explained++;
            } else if (resident[cell] > 0) {
                reason = MARK_NOT_SEEN;
            }
            m->words[t->first_word + cell] =
                mark_word(reason, tile && thrashes(tile, now), age_of(tile, now));
        }
    return explained;
}

void tile_marks_update(struct tile_marks *m, uint64_t now, bool show)
{
    size_t explained = 0, cells = 0;
    take_events(m);
    for (uint32_t i = 0;
         show && i < m->texture_count && explained < EXPLAINED_PER_FRAME && cells < CELLS_PER_FRAME;
         i++) {
        const struct mark_texture *t = &m->textures[m->next_texture];
        explained += write_words(m, t, now);
        cells += (size_t)t->layout.minMipWidth * t->layout.minMipHeight;
        m->next_texture = (m->next_texture + 1) % m->texture_count;
    }
}

size_t tile_marks_size(const struct tile_marks *m)
{
    return m->word_count * sizeof *m->words;
}

void tile_marks_copy(const struct tile_marks *m, void *to)
{
    memcpy(to, m->words, tile_marks_size(m));
}
