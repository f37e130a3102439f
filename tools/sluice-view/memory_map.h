/** Colors and figures of the map of memory. */
#ifndef SLUICE_VIEW_MEMORY_MAP_H
#define SLUICE_VIEW_MEMORY_MAP_H

#include "facts.h"
#include "stage.h"

enum memory_colors { MEMORY_BY_STATE, MEMORY_BY_TEXTURE, MEMORY_BY_LEVEL, MEMORY_BY_AGE };

/** A slot that a tile has. */
struct memory_slot {
    SluiceTile tile;
    SluiceTileState state;
    uint32_t texture; ///< index
    uint32_t loads;
    double age; ///< seconds since it was loaded; below 0: unknown
};

struct memory_sums {
    uint32_t heaps, used; ///< slots with a tile
    uint32_t spare_heaps; ///< that compaction could free
    double fragmentation; ///< spare heaps over heaps, 0 to 1
};

/** How a slot is drawn. */
struct memory_shown {
    uint32_t color;   ///< 0: the slot is free
    uint32_t texture; ///< STAGE_NO_TEXTURE: none
};

/** Slots as they were a moment ago. */
struct memory_map {
    struct memory_shown *slots; ///< owned; stage_heap_tiles per heap
    double *next;               ///< owned; by heap: seconds when it is looked at again
    uint32_t heap_count;
    enum memory_colors by;
};

/** Returns the slots of a heap, which it looks at 10 times per second, or at once for other colors;
 * a recording in each frame. NULL without memory. `seconds`: of the viewer's life. */
const struct memory_shown *memory_map_heap(struct memory_map *map, const struct stage *stage,
                                           const struct view_facts *facts, uint32_t heap,
                                           enum memory_colors by, double seconds);
/** A zeroed struct is fine. */
void memory_map_finish(struct memory_map *map);
/** False if the slot is free, or its texture is none of the scene. */
bool memory_slot_get(const struct stage *stage, const struct view_facts *facts, uint32_t heap,
                     uint32_t slot, struct memory_slot *to);
uint32_t memory_slot_color(const struct stage *stage, const struct memory_slot *slot,
                           enum memory_colors colors);
uint32_t memory_state_color(SluiceTileState state);
/** As view 5 has it. */
uint32_t memory_age_color(double seconds);
/** As view 6 has it: textures of a set share a hue, and those that follow are darker. */
uint32_t memory_texture_color(const struct stage *stage, uint32_t texture);
/** Sums over all heaps of the stage's manager. */
struct memory_sums memory_sums_of(const struct stage *stage);

struct view_app;
/** Moves at most 64 tiles together, and says how many. */
void memory_compact(struct view_app *app);
/** Evicts all standby tiles, and says how many there were. */
void memory_trim(struct view_app *app);

#endif /* SLUICE_VIEW_MEMORY_MAP_H */
