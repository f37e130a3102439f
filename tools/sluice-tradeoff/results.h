/** From runs to points: means, what is known of them, and where to look. */
#ifndef SLUICE_TRADEOFF_RESULTS_H
#define SLUICE_TRADEOFF_RESULTS_H

#include "runs.h"

/**
 * Fills the metrics that some run has, states, estimates, folders and command lines of all points,
 * and the machine. Times of first runs, which also write and count, do not count where there are
 * others.
 */
void results_collect(const struct runs *runs, struct sweep *sweep);

/** Keeps in RESULTS/machine.txt what runs were made on. False and a line on stderr if not. */
bool results_remember_machine(const struct runs *runs);

/** The first of `names`, which NULL ends, that was measured at the base; -1: none. */
int results_pick(const struct sweep *sweep, const char *const *names);

/** RESULTS/points.csv, a line per point, and RESULTS/runs.csv. False and a line on stderr if not.
 */
bool results_write_points(const struct sweep *sweep, const char *path);
bool results_write_runs(const struct runs *runs, const char *path);

#endif /* SLUICE_TRADEOFF_RESULTS_H */
