/** The outside of a recording: its header, the checksums of its blocks, its end mark. */
#ifndef SLC_REPLAY_TRACE_READER_H
#define SLC_REPLAY_TRACE_READER_H

#include "replay/recorder.h"
#include "replay/replay.h"

/**
 * Reads and checks the header; `words` are those of slc_recorder_write_header. Errors:
 * CORRUPT_DATA; UNSUPPORTED if the recording has a version that is not 1 to `newest`.
 */
SluiceResult slc_read_trace_header(struct slc_replay *replay, uint32_t newest, uint32_t *version,
                                   uint64_t *checksum, uint32_t words[SLC_TRACE_WORDS]);

/**
 * Reads the head of a block and checks its checksum. Its records begin at replay->in and end at
 * `end`. Errors: CORRUPT_DATA.
 */
SluiceResult slc_read_block(struct slc_replay *replay, uint64_t *checksum, size_t *end);

/** Who plays the records. */
struct slc_trace_player {
    /** Plays the records from replay->in up to `end`, whose checksum is right. Unused by
     *  slc_read_next_block. */
    SluiceResult (*play_block)(struct slc_replay *replay, size_t end);
    const uint64_t *hash, *event_count; ///< over what was played so far
};
/**
 * Reads the head of the next block as slc_read_block does, or the end mark: `*ended`. Nothing may
 * follow the end mark. Errors: CORRUPT_DATA.
 */
SluiceResult slc_read_next_block(struct slc_replay *replay, uint64_t *checksum,
                                 const struct slc_trace_player *player, size_t *end, bool *ended);
/** Plays block after block, up to and with the end mark. */
SluiceResult slc_play_blocks(struct slc_replay *replay, uint64_t checksum,
                             const struct slc_trace_player *player);

/** Says which call was the first to differ from the recording. */
void slc_note_divergence(struct slc_replay *replay, uint64_t event, size_t offset,
                         const char *recorded, const char *got);

#endif /* SLC_REPLAY_TRACE_READER_H */
