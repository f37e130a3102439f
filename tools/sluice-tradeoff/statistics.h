/** Means of a few repeats, and how well they are known. */
#ifndef SLUICE_TRADEOFF_STATISTICS_H
#define SLUICE_TRADEOFF_STATISTICS_H

#include "sweep.h"

/**
 * Student's t: the factor by which a share of `confidence` of all means of `degrees` + 1 values
 * lies within that many standard errors. `degrees` from 1 on, `confidence` in (0, 1).
 * Source: Abramowitz and Stegun, Handbook of Mathematical Functions, 26.7.3 and 26.7.4.
 */
double statistics_student_t(uint32_t degrees, double confidence);

/** NaN among the values: not measured. */
struct sweep_estimate statistics_estimate(const double *values, uint32_t count);

/**
 * Of the differences values[i] - base[i], where both were measured: what both share, a slow hour of
 * the machine or a seed, has no part in it.
 */
struct sweep_estimate statistics_paired(const double *values, const double *base, uint32_t count);

/**
 * The same of decibels, where 999 stands for no error at all: it has no part in a mean of decibels,
 * so that beside others the mean is that of the squared errors, and a difference to it is not
 * known.
 */
struct sweep_estimate statistics_decibels(const double *values, uint32_t count);
struct sweep_estimate statistics_paired_decibels(const double *values, const double *base,
                                                 uint32_t count);

#endif /* SLUICE_TRADEOFF_STATISTICS_H */
