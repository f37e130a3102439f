/** Iterates over requests of one texture, or of all, in the order of hand-out. */
#ifndef SLC_CORE_REQUEST_WALK_H
#define SLC_CORE_REQUEST_WALK_H

#include "core/state.h"

struct slc_request_key {
    uint32_t rank; ///< class and need, greater first
    uint32_t node;
    uint64_t order;
};

/** Most requests that one call may skip. Bounds the cost of the call. */
enum { SLC_MAX_PASSED_OVER = 4096 };

/** Returns the texture's requests in order. The caller frees `requested_count` keys. NULL without
 * memory. */
struct slc_request_key *slc_sort_requests(const slc_manager *m,
                                          const struct slc_managed_texture *t);

/** Position of the next request: in a texture's sorted keys, or in the queues of all textures. */
struct slc_request_walk {
    const struct slc_request_key *keys;
    uint32_t at, count; ///< index in `keys`, and number of keys. No keys: all textures
    uint32_t node;      ///< node of the next request; 0: the end
};

/** Begins a walk. `keys`: sorted requests of `scope`. `scope` NULL: all textures. */
struct slc_request_walk slc_walk_requests(const slc_manager *m,
                                          const struct slc_managed_texture *scope,
                                          const struct slc_request_key *keys);

/** Moves on to the next request. Call it before the state of the walk's node changes. */
void slc_walk_on(const slc_manager *m, struct slc_request_walk *w);

#endif /* SLC_CORE_REQUEST_WALK_H */
