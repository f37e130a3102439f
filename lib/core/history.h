/** What the maps of a texture asked for, region by region. */
#ifndef SLC_CORE_HISTORY_H
#define SLC_CORE_HISTORY_H

#include "core/state.h"

static inline size_t slc_region_count(const struct slc_managed_texture *t)
{
    return t->shape->region_count;
}

/** Whether the texture's last map asks for the tile; packed tiles always are. */
bool slc_is_asked_for(const slc_manager *m, uint32_t node);
/** Whether the last map asks for a regular tile or a neighbor: chance rarely hides all of them. */
bool slc_is_seen(const slc_manager *m, uint32_t node);

/** Destroys the state if it says no more than none does. */
void slc_state_release(slc_manager *m, struct slc_managed_texture *t);
void slc_state_destroy(slc_manager *m, struct slc_managed_texture *t);

/** Makes the per-tile memory if it is not there yet. */
SluiceResult slc_state_make(slc_manager *m, struct slc_managed_texture *t);
/**
 * Makes state and history if they are not there yet, and room for one more span; a history that has
 * not just so many users becomes a copy of the texture's own.
 */
SluiceResult slc_history_make(slc_manager *m, struct slc_managed_texture *t, uint32_t users);
/** The texture has a state without history, and the other one's shape. */
void slc_history_share(struct slc_managed_texture *t, struct slc_history *history);
/** Leaves the texture with an empty one. */
void slc_history_drop(slc_manager *m, struct slc_managed_texture *t);

/** Of something counted from 0. */
struct slc_range {
    uint32_t first, end; ///< end 0: none
};

static inline void slc_range_add(struct slc_range *r, uint32_t first, uint32_t end)
{
    if (end == 0)
        return;
    if (r->end == 0 || first < r->first)
        r->first = first;
    if (end > r->end)
        r->end = end;
}

/**
 * Merges history->next into the history and counts the regions that hold something. Returns the
 * range of regions, whole blocks, in which history->least has changed.
 */
struct slc_range slc_history_merge(const slc_manager *m, struct slc_managed_texture *t,
                                   uint64_t time, uint64_t timeout);

#endif /* SLC_CORE_HISTORY_H */
