/** Maps of followers, computed from maps of their primaries. */
#ifndef SLC_CORE_FOLLOWER_H
#define SLC_CORE_FOLLOWER_H

#include "core/wants.h"

/** Prepares a merge for a follower, like slc_wants_prepare. `asked`: requested levels of the
 * primary's map, NULL for an empty map. */
SluiceResult slc_wants_prepare_follower(slc_manager *m, const struct slc_managed_texture *primary,
                                        const uint8_t *asked, struct slc_managed_texture *follower,
                                        struct slc_wants_need *need);

/** Returns the bytes of scratch for slc_wants_prepare_follower, padded. */
uint64_t slc_follower_scratch(const struct slc_managed_texture *primary,
                              const struct slc_managed_texture *follower);

/** True if tiles and regions of both textures are equal. */
bool slc_have_same_shape(const struct slc_managed_texture *a, const struct slc_managed_texture *b);

#endif /* SLC_CORE_FOLLOWER_H */
