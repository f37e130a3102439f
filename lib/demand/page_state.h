/** State of the page residency. Each file works on a part of it. */
#ifndef SLC_DEMAND_PAGE_STATE_H
#define SLC_DEMAND_PAGE_STATE_H

#include "demand/lod_bias.h"
#include "demand/page_calls.h"
#include "demand/page_nodes.h"

#define SLC_TILES 0u /* class of tiles, whose need decides the bias */
#define SLC_NO_LRU UINT32_MAX

/** Resident pages of one class and kind that may be evicted, least recently used first. */
struct slc_page_lru {
    uint32_t class_index, kind;
    uint32_t next; ///< next list of the class
    struct slc_page_list pages;
    uint64_t sorted; ///< launch whose pages, at the head, are sorted by rank and page
};

struct slc_page_class {
    uint64_t limit;
    struct slc_page_memory memory;
    bool has_memory;
    uint32_t first_lru;
    uint64_t held;   ///< pages loading or resident, which count against the limit
    uint64_t pinned; ///< held pages that are pinned
    struct slc_page_list restorable;
    struct slc_residency_counts counts;
};

/** Uses and requests of the launch begun last. Tiles unless stated otherwise. */
struct slc_launch_use {
    uint64_t used, used_pinned; ///< resident tiles that the launch used: not pinned, and pinned
    uint64_t touched;           ///< resident tiles, not pinned, that were used or requested
    uint64_t asked;             ///< missing tiles, not pinned
    uint64_t pinned_waiting;    ///< pinned tiles without a place
    uint64_t requests;          ///< requests of all classes
    uint64_t loads;
    uint64_t turned_away; ///< requests of other classes for which there was no memory
    bool refused;
    uint64_t full_at; ///< held tiles when no place was free and no tile could be evicted
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
    uint64_t launch, prepared; ///< launches begun last and prepared last
    struct slc_page_list unseen, overflow;
    uint32_t changed_head, changed_tail;
    bool changes_sorted, over_limit;  ///< over_limit: some class may be over its limit
    struct slc_page_evicted *evicted; ///< owned ring; has room for `valued` more entries
    uint32_t evicted_capacity, evicted_begin, evicted_count;
    uint32_t valued; ///< pages without a place that are loading or resident
    struct slc_launch_use use;
    struct slc_demand_bias bias;
    uint64_t failed_loads; ///< failed loads of tiles since the last launch was settled
    uint64_t refused_idle; ///< idle places when tiles were last refused
    uint64_t bias_from;    ///< first launch with this bias; valid if bias_shown
    bool bias_shown;       ///< some launch has this bias
};

static inline struct slc_page_node *slc_node(struct slc_demand_residency *r, uint32_t index)
{
    return &r->nodes.at[index];
}

static inline struct slc_page_class *slc_class_of(struct slc_demand_residency *r, uint32_t index)
{
    return &r->classes[r->nodes.at[index].class_index];
}

/** Reports a use to the observer, which must exist. Not inline, to keep uses without one fast. */
void slc_tell_use(const struct slc_demand_residency *r, uint32_t page);

/**
 * Reports a call to the observer, if there is one. Arguments: fields of the call. A macro, so that
 * the call is not built without an observer: thousands of pages are used per launch.
 */
#define SLC_TELL_PAGES(r, ...)                                                                     \
    do {                                                                                           \
        if ((r)->observer.notify)                                                                  \
            (r)->observer.notify((r)->observer.user, &(struct slc_page_call){__VA_ARGS__});        \
    } while (0)

#endif /* SLC_DEMAND_PAGE_STATE_H */
