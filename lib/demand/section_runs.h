/** Runs of free sections: the first one that is long enough, in logarithmic time. */
#ifndef SLC_DEMAND_SECTION_RUNS_H
#define SLC_DEMAND_SECTION_RUNS_H

#include <sluice/base.h>

struct slc_section_runs {
    /** Owned. [leaf_count + s]: length of the free run that begins at section s, else 0; above it a
     *  tree of the longest. */
    uint32_t *longest;
    uint32_t *begin; ///< owned, [count]: where the free run begins that ends here; else old
    uint32_t count, leaf_count;
};

/** `count` > 0 free sections. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_section_runs_init(struct slc_section_runs *runs,
                                   const SluiceAllocationCallbacks *cb, uint32_t count);
void slc_section_runs_finish(struct slc_section_runs *runs, const SluiceAllocationCallbacks *cb);

/** The lowest `count` sections in a row that are free. False if there are none. */
bool slc_section_runs_take(struct slc_section_runs *runs, uint32_t count, uint32_t *first);
/** Sections that are not free; they join the free ones beside them. */
void slc_section_runs_give(struct slc_section_runs *runs, uint32_t first, uint32_t count);

#endif /* SLC_DEMAND_SECTION_RUNS_H */
