/** The command line of sluice-bake. */
#ifndef TOOLS_SLUICE_BAKE_OPTIONS_H
#define TOOLS_SLUICE_BAKE_OPTIONS_H

#include "../common/option_table.h"

#include <sluice/bake.h>

/** One of several shares of a plan. */
struct shard {
    uint32_t number, count; ///< from 1; 0 0: none
};

struct options {
    struct option_list inputs;
    const char *output;
    SluiceBakeSettings settings;
    uint64_t memory;  ///< bytes
    uint32_t threads; ///< 0: all processors
    bool force, verify, json;
    bool cube, array;   ///< the inputs become layers of one store
    const char *plan;   ///< file to write; NULL: none
    struct shard shard; ///< of the plan that is the input
    bool merge;         ///< the input is a plan, the output a catalogue
    bool neural;        ///< the inputs are compressed together
    bool mask, progress;
    int bits;    ///< index into 1.25, 2.5, 5, 10, 20 bits per texel
    double psnr; ///< dB to reach; 0: none
    uint32_t steps, batch, seed;
    const char *weights, *checkpoint, *device; ///< may be NULL
};

/** Prints the help text if it was asked for. On failure says on standard error what is wrong. */
enum option_outcome parse_options(struct options *options, int argc, char **argv);

#endif /* TOOLS_SLUICE_BAKE_OPTIONS_H */
