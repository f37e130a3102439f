/** Replay state, shared by the players of all kinds of traces. */
#ifndef SLC_REPLAY_REPLAY_H
#define SLC_REPLAY_REPLAY_H

#include "replay/byte_buffer.h"
#include "replay/demand_player.h"
#include "replay/player.h"

#include <sluice/replay.h>

struct slc_replay {
    const SluiceReplayInfo *info;
    SluiceReplayResult *out;
    SluiceAllocationCallbacks cb;
    struct slc_cursor in; ///< the trace
    struct slc_player player;
    bool playing; ///< the player exists
    struct slc_demand_player demand;
    bool playing_demand;      ///< the demand player exists
    uint32_t last_page;       ///< see slc_get_demand_record
    SluiceRecorder *recorder; ///< owned; NULL: do not record the run
};

/** Creates the player. */
SluiceResult slc_replay_start(struct slc_replay *replay,
                              const SluiceStreamedTextureManagerCreateInfo *info, bool scripted);
/** Begins to record the player, if requested. */
SluiceResult slc_replay_record(struct slc_replay *replay);

/** Logs and returns CORRUPT_DATA, with the offset in the result. */
SluiceResult slc_replay_corrupt(struct slc_replay *replay, uint64_t offset, const char *why);

/** Returns CORRUPT_DATA if the cursor has failed. */
SluiceResult slc_replay_check(struct slc_replay *replay, const struct slc_cursor *cursor);

/** Plays a "SLUICERT" recording, from its header on. */
SluiceResult slc_play_recording(struct slc_replay *replay);

/** Plays a "SLUICEDR" recording of demand loading. */
SluiceResult slc_play_demand_recording(struct slc_replay *replay);

/** Plays an "SLTRACE1" trace in a frame loop. */
SluiceResult slc_play_feedback_trace(struct slc_replay *replay);

#endif /* SLC_REPLAY_REPLAY_H */
