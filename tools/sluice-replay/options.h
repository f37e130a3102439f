/** The command line of sluice-replay. */
#ifndef TOOLS_SLUICE_REPLAY_OPTIONS_H
#define TOOLS_SLUICE_REPLAY_OPTIONS_H

#include "../common/option_table.h"

struct options {
    const char *trace;
    const char *expect; ///< NULL: nothing is compared
    const char *record; ///< NULL: nothing is recorded
    bool dump, json;
    uint32_t heap_tiles, max_heaps, standby, tiles_per_frame, latency;
    double timeout;  ///< seconds
    uint64_t memory; ///< bytes
};

/** Prints the help text if it was asked for. On failure says on standard error what is wrong. */
enum option_outcome parse_options(struct options *options, int argc, char **argv);

#endif /* TOOLS_SLUICE_REPLAY_OPTIONS_H */
