/** Invariants of the manager, for tests: slow, looks at everything. */
#ifndef SLC_CORE_CHECK_H
#define SLC_CORE_CHECK_H

#include <sluice/manager.h>

/** NULL if all is well, else what is wrong. */
const char *slc_manager_check(const SluiceStreamedTextureManager *manager);

#endif /* SLC_CORE_CHECK_H */
