/** Figures of a run. */
#ifndef DEMAND_PBRT_SUMMARY_H
#define DEMAND_PBRT_SUMMARY_H

#include "device.h"

struct figure {
    const char *name, *unit;
    double value; ///< NAN: not there
};

struct summary {
    const struct device *devices;
    uint32_t device_count;
    double start;       ///< of the program
    double trace_start; ///< of the first launch
};

/** Prints a figure, as JSON or for people. */
void summary_print_figure(const struct figure *figure, bool json);
/** Prints a line for each figure: sums of all devices, then, if they are several, each device. Says
 *  on stderr why it failed. */
bool summary_print(const struct summary *summary, bool json);

#endif /* DEMAND_PBRT_SUMMARY_H */
