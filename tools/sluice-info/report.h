/** What was found out, for people and for programs, on standard output. */
#ifndef TOOLS_SLUICE_INFO_REPORT_H
#define TOOLS_SLUICE_INFO_REPORT_H

#include "devices.h"

#include <stdio.h>

/** `follows`: another one came before. */
void print_table(const struct device_report *report, bool follows);

/** The device without its formats. */
void print_limits(FILE *out, const struct device_report *report);

/** One line. */
void print_json(const struct device_report *report);

/** Only the formats: a row for each, a column for each mode and for demand loading. */
void print_formats(const struct device_report *report, bool follows);

/** The table of print_formats as one line. */
void print_formats_json(const struct device_report *report);

#endif /* TOOLS_SLUICE_INFO_REPORT_H */
