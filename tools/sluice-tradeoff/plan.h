/** Plans a sweep: the combinations of settings to try. */
#ifndef SLUICE_TRADEOFF_PLAN_H
#define SLUICE_TRADEOFF_PLAN_H

#include "options.h"
#include "scenes.h"

/**
 * Fills settings, points and labels of a sweep: the base, then each value of a setting by itself,
 * then the points of a grid. No point occurs twice. Settings that the program lacks are left out.
 * Options that the scene does not list can be swept too. The strings of `scene` and `options` must
 * outlive the sweep.
 *
 * Returns false for an invalid plan, and reports it on stderr.
 */
bool plan_build(const struct options *options, const struct scene *scene,
                const struct program *program, struct sweep *sweep);

/** Returns whether two values are equal texts or equal numbers: "1/16" equals 0.0625. */
bool plan_same_value(const char *a, const char *b);

/** Adds the options that set a point's values. */
void plan_add_arguments(const struct sweep *sweep, const struct sweep_point *point,
                        const struct program *program, struct text_list *arguments);

#endif /* SLUICE_TRADEOFF_PLAN_H */
