/** Means of a few repeats, and their uncertainty. */
#ifndef SLUICE_TRADEOFF_STATISTICS_H
#define SLUICE_TRADEOFF_STATISTICS_H

#include "sweep.h"

/**
 * Student's t: the number of standard errors within which a share `confidence` of all means of
 * `degrees` + 1 values lies. `degrees`: 1 or more. `confidence`: in (0, 1). Source: Abramowitz and
 * Stegun, Handbook of Mathematical Functions, 26.7.3 and 26.7.4.
 */
double statistics_student_t(uint32_t degrees, double confidence);

/** Estimates a mean. NaN values count as not measured. */
struct sweep_estimate statistics_estimate(const double *values, uint32_t count);

/**
 * Estimates the mean of values[i] - base[i] over pairs where both were measured. Influences that
 * both share, such as a seed or a slow hour of the machine, cancel out.
 */
struct sweep_estimate statistics_paired(const double *values, const double *base, uint32_t count);

/**
 * Estimates means of decibels, where 999 stands for no error. If only some values are 999, the mean
 * is taken over squared errors. The difference between 999 and another value is unknown.
 */
struct sweep_estimate statistics_decibels(const double *values, uint32_t count);
struct sweep_estimate statistics_paired_decibels(const double *values, const double *base,
                                                 uint32_t count);

#endif /* SLUICE_TRADEOFF_STATISTICS_H */
