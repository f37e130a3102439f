/** FAILED tiles by due time, which is in `order`. */
#ifndef SLC_RESIDENCY_DUE_H
#define SLC_RESIDENCY_DUE_H

#include "residency/machine.h"

void slc_due_insert(struct slc_machine *r, uint32_t node);
void slc_due_remove(struct slc_machine *r, uint32_t node);
/** Return the tile that is due first, and the tile due after another one; 0: there is none. */
uint32_t slc_due_first(const struct slc_machine *r);
uint32_t slc_due_next(const struct slc_machine *r, uint32_t node);
/** Returns NULL, or the broken invariant. */
const char *slc_due_check(const struct slc_machine *r);

#endif /* SLC_RESIDENCY_DUE_H */
