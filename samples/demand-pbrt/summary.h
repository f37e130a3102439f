/** Figures of a run. */
#ifndef DEMAND_PBRT_SUMMARY_H
#define DEMAND_PBRT_SUMMARY_H

#include "device.h"

struct figure {
    const char *name, *unit;
    double value; ///< NAN: absent
};

struct summary {
    const struct device *devices;
    uint32_t device_count;
    double start;       ///< clock_seconds() at the program's start
    double trace_start; ///< clock_seconds() at the first launch
};

/** Prints a figure, as JSON or for people. */
void summary_print_figure(const struct figure *figure, bool json);
/** Prints a line per figure: combined over all devices, then per device if there are several.
 * Reports errors on stderr. */
bool summary_print(const struct summary *summary, bool json);

#endif /* DEMAND_PBRT_SUMMARY_H */
