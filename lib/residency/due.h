/** FAILED tiles; `order` is when they are due. */
#ifndef SLC_RESIDENCY_DUE_H
#define SLC_RESIDENCY_DUE_H

#include "residency/machine.h"

void slc_due_insert(struct slc_machine *r, uint32_t node);
void slc_due_remove(struct slc_machine *r, uint32_t node);
/** The tile that is due first, and the one after a tile; 0: there is none. */
uint32_t slc_due_first(const struct slc_machine *r);
uint32_t slc_due_next(const struct slc_machine *r, uint32_t node);
/** NULL, or what is wrong. */
const char *slc_due_check(const struct slc_machine *r);

#endif /* SLC_RESIDENCY_DUE_H */
