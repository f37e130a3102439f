/** The state of the page residency. Each file works on a part of it. */
#ifndef SLC_DEMAND_PAGE_STATE_H
#define SLC_DEMAND_PAGE_STATE_H

#include "demand/lod_bias.h"
#include "demand/page_calls.h"
#include "demand/page_nodes.h"

#define SLC_TILES 0u /* the class that the bias is about */
#define SLC_NO_LRU UINT32_MAX

/** Resident pages of one class and kind that may be evicted, the one used longest ago first. */
struct slc_page_lru {
    uint32_t class_index, kind;
    uint32_t next; ///< of the class
    struct slc_page_list pages;
    uint64_t sorted; ///< the launch whose pages, at the head, are in order of rank and page
};

struct slc_page_class {
    uint64_t limit;
    struct slc_page_memory memory;
    bool has_memory;
    uint32_t first_lru;
    uint64_t held;   ///< loading or resident: they count against the limit
    uint64_t pinned; ///< of these
    struct slc_page_list restorable;
    struct slc_residency_counts counts;
};

/** What the present launch did with tiles. */
struct slc_launch_use {
    uint64_t used, used_pinned; ///< seen by it
    uint64_t touched;           ///< not pinned, resident, used or requested
    uint64_t asked;             ///< not pinned, missing
    uint64_t pinned_waiting;    ///< pinned, without a place
    uint64_t requests;          ///< of all classes
    uint64_t loads;
    uint64_t turned_away; ///< of other classes: not resident, and no memory for them
    bool refused;
    uint64_t full_at; ///< held tiles when there was no place left for one, and none to evict
};

struct slc_demand_residency {
    SluiceAllocationCallbacks cb;
    struct slc_page_observer observer;
    bool used; ///< see slc_residency_is_used
    bool no_eviction, no_lod_bias;
    struct slc_page_nodes nodes;
    struct slc_page_class *classes; ///< owned
    uint32_t class_count;
    struct slc_page_lru *lrus; ///< owned
    uint32_t lru_count, lru_capacity;
    uint64_t launch, prepared; ///< whose requests come; the last that was told of
    struct slc_page_list unseen, overflow;
    uint32_t changed_head, changed_tail;
    bool changes_sorted, over_limit;  ///< over_limit: some class, perhaps
    struct slc_page_evicted *evicted; ///< owned ring, with room for `valued` more
    uint32_t evicted_capacity, evicted_begin, evicted_count;
    uint32_t valued; ///< pages without a place that are loading or resident
    struct slc_launch_use use;
    struct slc_demand_bias bias;
    uint64_t failed_loads; ///< of tiles, since the last launch was settled
    uint64_t refused_idle; ///< places without use when tiles were last refused
    uint64_t bias_from;    ///< the first launch with this bias, once it is known
    bool bias_shown;       ///< it is
};

static inline struct slc_page_node *slc_node(struct slc_demand_residency *r, uint32_t index)
{
    return &r->nodes.at[index];
}

static inline struct slc_page_class *slc_class_of(struct slc_demand_residency *r, uint32_t index)
{
    return &r->classes[r->nodes.at[index].class_index];
}

/** Tells the observer, which is there, of a use. Not in line: it would slow down uses without one.
 */
void slc_tell_use(const struct slc_demand_residency *r, uint32_t page);

/**
 * Tells the observer of a call, if there is one; the fields of the call follow. A macro, because
 * without an observer the call must not even be built: pages are used by the thousand.
 */
#define SLC_TELL_PAGES(r, ...)                                                                     \
    do {                                                                                           \
        if ((r)->observer.notify)                                                                  \
            (r)->observer.notify((r)->observer.user, &(struct slc_page_call){__VA_ARGS__});        \
    } while (0)

#endif /* SLC_DEMAND_PAGE_STATE_H */
