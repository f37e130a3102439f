/** Which points to take. */
#ifndef SLUICE_TRADEOFF_RECOMMEND_H
#define SLUICE_TRADEOFF_RECOMMEND_H

#include "sweep.h"

#define RECOMMEND_COUNT 3

/** Indices of metrics; a negative one is not known, and no rule asks for it. */
struct recommend_metrics {
    int quality, memory, time;
};

/**
 * Chooses quality, balanced and small memory by the rules that are written into `recommendations`.
 *
 * Candidates are the points that were measured and that no other point beats: no worse in any of
 * the three metrics and surely better in one. A candidate is never worse than the base in the
 * metric that its rule names first. All is compared repeat by repeat: a bound is kept to if the
 * median of the repeats does. A point is surely better if it is so by more than 1 % and by more
 * than the 95 % confidence interval of the differences, or by more than 10 % where it was measured
 * once. Two points are equal in a metric if neither is surely better. Of equal points the cheapest
 * is taken, then the base, then the first.
 *
 * Without quality and memory there are no recommendations (every point is -1). The rules are to be
 * freed with recommend_finish.
 */
void recommend(const struct sweep *sweep, const struct recommend_metrics *metrics,
               struct sweep_recommendation recommendations[RECOMMEND_COUNT]);
void recommend_finish(struct sweep_recommendation recommendations[RECOMMEND_COUNT]);

#endif /* SLUICE_TRADEOFF_RECOMMEND_H */
