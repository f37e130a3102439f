/** Prints the outcome of all files, as a table or as JSON. */
#ifndef TOOLS_SLUICE_BAKE_REPORT_H
#define TOOLS_SLUICE_BAKE_REPORT_H

#include "../common/bake_jobs.h"

/** Prints a table, or a JSON object per line, on stdout; failures also on stderr. `seconds`: wall
 * time of all files together. Returns the number of failures. */
size_t print_outcomes(const struct bake_job *jobs, size_t count, double seconds, bool json);

#endif /* TOOLS_SLUICE_BAKE_REPORT_H */
