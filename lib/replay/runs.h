/** Run-length code of feedback maps. */
#ifndef SLC_REPLAY_RUNS_H
#define SLC_REPLAY_RUNS_H

#include "replay/byte_buffer.h"

/**
 * Appends `size` bytes of `map` as runs and literals: a varint c, and then for even c one byte that
 * stands c / 2 + 1 times, for odd c as many bytes as they are. Never much longer than the map.
 */
void slc_put_runs(struct slc_bytes *bytes, const uint8_t *map, size_t size);

/** Appends the size of the runs in bytes, a varint, and the runs. */
void slc_put_map(struct slc_bytes *bytes, const uint8_t *map, size_t size);

/**
 * Reads runs up to the cursor's end, which must yield exactly `size` bytes. With `map` NULL they
 * are only checked.
 */
void slc_get_runs(struct slc_cursor *cursor, uint8_t *map, size_t size);

/** The same for (varint run, u8 value) pairs as SLTRACE1 has them; a run of 0 is allowed. */
void slc_get_run_pairs(struct slc_cursor *cursor, uint8_t *map, size_t size);

#endif /* SLC_REPLAY_RUNS_H */
