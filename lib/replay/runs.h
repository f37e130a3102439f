/** Run-length code of feedback maps. */
#ifndef SLC_REPLAY_RUNS_H
#define SLC_REPLAY_RUNS_H

#include "replay/byte_buffer.h"

/**
 * Appends `size` bytes of `map` as runs and literals. Each starts with a varint c. Even c: one byte
 * follows and is repeated c / 2 + 1 times. Odd c: c / 2 + 1 literal bytes follow. The code is at
 * most slightly longer than the map.
 */
void slc_put_runs(struct slc_bytes *bytes, const uint8_t *map, size_t size);

/** Appends the size of the runs in bytes, a varint, and the runs. */
void slc_put_map(struct slc_bytes *bytes, const uint8_t *map, size_t size);

/**
 * Reads runs up to the cursor's end, which must yield exactly `size` bytes. `map` NULL: only checks
 * the runs.
 */
void slc_get_runs(struct slc_cursor *cursor, uint8_t *map, size_t size);

/** Reads SLTRACE1's runs, (varint run, u8 value) pairs, like slc_get_runs. A run of 0 is allowed.
 */
void slc_get_run_pairs(struct slc_cursor *cursor, uint8_t *map, size_t size);

#endif /* SLC_REPLAY_RUNS_H */
