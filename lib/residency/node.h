/** Changes of a tile's state. */
#ifndef SLC_RESIDENCY_NODE_H
#define SLC_RESIDENCY_NODE_H

#include "residency/machine.h"

/** Makes a FREE tile REQUESTED. Takes a reserved node, and returns it. */
uint32_t slc_node_request(struct slc_machine *r, uint32_t owner, uint32_t tile, uint32_t level,
                          uint32_t need);
/** Makes a FREE tile CANCELED, as if it had been handed out and then become unwanted. */
uint32_t slc_node_prefetch(struct slc_machine *r, uint32_t owner, uint32_t tile, uint32_t level);
/** Makes a STANDBY or CANCELED tile wanted again. */
void slc_node_wanted(struct slc_machine *r, uint32_t node);
/** Makes a tile unwanted. REQUESTED, FAILED and GIVEN_UP tiles become FREE. */
void slc_node_unwanted(struct slc_machine *r, uint32_t node);
/** Makes a REQUESTED tile with a slot ALLOCATED. */
void slc_node_handed_out(struct slc_machine *r, uint32_t node);
/** Makes an ALLOCATED tile MAPPED. */
void slc_node_mapped(struct slc_machine *r, uint32_t node);
/** Changes the state and moves the node to the end of that state's list. */
void slc_node_set_state(struct slc_machine *r, uint32_t node, SluiceTileState state);
/** Makes a FAILED or GIVEN_UP tile REQUESTED, with need 0. */
void slc_node_request_again(struct slc_machine *r, uint32_t node);
/** Makes a tile without a slot FREE, and frees its node. */
void slc_node_release(struct slc_machine *r, uint32_t node);
/** Makes a tile FREE. Its slot retires, or is free at once for a completed value. */
void slc_node_retire(struct slc_machine *r, uint32_t node, uint64_t retire_value);
/** Frees the slot of a node, if it has one, at once. */
void slc_node_free_slot(struct slc_machine *r, uint32_t node);
/** Retires a slot that its tile has left. Needs a reserved node. */
void slc_node_retire_slot(struct slc_machine *r, uint32_t heap, uint32_t slot,
                          uint64_t retire_value);
/** Frees the retiring slots whose value has completed. */
void slc_collect_retired(struct slc_machine *r);
/** Makes a tile FAILED, with a delay that doubles per failure; after too many failures GIVEN_UP. */
void slc_node_fail(struct slc_machine *r, uint32_t node, uint64_t time);
/** Evicts a wanted MAPPED tile. */
void slc_node_evict_wanted(struct slc_machine *r, uint32_t node);
/** Unmaps an evicted tile that is wanted, and makes it REQUESTED. False without memory. */
bool slc_node_unmap_wanted(struct slc_machine *r, uint32_t node, uint64_t retire_value);

/**
 * Restores a node of a snapshot at the end of its list. Takes a reserved node. `cell`: cell of the
 * owner for the node; unused for retiring slots. Returns false if the slot is taken: then the
 * machine can only be destroyed.
 */
bool slc_node_restore(struct slc_machine *r, const struct slc_node *from, uint32_t *cell);

#endif /* SLC_RESIDENCY_NODE_H */
