/** Time stamps and retire values that callers give. */
#ifndef SLC_CORE_CLOCK_H
#define SLC_CORE_CLOCK_H

#include "core/state.h"

bool slc_time_is_backwards(const slc_manager *m, uint64_t time);
bool slc_retire_is_backwards(const slc_manager *m, uint64_t retire_value);
/** Moves the clock on and makes due retries REQUESTED. */
void slc_advance_time(slc_manager *m, uint64_t time);

#endif /* SLC_CORE_CLOCK_H */
