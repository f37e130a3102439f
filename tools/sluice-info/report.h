/** Prints device reports on stdout, as tables or as JSON. */
#ifndef TOOLS_SLUICE_INFO_REPORT_H
#define TOOLS_SLUICE_INFO_REPORT_H

#include "devices.h"

#include <stdio.h>

/** Prints a table. `follows`: true after another table. */
void print_table(const struct device_report *report, bool follows);

/** Prints the device without its formats. */
void print_limits(FILE *out, const struct device_report *report);

/** Prints one line of JSON. */
void print_json(const struct device_report *report);

/** Prints only the formats: a row per format, a column per mode and for demand loading. */
void print_formats(const struct device_report *report, bool follows);

/** Prints the table of print_formats as one line of JSON. */
void print_formats_json(const struct device_report *report);

#endif /* TOOLS_SLUICE_INFO_REPORT_H */
