/** Reader for the frame of a recording: header, blocks with checksums, end mark. */
#ifndef SLC_REPLAY_TRACE_READER_H
#define SLC_REPLAY_TRACE_READER_H

#include "replay/recorder.h"
#include "replay/replay.h"

/**
 * Reads and checks the header. `words`: the words given to slc_recorder_write_header. Errors:
 * CORRUPT_DATA; UNSUPPORTED for versions other than 1 to `newest`.
 */
SluiceResult slc_read_trace_header(struct slc_replay *replay, uint32_t newest, uint32_t *version,
                                   uint64_t *checksum, uint32_t words[SLC_TRACE_WORDS]);

/**
 * Reads the head of a block and checks its checksum. Its records begin at replay->in and end at
 * `end`. Errors: CORRUPT_DATA.
 */
SluiceResult slc_read_block(struct slc_replay *replay, uint64_t *checksum, size_t *end);

/** Player of the records. */
struct slc_trace_player {
    /** Plays the checked records from replay->in up to `end`. Unused by slc_read_next_block. */
    SluiceResult (*play_block)(struct slc_replay *replay, size_t end);
    const uint64_t *hash, *event_count; ///< hash and number of the played calls
};
/**
 * Reads the head of the next block like slc_read_block, or the end mark: `*ended`. The end mark
 * must be the end of the trace. Errors: CORRUPT_DATA.
 */
SluiceResult slc_read_next_block(struct slc_replay *replay, uint64_t *checksum,
                                 const struct slc_trace_player *player, size_t *end, bool *ended);
/** Plays all blocks and reads the end mark. */
SluiceResult slc_play_blocks(struct slc_replay *replay, uint64_t checksum,
                             const struct slc_trace_player *player);

/** Records and logs the first call that differs from the recording. */
void slc_note_divergence(struct slc_replay *replay, uint64_t event, size_t offset,
                         const char *recorded, const char *got);

#endif /* SLC_REPLAY_TRACE_READER_H */
