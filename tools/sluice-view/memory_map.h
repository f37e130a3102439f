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

#endif /* SLUICE_VIEW_MEMORY_MAP_H */
