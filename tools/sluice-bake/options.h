/** The command line of sluice-bake. */
#ifndef TOOLS_SLUICE_BAKE_OPTIONS_H
#define TOOLS_SLUICE_BAKE_OPTIONS_H

#include <sluice/bake.h>

struct options {
    char **inputs; ///< of argv
    int input_count;
    const char *output;
    SluiceBakeSettings settings;
    uint64_t memory;  ///< bytes
    uint32_t threads; ///< 0: all processors
    bool force, verify, json, help;
};

/** Moves what is no option to the front of argv. On failure says on standard error what is wrong.
 */
bool parse_options(struct options *options, int argc, char **argv);

void print_help(void);

#endif /* TOOLS_SLUICE_BAKE_OPTIONS_H */
