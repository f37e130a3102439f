/** Recommends points of a sweep. */
#ifndef SLUICE_TRADEOFF_RECOMMEND_H
#define SLUICE_TRADEOFF_RECOMMEND_H

#include "sweep.h"

#define RECOMMEND_COUNT 3

/** Indices of metrics. Negative: not measured; no rule uses it. */
struct recommend_metrics {
    int quality, memory, time;
};

/**
 * Chooses the points "quality", "balanced" and "small memory" by the rules written into
 * `recommendations`.
 *
 * Candidates are measured points that no other point beats. A point beats another one if it is
 * worse in none of the three metrics and surely better in one. A candidate is never worse than the
 * base in the first metric of its rule.
 *
 * All comparisons are repeat by repeat. A point keeps to a bound if the median of its repeats does.
 * A point is surely better if it is better by more than 1 % and by more than the 95 % confidence
 * interval of the differences; with one repeat, by more than 10 %. Two points are equal in a metric
 * if neither is surely better. Among equal points the cheapest wins, then the base, then the first.
 *
 * Without quality and memory metrics there are no recommendations: every point is -1. Free the
 * rules with recommend_finish.
 */
void recommend(const struct sweep *sweep, const struct recommend_metrics *metrics,
               struct sweep_recommendation recommendations[RECOMMEND_COUNT]);
void recommend_finish(struct sweep_recommendation recommendations[RECOMMEND_COUNT]);

#endif /* SLUICE_TRADEOFF_RECOMMEND_H */
