/** The command line of sluice-info. */
#ifndef TOOLS_SLUICE_INFO_OPTIONS_H
#define TOOLS_SLUICE_INFO_OPTIONS_H

#include "../common/option_table.h"

/** A tile of a level, by column and row. */
struct tile_choice {
    bool is_given; ///< False: the whole level.
    uint32_t x, y;
};

struct options {
    struct option_list files;
    const char *png; ///< NULL: write no picture
    uint32_t level;
    struct tile_choice tile;
    int32_t decode;     ///< mip of a neural set to decode; -1: none
    int weights;        ///< 0: INT8, 1: FP8
    const char *output; ///< path for decoded floats
    uint64_t memory;    ///< byte limit for a picture and the reading of its file
    const char *device; ///< index or part of the name; NULL: all
    uint32_t image[2];  ///< width and height of the image whose layout is printed
    bool list_devices, json;
    bool formats; ///< print only the formats, by residency mode
    bool self_test;
    const char *group;  ///< group of checks; NULL: all
    const char *report; ///< text file for the self-test's results; NULL: none
};

/** Parses the command line. Prints the help text for --help; reports errors on stderr. */
enum option_outcome parse_options(struct options *options, int argc, char **argv);

#endif /* TOOLS_SLUICE_INFO_OPTIONS_H */
