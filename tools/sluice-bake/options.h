/** The command line of sluice-bake. */
#ifndef TOOLS_SLUICE_BAKE_OPTIONS_H
#define TOOLS_SLUICE_BAKE_OPTIONS_H

#include "../common/option_table.h"

#include <sluice/bake.h>

struct options {
    struct option_list inputs;
    const char *output;
    SluiceBakeSettings settings;
    uint64_t memory;  ///< bytes
    uint32_t threads; ///< 0: all processors
    bool force, verify, json;
    bool cube, array; ///< the inputs become layers of one store
};

/** Prints the help text if it was asked for. On failure says on standard error what is wrong. */
enum option_outcome parse_options(struct options *options, int argc, char **argv);

#endif /* TOOLS_SLUICE_BAKE_OPTIONS_H */
