/** What is said at the end. */
#ifndef TRACER_SUMMARY_H
#define TRACER_SUMMARY_H

#include "launches.h"

struct summary {
    const struct launches *launches;
    SluiceDemandStatistics statistics;
    double seconds;                       ///< of all launches
    struct picture_difference difference; ///< NANs: nothing was compared
    double needed_tiles;                  ///< NAN: not counted
    uint64_t resident_peak;               ///< tiles after a launch
};

/** A line for each figure on stdout, or a line of JSON. */
void summary_print(const struct summary *summary, bool json);

#endif /* TRACER_SUMMARY_H */
