/** What became of all files, as a table or as JSON. */
#ifndef TOOLS_SLUICE_BAKE_REPORT_H
#define TOOLS_SLUICE_BAKE_REPORT_H

#include "run.h"

#include <stdio.h>

/** The table on standard output, or an object per line; failures also on standard error. Answers
 *  how many failed. */
size_t print_outcomes(const struct files *files, const struct outcome *outcomes, bool json);

/** A string with its quotes. */
void print_json_string(FILE *out, const char *text);

#endif /* TOOLS_SLUICE_BAKE_REPORT_H */
