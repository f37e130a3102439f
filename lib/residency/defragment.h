/** Emptying of the least used heaps, by moves or evictions. */
#ifndef SLC_RESIDENCY_DEFRAGMENT_H
#define SLC_RESIDENCY_DEFRAGMENT_H

#include "residency/machine.h"

struct slc_move_listener {
    void *user;
    /** Reports a moved node, which has its new slot. `heap_id` and `slot`: its old slot. */
    void (*moved)(void *user, const struct slc_node *node, uint32_t heap_id, uint32_t slot);
};

/**
 * Evicts at most `room` regular tiles of the least used heap that can be emptied: it has no packed
 * tile and no tile that is being loaded, and fuller heaps have room for its tiles.
 * Errors: OUT_OF_HOST_MEMORY, with nothing changed.
 */
SluiceResult slc_evacuate(struct slc_machine *r, uint32_t room);

/** Makes at most `room` moves. Errors: OUT_OF_HOST_MEMORY, with nothing changed. */
SluiceResult slc_defragment(struct slc_machine *r, uint64_t retire_value, uint32_t room,
                            const struct slc_move_listener *listener);

#endif /* SLC_RESIDENCY_DEFRAGMENT_H */
