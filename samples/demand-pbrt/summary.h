/** Figures of a run. */
#ifndef DEMAND_PBRT_SUMMARY_H
#define DEMAND_PBRT_SUMMARY_H

#include "launches.h"

struct figure {
    const char *name, *unit;
    double value;
};

struct summary {
    const struct launches *launches;
    double complete_seconds; ///< from the beginning of the program to the complete picture
};

/** Prints a figure, as JSON or for people. */
void summary_print_figure(const struct figure *figure, bool json);
/** Prints a line for each figure. */
bool summary_print(const struct summary *summary, bool json);

#endif /* DEMAND_PBRT_SUMMARY_H */
