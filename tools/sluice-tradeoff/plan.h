/** Which combinations of settings are tried. */
#ifndef SLUICE_TRADEOFF_PLAN_H
#define SLUICE_TRADEOFF_PLAN_H

#include "options.h"
#include "scenes.h"

/**
 * Fills the settings, points and labels of a sweep: the base first, then each value of a setting by
 * itself, then the points of a grid; none twice. Settings that the program does not have are left
 * out; those it has can be swept though the scene does not list them. The strings of `scene` and
 * `options` must outlive it.
 *
 * False for what cannot be meant, said on stderr.
 */
bool plan_build(const struct options *options, const struct scene *scene,
                const struct program *program, struct sweep *sweep);

/** Whether two values are the same text or the same number: "1/16" is 0.0625. */
bool plan_same_value(const char *a, const char *b);

/** The options that set a point's values. */
void plan_add_arguments(const struct sweep *sweep, const struct sweep_point *point,
                        const struct program *program, struct text_list *arguments);

#endif /* SLUICE_TRADEOFF_PLAN_H */
