/** Prints the results of a sweep for a terminal or for another program. */
#ifndef SLUICE_TRADEOFF_TABLE_H
#define SLUICE_TRADEOFF_TABLE_H

#include "recommend.h"
#include "runs.h"

/** Prints a line per point, and the recommendations. */
void table_print(const struct sweep *sweep, const struct recommend_metrics *metrics,
                 const struct sweep_recommendation *recommendations, uint32_t count);

/**
 * Prints JSON lines {"name", "value", "unit"}: counts of points and runs, all figures of all
 * points, and the recommended points. Figures of points also have "point" and "half_width".
 */
void table_print_json(const struct runs *runs, const struct sweep_recommendation *recommendations,
                      uint32_t count);

#endif /* SLUICE_TRADEOFF_TABLE_H */
