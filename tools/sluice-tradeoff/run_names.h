/** Names of the runs' folders, so that another build of this tool finds them. */
#ifndef SLUICE_TRADEOFF_RUN_NAMES_H
#define SLUICE_TRADEOFF_RUN_NAMES_H

#include "runs.h"

/** Writes RESULTS/sweep.runs. Returns false on error and reports it on stderr. */
bool run_names_write(const struct runs *runs);

/** Reads RESULTS/sweep.runs for run_names_find. Returns NULL if there is none. The caller frees the
 * text. */
char *run_names_read(const char *results);
/** Returns the key of a point's run, or NULL if it is not listed. The caller frees it. `names` may
 * be NULL. */
char *run_names_find(const char *names, const char *label, uint32_t repeat);

#endif /* SLUICE_TRADEOFF_RUN_NAMES_H */
