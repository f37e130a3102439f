/**
 * A sweep as one HTML file that needs nothing else: recommended settings, Pareto fronts, the effect
 * of each setting, figures over frames, pictures beside the truth, all points as a table.
 */
#ifndef SLUICE_TRADEOFF_PAGE_H
#define SLUICE_TRADEOFF_PAGE_H

#include "sweep.h"

/**
 * Of the page, in bytes. All points are on it however many there are; what is left of this is for
 * the figures over frames and for pictures, the base and what is recommended first. What had no
 * room is named on the page.
 */
#define PAGE_SIZE_MAX ((size_t)6 << 20)

/**
 * Writes the page to `path`; frames.csv and pictures are read from the points' folders, and where
 * they are missing or damaged the page says so. False, with the reason on stderr, if it could not
 * be written or memory ran out; `path` is then as it was.
 */
bool page_write(const struct sweep *sweep, const struct sweep_recommendation *recommendations,
                uint32_t count, const char *path);

#endif /* SLUICE_TRADEOFF_PAGE_H */
