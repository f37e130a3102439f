/** Figures over the frames of a run, for --json. */
#ifndef SLUICE_VIEW_SUMMARY_H
#define SLUICE_VIEW_SUMMARY_H

#include "facts.h"

#define SUMMARY_FRAMES 3600u

struct summary {
    uint64_t frame_count;
    double missing; ///< percent, summed
    float missing_of[SUMMARY_FRAMES], gpu_of[SUMMARY_FRAMES], host_of[SUMMARY_FRAMES]; ///< rings
    float peak; ///< MB resident
};

/** Adds the latest frame of the facts. */
void summary_add(struct summary *summary, const struct view_facts *facts);
/** Prints one figure per line, under the names of sluice-tradeoff. Sorts the rings. */
void view_summary_print(struct summary *summary, const struct view_facts *facts);

#endif /* SLUICE_VIEW_SUMMARY_H */
