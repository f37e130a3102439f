#include "memory_map.h"

#include "panels.h"

#include <math.h>
#include <stdlib.h>

#define SECONDS 0.1
#define COMPACTED_TILES 64u /* per call; sparse mode reads each moved tile again */

bool memory_slot_get(const struct stage *stage, const struct view_facts *facts, uint32_t heap,
                     uint32_t slot, struct memory_slot *to)
{
    *to = (struct memory_slot){.age = -1};
    if (sluiceGetSlotTile(stage_manager(stage), heap, slot, &to->tile) != SLUICE_SUCCESS ||
        to->tile.textureId == SLUICE_NO_TEXTURE ||
        sluiceGetTileState(stage_manager(stage), to->tile.textureId, to->tile.tileIndex, &to->state,
                           NULL) != SLUICE_SUCCESS)
        return false;
    const struct tile_log_tile *log =
        tile_log_get(&facts->log, to->tile.textureId, to->tile.tileIndex);
    if (!log || !tile_log_index(&facts->log, to->tile.textureId, &to->texture))
        return false;
    to->loads = log->loads;
    if (log->loads > 0)
        to->age = (double)(stage_now(stage) - log->loaded_time) / STAGE_TICKS_PER_SECOND;
    return true;
}

uint32_t memory_state_color(SluiceTileState state)
{
    switch (state) {
    case SLUICE_TILE_STATE_MAPPED: return UI_COLOR(86, 180, 233, 255);
    case SLUICE_TILE_STATE_STANDBY: return UI_COLOR(0, 120, 90, 255);
    case SLUICE_TILE_STATE_ALLOCATED: return UI_COLOR(240, 228, 66, 255);
    case SLUICE_TILE_STATE_CANCELED: return UI_COLOR(204, 121, 167, 255);
    default: return UI_GRAY;
    }
}

/* Same colors as ageColor in shaders/view_colors.glsl. */
uint32_t memory_age_color(double seconds)
{
    return seconds < 0      ? UI_GRAY
           : seconds < 0.5  ? UI_COLOR(253, 231, 37, 255)
           : seconds < 2.0  ? UI_COLOR(122, 209, 81, 255)
           : seconds < 10.0 ? UI_COLOR(34, 168, 132, 255)
           : seconds < 60.0 ? UI_COLOR(42, 120, 142, 255)
                            : UI_COLOR(65, 68, 135, 255);
}

/* Same colors as identityColor in shaders/view_colors.glsl. */
uint32_t memory_texture_color(const struct stage *stage, uint32_t texture)
{
    static const double offsets[3] = {0.0, 0.33, 0.67};
    const uint32_t primary = stage_texture(stage, texture)->primary;
    const bool follows = primary != STAGE_NO_TEXTURE;
    const double hue = (follows ? primary : texture) * 0.61803399;
    const double bright = follows ? 0.6 : 1.0;
    uint32_t channels[3];
    for (int i = 0; i < 3; i++)
        channels[i] =
            (uint32_t)(255.0 * bright * (0.55 + 0.4 * cos(6.2831853 * (hue + offsets[i]))));
    return UI_COLOR(channels[0], channels[1], channels[2], 255);
}

uint32_t memory_slot_color(const struct stage *stage, const struct memory_slot *slot,
                           enum memory_colors colors)
{
    switch (colors) {
    case MEMORY_BY_TEXTURE: return memory_texture_color(stage, slot->texture);
    case MEMORY_BY_LEVEL: return panel_level_color(slot->tile.mipLevel);
    case MEMORY_BY_AGE: return memory_age_color(slot->age);
    default: return memory_state_color(slot->state);
    }
}

static bool fit_heap(struct memory_map *map, uint32_t heap, uint32_t tiles)
{
    if (heap < map->heap_count)
        return true;
    struct memory_shown *slots = realloc(map->slots, (heap + 1u) * (size_t)tiles * sizeof *slots);
    map->slots = slots ? slots : map->slots;
    double *next = realloc(map->next, (heap + 1u) * sizeof *next);
    map->next = next ? next : map->next;
    if (!slots || !next)
        return false;
    for (; map->heap_count <= heap; map->heap_count++)
        next[map->heap_count] = 0;
    return true;
}

const struct memory_shown *memory_map_heap(struct memory_map *map, const struct stage *stage,
                                           const struct view_facts *facts, uint32_t heap,
                                           enum memory_colors by, double seconds)
{
    const uint32_t tiles = stage_heap_tiles(stage);
    if (!fit_heap(map, heap, tiles))
        return NULL;
    for (uint32_t i = 0; map->by != by && i < map->heap_count; i++)
        map->next[i] = 0;
    map->by = by;
    struct memory_shown *slots = map->slots + (size_t)heap * tiles;
    if (seconds < map->next[heap] && !stage_played(stage))
        return slots;
    map->next[heap] = seconds + SECONDS;
    for (uint32_t i = 0; i < tiles; i++) {
        struct memory_slot slot;
        const bool used = memory_slot_get(stage, facts, heap, i, &slot);
        slots[i] = (struct memory_shown){used ? memory_slot_color(stage, &slot, by) : 0,
                                         used ? slot.texture : STAGE_NO_TEXTURE};
    }
    return slots;
}

void memory_map_finish(struct memory_map *map)
{
    free(map->slots);
    free(map->next);
    *map = (struct memory_map){0};
}

struct memory_sums memory_sums_of(const struct stage *stage)
{
    SluiceStreamedTextureStatistics now = {.structSize = sizeof now};
    struct memory_sums sums = {0};
    if (sluiceGetStatistics(stage_manager(stage), &now) != SLUICE_SUCCESS || now.heapCount == 0)
        return sums;
    sums.heaps = now.heapCount;
    const uint32_t tiles = stage_heap_tiles(stage);
    sums.used = now.heapCount * tiles - now.freeSlotCount - now.retiringSlotCount;
    sums.spare_heaps = sums.heaps - (sums.used + tiles - 1) / tiles;
    sums.fragmentation = (double)sums.spare_heaps / sums.heaps;
    return sums;
}

/* Returns true if a streamer exists. Recordings have none, nor the viewer before its first scene.
 */
static bool has_streamer(struct view_app *app)
{
    if (app->stage && stage_streamer(app->stage))
        return true;
    app_say(app, "No scene streams tiles here");
    return false;
}

void memory_compact(struct view_app *app)
{
    uint32_t moved = 0;
    if (!has_streamer(app))
        return;
    const SluiceResult result =
        sluiceCompactVulkanStreamer(stage_streamer(app->stage), COMPACTED_TILES, &moved);
    if (result == SLUICE_SUCCESS)
        app_say(app, moved ? "Moved %u tile%s together" : "No tile has to move", moved,
                moved == 1 ? "" : "s");
    else
        app_say(app, "Tiles were not moved: %s", sluiceGetResultName(result));
}

void memory_trim(struct view_app *app)
{
    const uint32_t count = app->facts.now.standbyTileCount;
    if (!has_streamer(app))
        return;
    sluiceTrimStandbyTiles(stage_manager(app->stage), 0);
    app_say(app, "Evicted %u standby tile%s", count, count == 1 ? "" : "s");
}
