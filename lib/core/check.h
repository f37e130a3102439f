/** Checks of the manager's invariants, for tests. Slow: they look at everything. */
#ifndef SLC_CORE_CHECK_H
#define SLC_CORE_CHECK_H

#include <sluice/manager.h>

/** Returns NULL, or the broken invariant. */
const char *slc_manager_check(const SluiceStreamedTextureManager *manager);
/**
 * Checks the invariants that a snapshot could break. Does not check which textures share a history,
 * because that takes time quadratic in the number of textures.
 */
const char *slc_manager_check_restored(const SluiceStreamedTextureManager *manager);

#endif /* SLC_CORE_CHECK_H */
