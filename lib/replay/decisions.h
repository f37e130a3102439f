/** The hash over what a manager decided; docs/replay.md defines it byte by byte. */
#ifndef SLC_REPLAY_DECISIONS_H
#define SLC_REPLAY_DECISIONS_H

#include "core/observer.h"

/** FNV-1a, 64 bits: the hash of nothing. */
#define SLC_HASH_EMPTY UINT64_C(0xCBF29CE484222325)

uint64_t slc_hash_bytes(uint64_t hash, const void *data, size_t size);
/** The value's 8 bytes, low one first. */
uint64_t slc_hash_u64(uint64_t hash, uint64_t value);

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
