/** What was found out, for people and for programs, on standard output. */
#ifndef TOOLS_SLUICE_INFO_REPORT_H
#define TOOLS_SLUICE_INFO_REPORT_H

#include "devices.h"

/** `follows`: another one came before. */
void print_table(const struct device_report *report, bool follows);

/** One line. */
void print_json(const struct device_report *report);

#endif /* TOOLS_SLUICE_INFO_REPORT_H */
