/** Stepwise player of a "SLUICERT" recording. */
#ifndef SLC_REPLAY_RECORDING_STEPS_H
#define SLC_REPLAY_RECORDING_STEPS_H

#include "replay/record.h"
#include "replay/replay.h"

/** Position in a recording. Must not move, because `next` points into itself. */
struct slc_recording_steps {
    uint64_t checksum;  ///< over the trace up to replay->in
    size_t block_end;   ///< end of the current block
    bool begins_in_use; ///< a snapshot precedes the calls
    bool ended;         ///< the end mark was read
    bool has_next;
    struct slc_record next; ///< the call to play; its heap answers are in the player
    size_t offset;          ///< offset of the record of `next`
    size_t first_offset;    ///< offset of its first heap answer; `offset` if there is none
};

/** Reads the header, creates the player and reads the snapshot. Errors: sluiceReplay's. */
SluiceResult slc_recording_begin(struct slc_replay *replay, struct slc_recording_steps *steps);
/** Reads the next call. Does nothing if a call is pending or the recording has ended. Errors:
 *  CORRUPT_DATA; OUT_OF_HOST_MEMORY. */
SluiceResult slc_recording_read(struct slc_replay *replay, struct slc_recording_steps *steps);
/** Plays the pending call. Errors: CORRUPT_DATA; OUT_OF_HOST_MEMORY. */
SluiceResult slc_recording_play(struct slc_replay *replay, struct slc_recording_steps *steps);

#endif /* SLC_REPLAY_RECORDING_STEPS_H */
