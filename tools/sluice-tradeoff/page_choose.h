/** Which points deserve room on the page: the base, what is recommended, then the extremes. */
#ifndef SLUICE_TRADEOFF_PAGE_CHOOSE_H
#define SLUICE_TRADEOFF_PAGE_CHOOSE_H

#include "sweep.h"

struct page_choice {
    uint32_t point;
    const char *role;   ///< "base", a recommendation's name, "least flip_mean" by parts; "" if none
    const char *metric; ///< what it is extreme in, "" if nothing
};

/**
 * Writes every point that is done once, the most important first, to choices[sweep->point_count].
 * `prominent` is how many of them have a role: those get pictures. Returns how many there are.
 */
uint32_t page_choose(const struct sweep *sweep, const struct sweep_recommendation *recommendations,
                     uint32_t recommendation_count, struct page_choice *choices,
                     uint32_t *prominent);

#endif /* SLUICE_TRADEOFF_PAGE_CHOOSE_H */
