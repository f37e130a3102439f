/**
 * STANDBY tiles, those unwanted longest first. Tiles without slots have a separate list, because
 * evicting them frees no slot.
 */
#ifndef SLC_RESIDENCY_STANDBY_H
#define SLC_RESIDENCY_STANDBY_H

#include "residency/machine.h"

static inline struct slc_list *slc_standby_list(struct slc_machine *r, const struct slc_node *node)
{
    return node->level == SLC_OUTSIDE_CLASS ? &r->standby_outside : &r->standby;
}

/** Lists a tile of one of the lists for unmapping. */
void slc_list_for_unmapping(struct slc_machine *r, uint32_t node);
/** Evicts the oldest tiles with slots until `keep` are left: lists them for unmapping. */
void slc_evict_standby(struct slc_machine *r, uint32_t keep);
/** Evicts the oldest tiles of both lists until each is within the limit. */
void slc_limit_standby(struct slc_machine *r);

#endif /* SLC_RESIDENCY_STANDBY_H */
