/** What is kept of a page, in lists and a map from ids: only of pages of which something is kept.
 */
#ifndef SLC_DEMAND_PAGE_NODES_H
#define SLC_DEMAND_PAGE_NODES_H

#include "base/map.h"
#include "demand/page_residency.h"

#define SLC_NO_NODE UINT32_MAX

enum slc_page_state {
    SLC_PAGE_ABSENT, ///< kept for a change not yet taken, or because it may be retaken
    SLC_PAGE_LOADING,
    SLC_PAGE_RESIDENT,
    SLC_PAGE_REFUSED
};

/** The list that a node is in. */
enum slc_page_home {
    SLC_HOME_NONE,
    SLC_HOME_LRU,        ///< resident, in the order of the last use: may be evicted
    SLC_HOME_UNSEEN,     ///< resident, but no launch has seen it yet
    SLC_HOME_RESTORABLE, ///< absent, its place may be retaken
    SLC_HOME_OVERFLOW    ///< refused for want of memory
};

enum slc_page_link {
    SLC_LINK_HOME,
    SLC_LINK_CHANGED, ///< forward only
    SLC_PAGE_LINKS
};

struct slc_page_node {
    uint64_t value;        ///< RESIDENT
    uint64_t shown_value;  ///< of SLC_SHOW_RESIDENT
    uint64_t last_use;     ///< launch; orders the LRU list
    uint64_t touched;      ///< the last launch that used it or asked for it
    uint64_t visible_from; ///< UNSEEN: the first launch that sees it
    uint32_t page, place, lru;
    uint32_t next[SLC_PAGE_LINKS], previous; ///< `previous` in its home
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
    struct slc_page_node *at; ///< owned, [capacity]; those below `end` are used or free
    uint32_t capacity, end, free, count;
    struct slc_map map; ///< page -> index
};

static inline struct slc_page_list slc_empty_page_list(void)
{
    return (struct slc_page_list){SLC_NO_NODE, SLC_NO_NODE, 0};
}

SluiceResult slc_page_nodes_init(struct slc_page_nodes *nodes, const SluiceAllocationCallbacks *cb);
void slc_page_nodes_finish(struct slc_page_nodes *nodes, const SluiceAllocationCallbacks *cb);

/** Room for one more. False without memory, with nothing changed. Pointers to nodes change. */
bool slc_page_nodes_reserve(struct slc_page_nodes *nodes, const SluiceAllocationCallbacks *cb);
/** There is room, and none of that page: an absent page without a place. Returns its index. */
uint32_t slc_page_nodes_add(struct slc_page_nodes *nodes, uint32_t page);
/** In no list. */
void slc_page_nodes_remove(struct slc_page_nodes *nodes, uint32_t index);
/** For snapshots: the next index, for which there is room, is free, but not in the list of these.
 */
void slc_page_nodes_restore_free(struct slc_page_nodes *nodes);
/** Lists a free index behind the last one, `tail`; SLC_NO_NODE: it is the first. False if it was
 *  listed before. */
bool slc_page_nodes_restore_order(struct slc_page_nodes *nodes, uint32_t index, uint32_t tail);
/** SLC_NO_NODE if nothing is kept of it. */
uint32_t slc_page_nodes_find(const struct slc_page_nodes *nodes, uint32_t page);

/** At the end of a list that is to be its home. */
void slc_page_list_append(struct slc_page_nodes *nodes, struct slc_page_list *list, uint32_t index,
                          enum slc_page_home home);
void slc_page_list_remove(struct slc_page_nodes *nodes, struct slc_page_list *list, uint32_t index);

/**
 * Sorts a chain of nodes along `link` that ends with SLC_NO_NODE: changes by page; in a home, the
 * finest rank first, then by page. Returns its head. As fast as the chain is in order already;
 * `previous` is not kept.
 */
uint32_t slc_page_nodes_sort(struct slc_page_nodes *nodes, uint32_t head, enum slc_page_link link);

#endif /* SLC_DEMAND_PAGE_NODES_H */
