/** What all kinds of traces are played with. */
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
    bool playing; ///< the player is there
    struct slc_demand_player demand;
    bool playing_demand;      ///< that one is
    uint32_t last_page;       ///< see slc_get_demand_record
    SluiceRecorder *recorder; ///< owned; NULL unless the run is to be recorded
};

/** Makes the player. */
SluiceResult slc_replay_start(struct slc_replay *replay,
                              const SluiceStreamedTextureManagerCreateInfo *info, bool scripted);
/** Records the player from now on, if that was asked for. */
SluiceResult slc_replay_record(struct slc_replay *replay);

/** Logs and returns CORRUPT_DATA, with the offset in the result. */
SluiceResult slc_replay_corrupt(struct slc_replay *replay, uint64_t offset, const char *why);

/** CORRUPT_DATA if the cursor has failed. */
SluiceResult slc_replay_check(struct slc_replay *replay, const struct slc_cursor *cursor);

/** Plays a "SLUICERT" recording, from its header on. */
SluiceResult slc_play_recording(struct slc_replay *replay);

/** Plays a "SLUICEDR" recording of demand loading. */
SluiceResult slc_play_demand_recording(struct slc_replay *replay);

/** Plays an "SLTRACE1" trace in a frame loop. */
SluiceResult slc_play_feedback_trace(struct slc_replay *replay);

#endif /* SLC_REPLAY_REPLAY_H */
