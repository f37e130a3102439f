/** Requests in the order in which they are handed out: of one texture, or of all. */
#ifndef SLC_CORE_REQUEST_WALK_H
#define SLC_CORE_REQUEST_WALK_H

#include "core/state.h"

struct slc_request_key {
    uint32_t rank; ///< class and need, greater first
    uint32_t node;
    uint64_t order;
};

/** Requests that may be passed over in one call, so that a call's cost has a bound. */
enum { SLC_MAX_PASSED_OVER = 4096 };

/** The texture's requests in order. The caller frees `requested_count` keys. NULL without memory.
 */
struct slc_request_key *slc_sort_requests(const slc_manager *m,
                                          const struct slc_managed_texture *t);

/** Where the next request comes from: a texture's sorted keys, or the queues of all. */
struct slc_request_walk {
    const struct slc_request_key *keys;
    uint32_t at, count; ///< in keys; no keys: all textures
    uint32_t node;      ///< 0: the end
};

/** `keys` are those of the scope. No scope: all textures. */
struct slc_request_walk slc_walk_requests(const slc_manager *m,
                                          const struct slc_managed_texture *scope,
                                          const struct slc_request_key *keys);

/** To be called before the state of the walk's node changes. */
void slc_walk_on(const slc_manager *m, struct slc_request_walk *w);

#endif /* SLC_CORE_REQUEST_WALK_H */
