/**
 * How much blurrier all textures are sampled so that what a launch needs fits into memory: a LOD
 * bias in quarters of a level. Rises at once when a launch needs more than there are places; falls
 * when two launches in a row, more after failures, show that a finer bias fits, which it estimates
 * from what it saw of that bias before. So a view that does not change comes to rest.
 *
 * Integers alone: the same launches give the same biases on every machine.
 */
#ifndef SLC_DEMAND_LOD_BIAS_H
#define SLC_DEMAND_LOD_BIAS_H

#include <sluice/base.h>

#define SLC_MAX_BIAS_QUARTERS 96u /* 24 levels: nothing but tails */

struct slc_demand_bias {
    uint32_t quarters;
    uint32_t raises;        ///< one after the other
    uint32_t calm;          ///< launches in a row that miss little
    bool on_trial;          ///< it was lowered to this, not long ago
    uint32_t failed_trials; ///< one after the other: each doubles the time to the next
    bool settled;           ///< a launch with this bias missed little
    uint64_t loads;         ///< since then, but for those that failed
    struct {
        bool known;
        bool fails;           ///< it did not fit
        bool old;             ///< scaled so far that it is a guess
        uint32_t need, total; ///< in 256ths of pages, for launches like the last one; `total` with
                              ///< pinned pages
        uint32_t scale;       ///< how far these were scaled, in 65536ths
    } seen[SLC_MAX_BIAS_QUARTERS + 1];
};

/** What a launch did, in pages that compete for places. */
struct slc_demand_need {
    uint64_t room;         ///< places for pages that are not pinned
    uint64_t used;         ///< not pinned, resident
    uint64_t missing;      ///< not pinned, not resident
    uint64_t used_pinned;  ///< of them it is only known that they tell of the view
    uint64_t loads;        ///< reads that it caused
    uint64_t failed_loads; ///< reads that have failed since the last launch
    bool fails;            ///< there are fewer places than `room` after all
};

/** A launch that was sampled with the present bias is over. */
void slc_demand_bias_update(struct slc_demand_bias *bias, const struct slc_demand_need *need);

#endif /* SLC_DEMAND_LOD_BIAS_H */
