/** The command line of sluice-replay. */
#ifndef TOOLS_SLUICE_REPLAY_OPTIONS_H
#define TOOLS_SLUICE_REPLAY_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

struct options {
    const char *trace;
    const char *expect; ///< NULL: nothing is compared
    const char *record; ///< NULL: nothing is recorded
    bool dump, json, help;
    uint32_t heap_tiles, max_heaps, standby, tiles_per_frame, latency;
    uint64_t timeout_micros;
    uint32_t memory_mib;
};

/** On failure says on standard error what is wrong. */
bool parse_options(struct options *options, int argc, char **argv);

void print_help(void);

#endif /* TOOLS_SLUICE_REPLAY_OPTIONS_H */
