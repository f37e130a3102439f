/** What a sweep found, for a terminal or for another program. */
#ifndef SLUICE_TRADEOFF_TABLE_H
#define SLUICE_TRADEOFF_TABLE_H

#include "recommend.h"
#include "runs.h"

/** A line per point, and the recommendations. */
void table_print(const struct sweep *sweep, const struct recommend_metrics *metrics,
                 const struct sweep_recommendation *recommendations, uint32_t count);

/**
 * JSON lines {"name", "value", "unit"}: counts of points and runs, every figure of every point,
 * which also have "point" and "half_width", and the recommended points.
 */
void table_print_json(const struct runs *runs, const struct sweep_recommendation *recommendations,
                      uint32_t count);

#endif /* SLUICE_TRADEOFF_TABLE_H */
