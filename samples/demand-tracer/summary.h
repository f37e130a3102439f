/** What is said at the end. */
#ifndef TRACER_SUMMARY_H
#define TRACER_SUMMARY_H

#include "device.h"

struct summary {
    const struct device *devices;
    uint32_t device_count;
    const struct textures *textures;
    SluiceReadPool *pool;                 ///< NULL: there is none
    double start;                         ///< of the first launch, s
    struct picture_difference difference; ///< NANs: nothing was compared
    double needed_tiles;                  ///< of all devices; NAN: not counted
};

/** A line for each figure on stdout, or a line of JSON. Says on stderr why it failed. */
bool summary_print(const struct summary *summary, bool json);

#endif /* TRACER_SUMMARY_H */
