/**
 * Writes a sweep as one self-contained HTML file: recommended settings, Pareto fronts, the effect
 * of each setting, figures over frames, pictures beside the truth, and a table of all points.
 */
#ifndef SLUICE_TRADEOFF_PAGE_H
#define SLUICE_TRADEOFF_PAGE_H

#include "sweep.h"

/**
 * Size limit of the page in bytes. All points are always included. The rest is for figures over
 * frames and for pictures: first the base and recommended points. The page names everything that
 * found no room.
 */
#define PAGE_SIZE_MAX ((size_t)6 << 20)

/**
 * Writes the page to `path`. Reads frames.csv and pictures from the points' folders; the page
 * reports missing or damaged files. Returns false when out of memory or on a write error, and
 * reports it on stderr; `path` is unchanged then.
 */
bool page_write(const struct sweep *sweep, const struct sweep_recommendation *recommendations,
                uint32_t count, const char *path);

#endif /* SLUICE_TRADEOFF_PAGE_H */
