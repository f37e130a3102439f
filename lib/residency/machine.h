/**
 * The residency machine: tiles of owners and the slots of heaps that hold them. It keeps the state
 * of each tile, the order in which tiles are loaded and evicted, retries and retire values.
 *
 * It knows neither why a tile is wanted nor how residency is published. Its user sets wanted tiles,
 * and is notified when tiles become resident. The manager's owners are textures
 * (lib/core/texture_tiles.c).
 *
 * A tile that is not FREE has a node. docs/manager-specification.md has the states and the rules.
 */
#ifndef SLC_RESIDENCY_MACHINE_H
#define SLC_RESIDENCY_MACHINE_H

#include <sluice/manager.h>

#include "base/none.h"
#include "residency/tile_heap.h"

#include <assert.h>

enum slc_node_flags {
    SLC_NODE_LISTED = 1, ///< CANCELED: listed for the application; STANDBY: evicted
    SLC_NODE_WANTED = 2, ///< CANCELED and handed out: wanted again; STANDBY and evicted: wanted
};

/** State besides SluiceTileState: slot of an unmapped tile that the GPU may still read. */
#define SLC_NODE_RETIRING 255

/** Node: one per tile that is not FREE, and per retiring slot. Index 0 means none. */
struct slc_node {
    uint32_t owner;      ///< index of the tile's owner; SLC_NONE for retiring slots
    uint32_t tile;       ///< tile of the owner
    uint32_t prev, next; ///< neighbors in the list of the state
    uint32_t heap, slot; ///< index of the heap, or SLC_NONE without memory; slot in it
    uint32_t failures;
    uint8_t state;
    uint8_t level; ///< 0 is the finest; SLC_PACKED_CLASS, SLC_OUTSIDE_CLASS
    uint8_t need;  ///< log2 of the tiles of level 0 that request it, plus the owner's weight
    uint8_t flags;
    /** REQUESTED: sequence number; FAILED: due time; GIVEN_UP: for the user; retiring: value. */
    uint64_t order;
};

struct slc_list {
    uint32_t head, tail; ///< 0: empty
    uint32_t count;
};

#define SLC_REQUEST_CLASSES (SLUICE_MAX_MIP_LEVELS + 2) ///< one per level, two for packed tiles
/** Class of packed tiles: loaded before all levels, and not evicted while wanted. */
#define SLC_PACKED_CLASS SLUICE_MAX_MIP_LEVELS
/** Class of packed tiles without slots. Loaded first of all, because they never wait for a slot. */
#define SLC_OUTSIDE_CLASS (SLUICE_MAX_MIP_LEVELS + 1)
/** Values of `need`: a tile of level 0 to 20 is requested by 2^0 to 2^30 tiles of level 0. */
#define SLC_REQUEST_NEEDS 31

/** REQUESTED tiles by class and need. */
struct slc_requests {
    struct slc_list lists[SLC_REQUEST_CLASSES][SLC_REQUEST_NEEDS];
    uint32_t needs[SLC_REQUEST_CLASSES]; ///< bit n: lists[class][n] is not empty
    uint32_t counts[SLC_REQUEST_CLASSES];
    uint32_t classes; ///< bit c: needs[c] is not 0
    uint32_t count;
    uint64_t next_sequence;
};

/** FAILED tiles in order of due time. See due.c. */
struct slc_due_tree {
    uint32_t root; ///< 0: empty
    uint32_t count;
};

#define SLC_NODES_PER_CHUNK 1024
/** Limit of node indices, so that a cell with an index has a spare bit. */
#define SLC_MAX_NODES 0x80000000u

/** Callbacks within calls that change a node. */
struct slc_machine_user {
    void *user;
    /** A tile of the owner became REQUESTED, or is about to leave that state. */
    void (*requested)(void *user, uint32_t owner, bool now);
    /** The tile became resident (MAPPED or STANDBY), or ceased to be. */
    void (*resident)(void *user, const struct slc_node *node, bool now);
    /** The tile became GIVEN_UP, or is about to leave that state. */
    void (*given_up)(void *user, uint32_t node, bool now);
    /** The tile became FREE: it has no node any more. */
    void (*released)(void *user, const struct slc_node *node);
    /** The tile changed its state. May be NULL. */
    void (*changed)(void *user, const struct slc_node *node, uint8_t from, uint8_t to);
    /** Returns a value that is added to `need` of the owner's requests. NULL: 0 for all. */
    int32_t (*weight)(void *user, uint32_t owner);
};

struct slc_machine_limits {
    uint32_t standby; ///< most STANDBY tiles with slots, and most without; the oldest are evicted
    uint32_t load_attempts; ///< failures after which a tile is GIVEN_UP
    uint64_t retry_delay;   ///< delay after the first failure; doubles with each failure
};

struct slc_machine {
    const SluiceAllocationCallbacks *cb;
    struct slc_machine_user user;
    struct slc_machine_limits limits;

    struct slc_node **node_chunks; ///< owned, [node_chunk_room]; node 0 is unused
    uint32_t node_chunk_count, node_chunk_room;
    uint32_t node_end, free_node, free_node_count;
    uint32_t state_counts[8];   ///< nodes by SluiceTileState
    uint32_t outside_counts[8]; ///< by state, nodes that take no slots
    struct slc_requests requests;
    struct slc_list standby; ///< STANDBY tiles that take slots
    struct slc_list standby_outside, evicted, canceled, given_up, retiring;
    struct slc_due_tree failed;
    /** MAPPED tiles by level, oldest first. Packed tiles are in no list. */
    struct slc_list mapped[SLUICE_MAX_MIP_LEVELS];
    uint32_t evicted_wanted; ///< evicted tiles that are wanted

    struct slc_tile_heaps heaps;
    uint64_t completed_retire;
    uint64_t restored_total; ///< from STANDBY to MAPPED
    uint64_t steps;          ///< steps of searches, whose number tests limit
};

static inline bool slc_is_packed_class(uint32_t level)
{
    return level >= SLC_PACKED_CLASS;
}

/** Returns the tiles in a state that take slots. */
static inline uint32_t slc_count_with_slots(const struct slc_machine *r, SluiceTileState state)
{
    return r->state_counts[state] - r->outside_counts[state];
}

/** Returns the slots that become free without further evictions: evicted tiles and retiring slots.
 */
static inline uint64_t slc_coming_slots(const struct slc_machine *r)
{
    uint32_t evicted_outside =
        r->outside_counts[SLUICE_TILE_STATE_STANDBY] - r->standby_outside.count;
    return (uint64_t)r->evicted.count - evicted_outside + r->retiring.count;
}

static inline struct slc_node *slc_node_at(const struct slc_machine *r, uint32_t node)
{
    return &r->node_chunks[node / SLC_NODES_PER_CHUNK][node % SLC_NODES_PER_CHUNK];
}

#endif /* SLC_RESIDENCY_MACHINE_H */
