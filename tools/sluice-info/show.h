/** Commands of sluice-info, one function each. They report their errors on stderr. */
#ifndef TOOLS_SLUICE_INFO_SHOW_H
#define TOOLS_SLUICE_INFO_SHOW_H

#include "options.h"

/** Exit statuses. */
enum { ALL_SHOWN = 0, NOT_SHOWN = 1, WRONG_USAGE = 2 };

int show_devices(const struct options *options);

/** Runs the device tests on a device and reports each. */
int self_test(const struct options *options);

/** Writes a level or a tile of the file as PNG. */
int write_picture(const struct options *options);

#endif /* TOOLS_SLUICE_INFO_SHOW_H */
