/** What became of all files, as a table or as JSON. */
#ifndef TOOLS_SLUICE_BAKE_REPORT_H
#define TOOLS_SLUICE_BAKE_REPORT_H

#include "../common/bake_jobs.h"

/** The table on standard output, or an object per line; failures also on standard error. All took
 *  `seconds` of wall time. Answers how many failed. */
size_t print_outcomes(const struct bake_job *jobs, size_t count, double seconds, bool json);

#endif /* TOOLS_SLUICE_BAKE_REPORT_H */
