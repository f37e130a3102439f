/** Figures printed at the end. */
#ifndef TRACER_SUMMARY_H
#define TRACER_SUMMARY_H

#include "device.h"

struct summary {
    const struct device *devices;
    uint32_t device_count;
    const struct textures *textures;
    SluiceReadPool *pool;                 ///< NULL: no shared pool
    double start;                         ///< clock_seconds() at the first launch
    struct picture_difference difference; ///< NANs: no reference
    double needed_tiles;                  ///< sum over all devices; NAN: not counted
};

/** Prints a line per figure, or a line of JSON, on stdout. Reports errors on stderr. */
bool summary_print(const struct summary *summary, bool json);

#endif /* TRACER_SUMMARY_H */
