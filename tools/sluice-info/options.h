/** The command line of sluice-info. */
#ifndef TOOLS_SLUICE_INFO_OPTIONS_H
#define TOOLS_SLUICE_INFO_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

struct options {
    char **files; ///< of argv
    int file_count;
    const char *png; ///< NULL: no picture is written
    uint32_t level;
    bool has_tile; ///< a tile of it, or all of it
    uint32_t tile_x, tile_y;
    uint64_t memory;        ///< bytes that a picture and the reading of its file may take
    const char *device;     ///< number or a part of the name; NULL: all
    uint32_t width, height; ///< of the image whose layout is shown
    bool list, json, help;
};

/** Moves file names to the front of argv. On failure says on standard error what is wrong. */
bool parse_options(struct options *options, int argc, char **argv);

void print_help(void);

#endif /* TOOLS_SLUICE_INFO_OPTIONS_H */
