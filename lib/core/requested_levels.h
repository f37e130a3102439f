/** Requested levels of tiles, and whether memory is too small to load them. */
#ifndef SLC_CORE_REQUESTED_LEVELS_H
#define SLC_CORE_REQUESTED_LEVELS_H

#include <sluice/manager.h>

/** Levels requested of a tile of level 0. SLUICE_MIP_UNTOUCHED: none. */
struct slc_requested_level {
    uint8_t held;  ///< level that decides: made coarser by the global mip bias
    uint8_t asked; ///< level before the bias
};

/** Returns the levels of a tile of level 0: (x, y) is its texel of the MinMip map. The texture must
 * exist. */
struct slc_requested_level slc_requested_level(const SluiceStreamedTextureManager *manager,
                                               SluiceTextureId id, uint32_t x, uint32_t y);

/** True if the last list of tiles to map ended early for lack of slots. */
bool slc_manager_lacks_slots(const SluiceStreamedTextureManager *manager);

#endif /* SLC_CORE_REQUESTED_LEVELS_H */
