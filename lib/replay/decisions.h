/** The hash over what a manager decided; docs/replay.md defines it byte by byte. */
#ifndef SLC_REPLAY_DECISIONS_H
#define SLC_REPLAY_DECISIONS_H

#include "core/observer.h"
#include "replay/hash.h"

/** Whether the call answers with a list: GET_... and DEFRAGMENT. */
bool slc_call_lists(enum slc_call_kind kind);
/** Whether it has written entries of that list. */
bool slc_call_has_entries(const struct slc_call *call);

/**
 * Goes on with `hash` over the outputs of one call, MinMip texels of the rectangles it handed out
 * included: those are read from the manager, so this comes right after the call.
 */
uint64_t slc_hash_decisions(uint64_t hash, const SluiceStreamedTextureManager *manager,
                            const struct slc_call *call);

/** Hands the texels of a rectangle, row by row, to `visit` in pieces. */
SluiceResult slc_visit_minmip(const SluiceStreamedTextureManager *manager,
                              const SluiceMinMipRect *rect,
                              void (*visit)(void *user, const uint8_t *texels, size_t count),
                              void *user);

#endif /* SLC_REPLAY_DECISIONS_H */
