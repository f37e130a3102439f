/** Memory of nodes. */
#ifndef SLC_RESIDENCY_NODES_H
#define SLC_RESIDENCY_NODES_H

#include "residency/machine.h"

/** Frees all nodes. */
void slc_nodes_finish(struct slc_machine *r);
/** Reserves `count` nodes. False without memory. */
bool slc_reserve_nodes(struct slc_machine *r, uint64_t count);
/** Takes a reserved node. */
uint32_t slc_nodes_take(struct slc_machine *r);
void slc_nodes_give(struct slc_machine *r, uint32_t node);

#endif /* SLC_RESIDENCY_NODES_H */
