/** GIVEN_UP tiles of each texture. */
#ifndef SLC_CORE_GIVEN_UP_H
#define SLC_CORE_GIVEN_UP_H

#include "core/state.h"

/** Adds a node that has become GIVEN_UP to its texture's list, or removes it before it changes. */
void slc_given_up_enter(slc_manager *m, uint32_t node);
void slc_given_up_leave(slc_manager *m, uint32_t node);

#endif /* SLC_CORE_GIVEN_UP_H */
