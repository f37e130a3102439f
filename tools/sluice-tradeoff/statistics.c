#include "statistics.h"

#include <math.h>
#include <stdlib.h>

#include "memory.h"

#define HALF_PI 1.57079632679489661923
#define CONFIDENCE 0.95
#define EQUAL_DB 999.0
#define DB_PER_RATIO 4.34294481903251827651 /* 10 / ln 10 */

/* Returns the probability that |t| is at most sqrt(degrees) * tan(angle). */
static double student_chance(uint32_t degrees, double angle)
{
    double s = sin(angle), c = cos(angle);
    double term = degrees % 2 ? c : 1.0, sum = 0.0;
    for (uint32_t i = degrees % 2 ? 3 : 2; i <= degrees; i += 2) {
        sum += term;
        term *= c * c * (i - 1.0) / i;
    }
    return degrees % 2 ? (angle + s * sum) / HALF_PI : s * sum;
}

double statistics_student_t(uint32_t degrees, double confidence)
{
    double low = 0.0, high = HALF_PI;
    for (int i = 0; i < 100; i++) {
        double middle = 0.5 * (low + high);
        if (student_chance(degrees, middle) < confidence)
            low = middle;
        else
            high = middle;
    }
    return sqrt(degrees) * tan(low);
}

struct sweep_estimate statistics_estimate(const double *values, uint32_t count)
{
    struct sweep_estimate estimate = {NAN, NAN, NAN, NAN, 0};
    double sum = 0.0, squares = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        if (isnan(values[i]))
            continue;
        estimate.count++;
        estimate.least = fmin(estimate.least, values[i]);
        estimate.most = fmax(estimate.most, values[i]);
        sum += values[i];
    }
    if (estimate.count == 0)
        return estimate;
    /* Equal values have no spread; the rounded sum would give one. */
    bool equal = estimate.least == estimate.most;
    estimate.mean = equal ? estimate.least : sum / estimate.count;
    for (uint32_t i = 0; i < count && !equal; i++)
        if (!isnan(values[i]))
            squares += (values[i] - estimate.mean) * (values[i] - estimate.mean);
    uint32_t degrees = estimate.count - 1;
    if (degrees > 0)
        estimate.half_width =
            statistics_student_t(degrees, CONFIDENCE) * sqrt(squares / degrees / estimate.count);
    return estimate;
}

struct sweep_estimate statistics_paired(const double *values, const double *base, uint32_t count)
{
    double *differences = memory_take(count, sizeof *differences);
    for (uint32_t i = 0; i < count; i++)
        differences[i] = values[i] - base[i];
    struct sweep_estimate estimate = statistics_estimate(differences, count);
    free(differences);
    return estimate;
}

struct sweep_estimate statistics_decibels(const double *values, uint32_t count)
{
    struct sweep_estimate plain = statistics_estimate(values, count);
    if (plain.count == 0 || plain.most < EQUAL_DB || plain.least >= EQUAL_DB)
        return plain;
    double *errors = memory_take(count, sizeof *errors);
    for (uint32_t i = 0; i < count; i++)
        errors[i] = values[i] >= EQUAL_DB ? 0.0 : pow(10.0, -0.1 * values[i]);
    struct sweep_estimate error = statistics_estimate(errors, count);
    free(errors);
    plain.mean = -10.0 * log10(error.mean);
    plain.half_width = DB_PER_RATIO * error.half_width / error.mean;
    return plain;
}

struct sweep_estimate statistics_paired_decibels(const double *values, const double *base,
                                                 uint32_t count)
{
    double *differences = memory_take(count, sizeof *differences);
    for (uint32_t i = 0; i < count; i++)
        differences[i] =
            (values[i] >= EQUAL_DB) == (base[i] >= EQUAL_DB) ? values[i] - base[i] : NAN;
    struct sweep_estimate estimate = statistics_estimate(differences, count);
    free(differences);
    return estimate;
}
