/** Nodes of pages: state and list links, with a map from page to node. A page without state has no
 *  node. */
#ifndef SLC_DEMAND_PAGE_NODES_H
#define SLC_DEMAND_PAGE_NODES_H

#include "base/map.h"
#include "demand/page_residency.h"

#define SLC_NO_NODE UINT32_MAX

enum slc_page_state {
    SLC_PAGE_ABSENT, ///< node kept for a change not yet taken, or because the page can be restored
    SLC_PAGE_LOADING,
    SLC_PAGE_RESIDENT,
    SLC_PAGE_REFUSED
};

/** Home: list that a node is in. */
enum slc_page_home {
    SLC_HOME_NONE,
    SLC_HOME_LRU,        ///< resident, in the order of last use; may be evicted
    SLC_HOME_UNSEEN,     ///< resident, but no launch has seen it yet
    SLC_HOME_RESTORABLE, ///< absent; can be restored to its place
    SLC_HOME_OVERFLOW    ///< refused for lack of memory
};

enum slc_page_link {
    SLC_LINK_HOME,
    SLC_LINK_CHANGED, ///< forward only
    SLC_PAGE_LINKS
};

struct slc_page_node {
    uint64_t value;        ///< RESIDENT
    uint64_t shown_value;  ///< value in the page table, for SLC_SHOW_RESIDENT
    uint64_t last_use;     ///< launch; orders the LRU list
    uint64_t touched;      ///< last launch that used or requested the page
    uint64_t visible_from; ///< UNSEEN: first launch that sees the page
    uint32_t page, place, lru;
    uint32_t next[SLC_PAGE_LINKS], previous; ///< `previous`: in the home list
    uint8_t state, home, shown, class_index, rank;
    bool pinned;
    bool dropped; ///< LOADING: forgotten meanwhile
    bool changed; ///< in the list of changes
};

struct slc_page_list {
    uint32_t head, tail;
    uint32_t count;
};

struct slc_page_nodes {
    struct slc_page_node *at; ///< owned, [capacity]; nodes below `end` are used or free
    uint32_t capacity, end, free, count;
    struct slc_map map; ///< page -> index
};

static inline struct slc_page_list slc_empty_page_list(void)
{
    return (struct slc_page_list){SLC_NO_NODE, SLC_NO_NODE, 0};
}

SluiceResult slc_page_nodes_init(struct slc_page_nodes *nodes, const SluiceAllocationCallbacks *cb);
void slc_page_nodes_finish(struct slc_page_nodes *nodes, const SluiceAllocationCallbacks *cb);

/** Reserves room for one more node. False, with nothing changed, without memory. Moves nodes. */
bool slc_page_nodes_reserve(struct slc_page_nodes *nodes, const SluiceAllocationCallbacks *cb);
/** Adds an absent node without a place, and returns its index. Needs room; the page has no node. */
uint32_t slc_page_nodes_add(struct slc_page_nodes *nodes, uint32_t page);
/** Removes a node that is in no list. */
void slc_page_nodes_remove(struct slc_page_nodes *nodes, uint32_t index);
/** For snapshots: leaves the next index free, without listing it. There must be room for it. */
void slc_page_nodes_restore_free(struct slc_page_nodes *nodes);
/** Lists a free index after the last one, `tail`; SLC_NO_NODE: as the first. False if it was listed
 *  before. */
bool slc_page_nodes_restore_order(struct slc_page_nodes *nodes, uint32_t index, uint32_t tail);
/** Finds the node of a page. SLC_NO_NODE if it has none. */
uint32_t slc_page_nodes_find(const struct slc_page_nodes *nodes, uint32_t page);

/** Appends a node to a list, which becomes its home. */
void slc_page_list_append(struct slc_page_nodes *nodes, struct slc_page_list *list, uint32_t index,
                          enum slc_page_home home);
void slc_page_list_remove(struct slc_page_nodes *nodes, struct slc_page_list *list, uint32_t index);

/**
 * Sorts a chain of nodes along `link` that ends with SLC_NO_NODE, and returns its head. Sorts
 * changes by page, home lists by rank, finest first, then by page. Faster for chains that are
 * partly sorted. Does not update `previous`.
 */
uint32_t slc_page_nodes_sort(struct slc_page_nodes *nodes, uint32_t head, enum slc_page_link link);

#endif /* SLC_DEMAND_PAGE_NODES_H */
