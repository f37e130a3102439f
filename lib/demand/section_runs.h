/** Runs of free sections. Finds the first run that is long enough, in logarithmic time. */
#ifndef SLC_DEMAND_SECTION_RUNS_H
#define SLC_DEMAND_SECTION_RUNS_H

#include <sluice/base.h>

struct slc_section_runs {
    /** Owned. [leaf_count + s]: length of the free run that begins at section s, else 0. Inner
     * nodes of the tree have the longest run below. */
    uint32_t *longest;
    uint32_t *begin; ///< owned, [count]: begin of the free run that ends here; else outdated
    uint32_t count, leaf_count;
};

/** Makes `count` > 0 free sections. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_section_runs_init(struct slc_section_runs *runs,
                                   const SluiceAllocationCallbacks *cb, uint32_t count);
void slc_section_runs_finish(struct slc_section_runs *runs, const SluiceAllocationCallbacks *cb);

/** Takes the lowest `count` consecutive free sections. False if there are none. */
bool slc_section_runs_take(struct slc_section_runs *runs, uint32_t count, uint32_t *first);
/** Frees sections that were taken. They join the free sections beside them. */
void slc_section_runs_give(struct slc_section_runs *runs, uint32_t first, uint32_t count);

#endif /* SLC_DEMAND_SECTION_RUNS_H */
