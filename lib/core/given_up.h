/** GIVEN_UP tiles of each texture. */
#ifndef SLC_CORE_GIVEN_UP_H
#define SLC_CORE_GIVEN_UP_H

#include "core/state.h"

/** A node that has become GIVEN_UP, or is going to be something else. */
void slc_given_up_enter(slc_manager *m, uint32_t node);
void slc_given_up_leave(slc_manager *m, uint32_t node);

#endif /* SLC_CORE_GIVEN_UP_H */
