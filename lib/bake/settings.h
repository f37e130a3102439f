/** Hash of the settings that determine a store's texels. */
#ifndef SLC_BAKE_SETTINGS_H
#define SLC_BAKE_SETTINGS_H

#include <sluice/bake.h>

/** Part of every hash; raised when the same settings give other stores. */
#define SLC_BAKE_REVISION 5

/** Hash of all settings that determine the texels. */
uint64_t slc_hash_settings(const SluiceBakeSettings *settings);

#endif /* SLC_BAKE_SETTINGS_H */
