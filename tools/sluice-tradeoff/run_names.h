/** Which folder holds which run, so that another build of this tool finds it, too. */
#ifndef SLUICE_TRADEOFF_RUN_NAMES_H
#define SLUICE_TRADEOFF_RUN_NAMES_H

#include "runs.h"

/** Writes RESULTS/sweep.runs. False and a line on stderr if it cannot be written. */
bool run_names_write(const struct runs *runs);

/** What is in RESULTS/sweep.runs, for run_names_find; NULL if there is none; to be freed. */
char *run_names_read(const char *results);
/** The key of a point's run, to be freed; NULL if it is not there. `names` may be NULL. */
char *run_names_find(const char *names, const char *label, uint32_t repeat);

#endif /* SLUICE_TRADEOFF_RUN_NAMES_H */
