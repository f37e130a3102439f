/** Requests of a texture's maps, region by region. */
#ifndef SLC_CORE_HISTORY_H
#define SLC_CORE_HISTORY_H

#include "core/state.h"

static inline size_t slc_region_count(const struct slc_managed_texture *t)
{
    return t->shape->region_count;
}

/** True if the texture's last map requests the tile. True for packed tiles. */
bool slc_is_asked_for(const slc_manager *m, uint32_t node);
/** True if the last map requests a regular tile or a neighbor: chance rarely hides all of them. */
bool slc_is_seen(const slc_manager *m, uint32_t node);

/** Destroys the state if the texture has no requests and no nodes of regular tiles. */
void slc_state_release(slc_manager *m, struct slc_managed_texture *t);
void slc_state_destroy(slc_manager *m, struct slc_managed_texture *t);

/** Makes the per-tile memory unless it exists. */
SluiceResult slc_state_make(slc_manager *m, struct slc_managed_texture *t);
/**
 * Makes state and history unless they exist, and room for one more span. A history whose number of
 * users is not `users` is copied: the texture then has a history of its own.
 */
SluiceResult slc_history_make(slc_manager *m, struct slc_managed_texture *t, uint32_t users);
/** Shares `history`. The texture must have a state without history, and an equal shape. */
void slc_history_share(struct slc_managed_texture *t, struct slc_history *history);
/** Drops the texture's history: it is empty afterwards. */
void slc_history_drop(slc_manager *m, struct slc_managed_texture *t);

/** Range [first, end) of indices. */
struct slc_range {
    uint32_t first, end; ///< end 0: empty
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
 * Merges history->next into the history and counts the regions with a request. Returns the range of
 * regions, whole blocks, in which history->least has changed.
 */
struct slc_range slc_history_merge(const slc_manager *m, struct slc_managed_texture *t,
                                   uint64_t time, uint64_t timeout);

#endif /* SLC_CORE_HISTORY_H */
