/** Chooses points for the page: the base, recommended points, then the extremes. */
#ifndef SLUICE_TRADEOFF_PAGE_CHOOSE_H
#define SLUICE_TRADEOFF_PAGE_CHOOSE_H

#include "sweep.h"

struct page_choice {
    uint32_t point;
    const char *role;   ///< "base", a recommendation's name, "least flip_mean"; several are joined;
                        ///< "" if none
    const char *metric; ///< metric in which the point is extreme; "" if none
};

/**
 * Writes every complete point once to choices[sweep->point_count], the most important first.
 * `prominent`: number of points with a role, which get pictures. Returns the number of points.
 */
uint32_t page_choose(const struct sweep *sweep, const struct sweep_recommendation *recommendations,
                     uint32_t recommendation_count, struct page_choice *choices,
                     uint32_t *prominent);

#endif /* SLUICE_TRADEOFF_PAGE_CHOOSE_H */
