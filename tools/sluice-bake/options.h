/** The command line of sluice-bake. */
#ifndef TOOLS_SLUICE_BAKE_OPTIONS_H
#define TOOLS_SLUICE_BAKE_OPTIONS_H

#include "../common/option_table.h"

#include <sluice/bake.h>

/** A share of a plan. */
struct shard {
    uint32_t number, count; ///< from 1; 0 0: no shard
};

struct options {
    struct option_list inputs;
    const char *output;
    SluiceBakeSettings settings;
    uint64_t memory;  ///< bytes
    uint32_t threads; ///< 0: all processors
    bool force, verify, json;
    bool cube, array;   ///< true: the inputs become layers of one store
    const char *plan;   ///< file to write; NULL: none
    struct shard shard; ///< share of the input plan
    bool merge;         ///< true: the input is a plan, the output a catalogue
    bool neural;        ///< true: the inputs are compressed together
    bool mask, progress;
    int bits;    ///< index into 1.25, 2.5, 5, 10, 20 bits per texel
    double psnr; ///< target in dB; 0: none
    uint32_t steps, batch, seed;
    const char *weights, *checkpoint, *device; ///< may be NULL
};

/** Parses the command line. Prints the help text for --help; reports errors on stderr. */
enum option_outcome parse_options(struct options *options, int argc, char **argv);

#endif /* TOOLS_SLUICE_BAKE_OPTIONS_H */
