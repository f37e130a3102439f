/** Figures of a run. */
#ifndef DEMAND_PBRT_SUMMARY_H
#define DEMAND_PBRT_SUMMARY_H

#include "launches.h"

struct summary {
    const struct launches *launches;
    double complete_seconds; ///< from the beginning of the program to the complete picture
};

/** Prints a line for each figure, as JSON or for people. */
bool summary_print(const struct summary *summary, bool json);

#endif /* DEMAND_PBRT_SUMMARY_H */
