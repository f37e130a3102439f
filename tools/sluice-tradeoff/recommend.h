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
 * Quality, balanced and small memory, by the rules that are written into `recommendations`, over
 * the points that were measured and that no other beats: no worse in any of the three metrics and
 * surely better in one. All is compared repeat by repeat. A bound is kept to if the median of the
 * repeats does. A point is surely better if it is so by more than 1 % and by more than the 95 %
 * confidence interval of the differences, or by more than 10 % where it was
 * measured once: of points that are equally good the cheapest is taken,
 * then the base, then the first.
 *
 * Without quality and memory there are no recommendations (every point is -1). The rules are to be
 * freed with recommend_finish.
 */
void recommend(const struct sweep *sweep, const struct recommend_metrics *metrics,
               struct sweep_recommendation recommendations[RECOMMEND_COUNT]);
void recommend_finish(struct sweep_recommendation recommendations[RECOMMEND_COUNT]);

#endif /* SLUICE_TRADEOFF_RECOMMEND_H */
