/** The tiles that a map wants, counted texel by texel and by no rule that the manager uses. */
#ifndef TESTS_CORE_WANTED_TILES_H
#define TESTS_CORE_WANTED_TILES_H

#include "core/fixture.h"

/** What each region of a map asks for: a level of the chain, or SLUICE_MIP_UNTOUCHED. */
void asked_levels(const SluiceStreamedTextureDesc *desc, const SluiceFeedbackDesc *feedback,
                  uint8_t *asked);

/** One flag per tile. `desc` has its region sizes filled in; `asked` has one level per region. */
void wanted_tiles(const SluiceStreamedTextureDesc *desc, const uint8_t *asked, bool *wanted);

/**
 * What the regions of a follower ask for, given what those of its primary do: merged into
 * `to_asked`, the finer one stays. Both descriptions have their region sizes filled in.
 */
void follower_levels(const SluiceStreamedTextureDesc *from, const uint8_t *from_asked,
                     const SluiceStreamedTextureDesc *to, uint8_t *to_asked);

uint32_t region_count(const SluiceStreamedTextureDesc *desc);

/** For a texture of which nothing was ever handed out: REQUESTED where wanted, else FREE. */
void check_requested(const struct fixture *f, SluiceTextureId id, const bool *wanted, int line);

#endif /* TESTS_CORE_WANTED_TILES_H */
