/** Common part of calls that hand out a list of tiles: checks, and the observer's record. */
#ifndef SLC_CORE_LIST_CALL_H
#define SLC_CORE_LIST_CALL_H

#include "core/state.h"

struct slc_list_call {
    const char *function; ///< name of the public function, for messages
    enum slc_call_kind kind;
    SluiceTextureId texture_id;
    uint64_t retire_value;
    uint32_t *count;   ///< Room on entry, tiles on return. NULL: the call is refused.
    SluiceTile *tiles; ///< NULL: only counts.
};

/** `scope` is the texture of the call. NULL: all textures. */
typedef SluiceResult slc_list_function(slc_manager *m, struct slc_managed_texture *scope,
                                       const struct slc_list_call *call);

/** Checks, calls `get` and notifies the observer. */
SluiceResult slc_list_call_make(slc_manager *m, const struct slc_list_call *call,
                                slc_list_function *get);

#endif /* SLC_CORE_LIST_CALL_H */
