/** A residency of demand loading of its own, the calls made on it, and the hash of its decisions.
 */
#ifndef SLC_REPLAY_DEMAND_PLAYER_H
#define SLC_REPLAY_DEMAND_PLAYER_H

#include "base/snapshot_io.h"
#include "demand/page_observer.h"
#include "replay/dump.h"

#include <sluice/replay.h>

struct slc_demand_player {
    SluiceAllocationCallbacks cb;
    struct slc_demand_residency *residency; ///< owned
    struct slc_page_observer recorder;      ///< of what is played; zeroed if it is not recorded
    uint32_t class_count;
    uint64_t hash, event_count;
    uint64_t begun, prepared; ///< launches
    SluiceDemandReplayStatistics counts;
    struct slc_dump dump;

    struct slc_page_call *answers; ///< owned; of memory, in the next request
    size_t answer_count, answer_capacity, answers_used;
    bool answers_differ; ///< memory was asked something else than when it was recorded

    void *entries; ///< owned; of the last list
    size_t entries_size;
};

/** `info->cb` is ignored. After an error there is nothing to finish. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_demand_player_init(struct slc_demand_player *player,
                                    const SluiceAllocationCallbacks *cb,
                                    const struct slc_page_residency_create_info *info);
void slc_demand_player_finish(struct slc_demand_player *player);
/** Gives the player, a struct slc_demand_player, the state of a snapshot, and dumps a line. */
void slc_demand_player_restore(void *player, struct slc_snapshot_io *io);
/** From here on all that is played is hashed and dumped, and told to who records the residency. */
void slc_demand_player_begin(struct slc_demand_player *player);

/** An answer of memory for the next request. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_demand_player_add_answer(struct slc_demand_player *player,
                                          const struct slc_page_call *answer);

/**
 * Makes a call with the inputs of `call`, and writes what came out. A request that was recorded as
 * failed for want of host memory changed nothing: it is not made. `*why` says what is wrong with a
 * call that no user of page_residency.h may make. Errors: OUT_OF_HOST_MEMORY; CORRUPT_DATA.
 */
SluiceResult slc_demand_player_call(struct slc_demand_player *player, struct slc_page_call *call,
                                    const char **why);

/** Figures so far. */
void slc_demand_player_statistics(const struct slc_demand_player *player,
                                  SluiceDemandReplayStatistics *statistics);

#endif /* SLC_REPLAY_DEMAND_PLAYER_H */
