/**
 * LOD bias of all textures, in quarters of a level, so that the pages of a launch fit into memory.
 * Rises at once when a launch needs more pages than there are places. Falls when two consecutive
 * launches, more after failures, show that a finer bias fits. The estimate uses statistics of that
 * bias from earlier launches. So a still view comes to rest.
 *
 * Uses integers only: equal launches give equal biases on every machine.
 */
#ifndef SLC_DEMAND_LOD_BIAS_H
#define SLC_DEMAND_LOD_BIAS_H

#include <sluice/base.h>

#define SLC_MAX_BIAS_QUARTERS 96u /* 24 levels: only tails are sampled */

struct slc_demand_bias {
    uint32_t quarters;
    uint32_t raises;        ///< consecutive raises
    uint32_t calm;          ///< consecutive launches that miss little
    bool on_trial;          ///< the bias was lowered to this value a short while ago
    uint32_t failed_trials; ///< consecutive failed trials; each doubles the time to the next
    bool settled;           ///< a launch with this bias missed little
    uint64_t loads;         ///< loads since `settled`, without failed ones
    struct {
        bool known;
        bool fails;           ///< the bias did not fit
        bool old;             ///< the values are scaled so far that they are guesses
        uint32_t need, total; ///< in 256ths of pages, for launches like the last one; `total` with
                              ///< pinned pages
        uint32_t scale;       ///< factor that need and total were scaled by, in 65536ths
    } seen[SLC_MAX_BIAS_QUARTERS + 1];
};

/** Pages of a launch that compete for places. */
struct slc_demand_need {
    uint64_t room;         ///< places for pages that are not pinned
    uint64_t used;         ///< not pinned, resident
    uint64_t missing;      ///< not pinned, not resident
    uint64_t used_pinned;  ///< pinned pages that were used; they only describe the view
    uint64_t loads;        ///< reads that the launch caused
    uint64_t failed_loads; ///< reads that have failed since the last launch
    bool fails;            ///< memory has fewer places than `room`
};

/** Updates the bias after a launch that sampled with the present bias. */
void slc_demand_bias_update(struct slc_demand_bias *bias, const struct slc_demand_need *need);

#endif /* SLC_DEMAND_LOD_BIAS_H */
