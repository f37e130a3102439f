/** Hash of a manager's decisions. docs/replay.md defines the hashed bytes. */
#ifndef SLC_REPLAY_DECISIONS_H
#define SLC_REPLAY_DECISIONS_H

#include "core/observer.h"
#include "replay/hash.h"

/** Tells whether the call returns a list: GET_... and DEFRAGMENT. */
bool slc_call_lists(enum slc_call_kind kind);
/** Tells whether the call has written entries of its list. */
bool slc_call_has_entries(const struct slc_call *call);

/**
 * Extends `hash` by the outputs of one call, including MinMip texels of its rectangles. Call it
 * right after the call, because the texels are read from the manager.
 */
uint64_t slc_hash_decisions(uint64_t hash, const SluiceStreamedTextureManager *manager,
                            const struct slc_call *call);

/** Calls `visit` for pieces of a rectangle's texels, row by row. */
SluiceResult slc_visit_minmip(const SluiceStreamedTextureManager *manager,
                              const SluiceMinMipRect *rect,
                              void (*visit)(void *user, const uint8_t *texels, size_t count),
                              void *user);

#endif /* SLC_REPLAY_DECISIONS_H */
