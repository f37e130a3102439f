/** Player of demand loading: owns a residency, makes calls on it, and hashes its decisions. */
#ifndef SLC_REPLAY_DEMAND_PLAYER_H
#define SLC_REPLAY_DEMAND_PLAYER_H

#include "base/snapshot_io.h"
#include "demand/page_observer.h"
#include "replay/dump.h"

#include <sluice/replay.h>

struct slc_demand_player {
    SluiceAllocationCallbacks cb;
    struct slc_demand_residency *residency; ///< owned
    struct slc_page_observer recorder;      ///< recorder of the played calls; zeroed: not recorded
    uint32_t class_count;
    uint64_t hash, event_count;
    uint64_t begun, prepared; ///< launches
    SluiceDemandReplayStatistics counts;
    struct slc_dump dump;

    struct slc_page_call *answers; ///< owned; answers of memory for the next request
    size_t answer_count, answer_capacity, answers_used;
    bool answers_differ; ///< requests to memory differ from the recorded ones

    void *entries; ///< owned; entries of the last list
    size_t entries_size;
};

/** Initializes; ignores `info->cb`. Do not finish after an error. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_demand_player_init(struct slc_demand_player *player,
                                    const SluiceAllocationCallbacks *cb,
                                    const struct slc_page_residency_create_info *info);
void slc_demand_player_finish(struct slc_demand_player *player);
/** Restores `player`, a struct slc_demand_player, from a snapshot, and dumps a line. */
void slc_demand_player_restore(void *player, struct slc_snapshot_io *io);
/** Begins to hash and dump played calls, and to notify the recorder of the residency. */
void slc_demand_player_begin(struct slc_demand_player *player);

/** Adds an answer of memory for the next request. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_demand_player_add_answer(struct slc_demand_player *player,
                                          const struct slc_page_call *answer);

/**
 * Makes a call with the inputs in `call`, and writes its outputs. Skips a request that was recorded
 * as OUT_OF_HOST_MEMORY, because such a request changed nothing. Errors: OUT_OF_HOST_MEMORY;
 * CORRUPT_DATA for a call that users of page_residency.h may not make, with the reason in `*why`.
 */
SluiceResult slc_demand_player_call(struct slc_demand_player *player, struct slc_page_call *call,
                                    const char **why);

/** Figures so far. */
void slc_demand_player_statistics(const struct slc_demand_player *player,
                                  SluiceDemandReplayStatistics *statistics);

#endif /* SLC_REPLAY_DEMAND_PLAYER_H */
