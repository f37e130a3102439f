/** Invariants of the manager, for tests: slow, looks at everything. */
#ifndef SLC_CORE_CHECK_H
#define SLC_CORE_CHECK_H

#include <sluice/manager.h>

/** NULL if all is well, else what is wrong. */
const char *slc_manager_check(const SluiceStreamedTextureManager *manager);
/**
 * The invariants that a snapshot could break. Leaves out which textures share a history: finding
 * them takes time that is quadratic in the textures.
 */
const char *slc_manager_check_restored(const SluiceStreamedTextureManager *manager);

#endif /* SLC_CORE_CHECK_H */
