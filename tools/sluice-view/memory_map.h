/** Colors and figures of the memory map. */
#ifndef SLUICE_VIEW_MEMORY_MAP_H
#define SLUICE_VIEW_MEMORY_MAP_H

#include "facts.h"
#include "stage.h"

enum memory_colors { MEMORY_BY_STATE, MEMORY_BY_TEXTURE, MEMORY_BY_LEVEL, MEMORY_BY_AGE };

/** A slot with a tile. */
struct memory_slot {
    SluiceTile tile;
    SluiceTileState state;
    uint32_t texture; ///< index
    uint32_t loads;
    double age; ///< seconds since it was loaded; below 0: unknown
};

struct memory_sums {
    uint32_t heaps, used; ///< slots with a tile
    uint32_t spare_heaps; ///< heaps that compaction could free
    double fragmentation; ///< spare heaps over heaps, 0 to 1
};

/** Color and texture of a slot. */
struct memory_shown {
    uint32_t color;   ///< 0: the slot is free
    uint32_t texture; ///< STAGE_NO_TEXTURE: none
};

/** Slots of all heaps, at most 0.1 s old. */
struct memory_map {
    struct memory_shown *slots; ///< owned; stage_heap_tiles per heap
    double *next;               ///< owned; per heap: seconds of the next update
    uint32_t heap_count;
    enum memory_colors by;
};

/** Returns the slots of a heap. Updates them 10 times per second, at once for other colors, and in
 *  each frame of a recording. `seconds`: time since the viewer began. NULL without memory. */
const struct memory_shown *memory_map_heap(struct memory_map *map, const struct stage *stage,
                                           const struct view_facts *facts, uint32_t heap,
                                           enum memory_colors by, double seconds);
/** Frees the map. A zeroed struct is allowed. */
void memory_map_finish(struct memory_map *map);
/** Reads a slot. False if it is free, or its texture does not belong to the scene. */
bool memory_slot_get(const struct stage *stage, const struct view_facts *facts, uint32_t heap,
                     uint32_t slot, struct memory_slot *to);
uint32_t memory_slot_color(const struct stage *stage, const struct memory_slot *slot,
                           enum memory_colors colors);
uint32_t memory_state_color(SluiceTileState state);
/** Returns the color of view 5 (age). */
uint32_t memory_age_color(double seconds);
/** Returns the color of view 6 (textures): textures of a set share a hue, followers are darker. */
uint32_t memory_texture_color(const struct stage *stage, uint32_t texture);
/** Returns sums over all heaps of the stage's manager. */
struct memory_sums memory_sums_of(const struct stage *stage);

struct view_app;
/** Moves at most 64 tiles so that heaps become empty. Shows the number of moved tiles. */
void memory_compact(struct view_app *app);
/** Evicts all standby tiles. Shows the number of evicted tiles. */
void memory_trim(struct view_app *app);

#endif /* SLUICE_VIEW_MEMORY_MAP_H */
