/** Memory of nodes. */
#ifndef SLC_RESIDENCY_NODES_H
#define SLC_RESIDENCY_NODES_H

#include "residency/machine.h"

/** Frees all nodes. */
void slc_nodes_finish(struct slc_machine *r);
/** Makes sure that `count` nodes can be taken. */
bool slc_reserve_nodes(struct slc_machine *r, uint64_t count);
/** One that was reserved. */
uint32_t slc_nodes_take(struct slc_machine *r);
void slc_nodes_give(struct slc_machine *r, uint32_t node);

#endif /* SLC_RESIDENCY_NODES_H */
