/** Results of a sweep: points computed from runs, and their files. */
#ifndef SLUICE_TRADEOFF_RESULTS_H
#define SLUICE_TRADEOFF_RESULTS_H

#include "runs.h"

/**
 * Fills the metrics that some run has, states, estimates, folders and command lines of all points,
 * and the machine. Ignores times of first runs, which also write and count, if there are others.
 */
void results_collect(const struct runs *runs, struct sweep *sweep);

/** Writes the machine of the runs to RESULTS/machine.txt. Reports errors on stderr. */
bool results_remember_machine(const struct runs *runs);

/** Returns the first of `names`, which ends with NULL, that was measured at the base. -1: none. */
int results_pick(const struct sweep *sweep, const char *const *names);

/** Write RESULTS/points.csv, a line per point, and RESULTS/runs.csv. Report errors on stderr. */
bool results_write_points(const struct sweep *sweep, const char *path);
bool results_write_runs(const struct runs *runs, const char *path);

#endif /* SLUICE_TRADEOFF_RESULTS_H */
