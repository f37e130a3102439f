/** Command line of sluice-replay. */
#ifndef TOOLS_SLUICE_REPLAY_OPTIONS_H
#define TOOLS_SLUICE_REPLAY_OPTIONS_H

#include "../common/option_table.h"

struct options {
    const char *trace;
    const char *expect; ///< NULL: do not compare
    const char *record; ///< NULL: do not record
    bool dump, json;
    uint32_t heap_tiles, max_heaps, standby, tiles_per_frame, latency;
    double timeout;  ///< seconds
    uint64_t memory; ///< bytes
};

/** Prints the help text on request. Reports errors on stderr. */
enum option_outcome parse_options(struct options *options, int argc, char **argv);

#endif /* TOOLS_SLUICE_REPLAY_OPTIONS_H */
