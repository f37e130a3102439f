/** The command line of sluice-info. */
#ifndef TOOLS_SLUICE_INFO_OPTIONS_H
#define TOOLS_SLUICE_INFO_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

struct options {
    const char *device;     ///< number or a part of the name; NULL: all
    uint32_t width, height; ///< of the image whose layout is shown
    bool list, json, help;
};

/** On failure says on standard error what is wrong. */
bool parse_options(struct options *options, int argc, char **argv);

void print_help(void);

#endif /* TOOLS_SLUICE_INFO_OPTIONS_H */
