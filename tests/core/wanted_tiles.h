/** Tiles that a map requests, computed texel by texel with rules of its own. */
#ifndef TESTS_CORE_WANTED_TILES_H
#define TESTS_CORE_WANTED_TILES_H

#include "core/fixture.h"

/** Computes the requested level of each region: a level of the chain, or SLUICE_MIP_UNTOUCHED. */
void asked_levels(const SluiceStreamedTextureDesc *desc, const SluiceFeedbackDesc *feedback,
                  uint8_t *asked);

/** Sets a flag per requested tile. `desc` must have its region sizes filled in. `asked`: a level
 * per region. */
void wanted_tiles(const SluiceStreamedTextureDesc *desc, const uint8_t *asked, bool *wanted);

/**
 * Merges requests of the primary's regions into those of the follower's, `to_asked`. The finer
 * level wins. Both descriptions must have their region sizes set.
 */
void follower_levels(const SluiceStreamedTextureDesc *from, const uint8_t *from_asked,
                     const SluiceStreamedTextureDesc *to, uint8_t *to_asked);

uint32_t region_count(const SluiceStreamedTextureDesc *desc);

/** Checks that wanted tiles are REQUESTED and others FREE, for a texture without any handed-out
 * tile. */
void check_requested(const struct fixture *f, SluiceTextureId id, const bool *wanted, int line);

#endif /* TESTS_CORE_WANTED_TILES_H */
