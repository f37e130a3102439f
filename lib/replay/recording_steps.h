/** A "SLUICERT" recording, played call by call. */
#ifndef SLC_REPLAY_RECORDING_STEPS_H
#define SLC_REPLAY_RECORDING_STEPS_H

#include "replay/record.h"
#include "replay/replay.h"

/** Position in a recording. Stays where it is: `next` points into itself. */
struct slc_recording_steps {
    uint64_t checksum;  ///< over the trace up to replay->in
    size_t block_end;   ///< of the block that is being read
    bool begins_in_use; ///< a snapshot precedes the calls
    bool ended;         ///< the end mark was read
    bool has_next;
    struct slc_record next; ///< the call to play; its heap answers are in the player
    size_t offset;          ///< of that call's record
    size_t first_offset;    ///< of the first heap answer that belongs to it, or its own
};

/** Reads the header, makes the player and reads the snapshot. Errors: those of sluiceReplay. */
SluiceResult slc_recording_begin(struct slc_replay *replay, struct slc_recording_steps *steps);
/** Reads the next call, unless it was read or the end mark was. Errors: CORRUPT_DATA;
 *  OUT_OF_HOST_MEMORY. */
SluiceResult slc_recording_read(struct slc_replay *replay, struct slc_recording_steps *steps);
/** Plays the call that was read. Errors: CORRUPT_DATA; OUT_OF_HOST_MEMORY. */
SluiceResult slc_recording_play(struct slc_replay *replay, struct slc_recording_steps *steps);

#endif /* SLC_REPLAY_RECORDING_STEPS_H */
