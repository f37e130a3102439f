/** The maps of followers, from those of their primaries. */
#ifndef SLC_CORE_FOLLOWER_H
#define SLC_CORE_FOLLOWER_H

#include "core/wants.h"

/** As slc_wants_prepare, for a follower. `asked` is what the primary's map asks for, NULL for an
 * empty one. */
SluiceResult slc_wants_prepare_follower(slc_manager *m, const struct slc_managed_texture *primary,
                                        const uint8_t *asked, struct slc_managed_texture *follower,
                                        struct slc_wants_need *need);

/** Bytes of scratch for that, padded. */
uint64_t slc_follower_scratch(const struct slc_managed_texture *primary,
                              const struct slc_managed_texture *follower);

/** Same tiles, same regions. */
bool slc_have_same_shape(const struct slc_managed_texture *a, const struct slc_managed_texture *b);

#endif /* SLC_CORE_FOLLOWER_H */
