/** Says in the manager's log why an argument is refused. */
#ifndef SLC_CORE_REFUSAL_H
#define SLC_CORE_REFUSAL_H

#include "core/state.h"

/** Logs "FUNCTION: message". Returns INVALID_ARGUMENT. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
SluiceResult
slc_refuse(const slc_manager *m, const char *function, const char *format, ...);

/** Refuses a call that only the owner of a locked manager may make. */
SluiceResult slc_refuse_locked(const slc_manager *m, const char *function);

#endif /* SLC_CORE_REFUSAL_H */
