/** The moves of a tile between states. */
#ifndef SLC_RESIDENCY_NODE_H
#define SLC_RESIDENCY_NODE_H

#include "residency/machine.h"

/** A FREE tile becomes REQUESTED. Takes a node, which was reserved. Returns the node. */
uint32_t slc_node_request(struct slc_machine *r, uint32_t owner, uint32_t tile, uint32_t level,
                          uint32_t need);
/** A FREE tile gets a node as if it had been handed out and then no longer wanted. */
uint32_t slc_node_prefetch(struct slc_machine *r, uint32_t owner, uint32_t tile, uint32_t level);
/** A STANDBY or CANCELED tile is wanted again. */
void slc_node_wanted(struct slc_machine *r, uint32_t node);
/** A tile is no longer wanted; REQUESTED, FAILED and GIVEN_UP ones become FREE. */
void slc_node_unwanted(struct slc_machine *r, uint32_t node);
/** A REQUESTED tile, which has got a slot, becomes ALLOCATED. */
void slc_node_handed_out(struct slc_machine *r, uint32_t node);
/** An ALLOCATED tile becomes MAPPED. */
void slc_node_mapped(struct slc_machine *r, uint32_t node);
/** Changes the state and moves the node to the end of that state's list. */
void slc_node_set_state(struct slc_machine *r, uint32_t node, SluiceTileState state);
/** REQUESTED again with need 0. */
void slc_node_request_again(struct slc_machine *r, uint32_t node);
/** Takes the node away from its tile, which becomes FREE. The slot must be gone. */
void slc_node_release(struct slc_machine *r, uint32_t node);
/** The tile becomes FREE, its slot retires (or is free at once). */
void slc_node_retire(struct slc_machine *r, uint32_t node, uint64_t retire_value);
/** The slot, if there is one, is free at once. */
void slc_node_free_slot(struct slc_machine *r, uint32_t node);
/** A slot that its tile has left retires; needs a reserved node. */
void slc_node_retire_slot(struct slc_machine *r, uint32_t heap, uint32_t slot,
                          uint64_t retire_value);
/** Frees the retiring slots whose value has completed. */
void slc_collect_retired(struct slc_machine *r);
/** The next retry is later the more often the tile has failed; then it is GIVEN_UP. */
void slc_node_fail(struct slc_machine *r, uint32_t node, uint64_t time);
/** Evicts a MAPPED tile though it is wanted. */
void slc_node_evict_wanted(struct slc_machine *r, uint32_t node);
/** An evicted tile that is wanted is unmapped and REQUESTED; false without memory. */
bool slc_node_unmap_wanted(struct slc_machine *r, uint32_t node, uint64_t retire_value);

/**
 * Makes a node as a snapshot has it, at the end of its list. Takes a node, which was reserved.
 * `cell` is where the owner keeps it; unused for retiring slots. Returns false if its slot is
 * taken: the machine can only be destroyed then.
 */
bool slc_node_restore(struct slc_machine *r, const struct slc_node *from, uint32_t *cell);

#endif /* SLC_RESIDENCY_NODE_H */
