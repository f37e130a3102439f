#include "recommend.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"
#include "statistics.h"

#define LEAST_DIFFERENCE 0.01      ///< relative to the mean
#define LEAST_LONE_DIFFERENCE 0.10 ///< with a single repeat
#define LEAST_TIMES 3              ///< repeats; with fewer, no time is surely less

/** A limit: a metric may be at most `factor` times that of the base. */
struct bound {
    int metric;
    double factor;
};

struct chooser {
    const struct sweep *sweep;
    const struct recommend_metrics *metrics;
    bool *candidates; ///< by point
    double *scratch;  ///< by repeat
};

/* Cost of a value, less is better. Decibels become the root of the squared error. */
static double cost_of(const struct sweep *sweep, int metric, double value)
{
    const struct sweep_metric *m = &sweep->metrics[metric];
    if (strcmp(m->unit, "dB") == 0 && m->better == SWEEP_MORE_IS_BETTER)
        return value >= 999.0 ? 0.0 : pow(10.0, -value / 20.0);
    if (m->better == SWEEP_MORE_IS_BETTER)
        return -value;
    return value;
}

static double cost(const struct chooser *c, uint32_t point, int metric, uint32_t repeat)
{
    const struct sweep *sweep = c->sweep;
    const double *measured = sweep->points[point].measured + (size_t)metric * sweep->repeats;
    return cost_of(sweep, metric, measured[repeat]);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Median of the values that are not NaN; NaN if all are. Reorders the values. */
static double median(double *values, uint32_t count)
{
    uint32_t known = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!isnan(values[i]))
            values[known++] = values[i];
    qsort(values, known, sizeof *values, compare_doubles);
    return known == 0 ? NAN : 0.5 * (values[(known - 1) / 2] + values[known / 2]);
}

/* Median over the repeats of a point's cost minus `factor` times another's. */
static double excess(const struct chooser *c, uint32_t point, uint32_t other, int metric,
                     double factor)
{
    for (uint32_t i = 0; i < c->sweep->repeats; i++)
        c->scratch[i] = cost(c, point, metric, i) - factor * cost(c, other, metric, i);
    return median(c->scratch, c->sweep->repeats);
}

static double typical_cost(const struct chooser *c, uint32_t point, int metric)
{
    for (uint32_t i = 0; i < c->sweep->repeats; i++)
        c->scratch[i] = cost(c, point, metric, i);
    return median(c->scratch, c->sweep->repeats);
}

/* Difference relative to the mean of both, so that it is defined even if one is 0. */
static double relative_difference(double a, double b)
{
    double sum = fabs(a) + fabs(b);
    return sum == 0.0 ? 0.0 : 2.0 * (a - b) / sum;
}

/* Returns whether `a` is less than `b` by more than 1 % and by more than the repeats' uncertainty.
 * With one repeat: by more than 10 %. Times require LEAST_TIMES repeats. */
static bool surely_less(const struct chooser *c, uint32_t a, uint32_t b, int metric)
{
    for (uint32_t i = 0; i < c->sweep->repeats; i++)
        c->scratch[i] = relative_difference(cost(c, a, metric, i), cost(c, b, metric, i));
    struct sweep_estimate difference = statistics_estimate(c->scratch, c->sweep->repeats);
    if (metric == c->metrics->time && difference.count < LEAST_TIMES)
        return false;
    if (difference.count < 2)
        return difference.mean < -LEAST_LONE_DIFFERENCE;
    return difference.mean < -LEAST_DIFFERENCE && difference.mean + difference.half_width < 0.0;
}

/* Returns whether all differing settings are choices. The speed of a disk is none. */
static bool is_choice(const struct sweep *sweep, uint32_t point)
{
    for (uint32_t i = 0; i < sweep->setting_count; i++)
        if (sweep->settings[i].condition &&
            strcmp(sweep->points[point].values[i], sweep->points[sweep->base].values[i]) != 0)
            return false;
    return true;
}

static bool is_measured(const struct chooser *c, uint32_t point)
{
    const int metrics[] = {c->metrics->quality, c->metrics->memory, c->metrics->time};
    if (c->sweep->points[point].state != SWEEP_DONE || !is_choice(c->sweep, point))
        return false;
    for (int i = 0; i < 3; i++)
        if (metrics[i] >= 0 && isnan(typical_cost(c, point, metrics[i])))
            return false;
    return true;
}

/* Returns whether `other` is worse in nothing and surely better in something. */
static bool beats(const struct chooser *c, uint32_t other, uint32_t point)
{
    const int metrics[] = {c->metrics->quality, c->metrics->memory, c->metrics->time};
    bool better = false;
    for (int i = 0; i < 3; i++) {
        if (metrics[i] < 0)
            continue;
        if (excess(c, other, point, metrics[i], 1.0) > 0.0)
            return false;
        better = better || surely_less(c, other, point, metrics[i]);
    }
    return better;
}

static bool is_beaten(const struct chooser *c, uint32_t point)
{
    for (uint32_t i = 0; i < c->sweep->point_count; i++)
        if (i != point && is_measured(c, i) && beats(c, i, point))
            return true;
    return false;
}

/* Returns whether a point keeps to a bound. The measured median decides, however uncertain. */
static bool keeps_to(const struct chooser *c, uint32_t point, const struct bound *bound)
{
    return bound->metric < 0 || point == c->sweep->base ||
           excess(c, point, c->sweep->base, bound->metric, bound->factor) <= 0.0;
}

/* Keeps the candidates that are not surely worse than the best one. */
static void keep_least(struct chooser *c, int metric)
{
    int64_t best = -1;
    for (uint32_t i = 0; i < c->sweep->point_count && metric >= 0; i++)
        if (c->candidates[i] &&
            (best < 0 || typical_cost(c, i, metric) < typical_cost(c, (uint32_t)best, metric)))
            best = i;
    for (uint32_t i = 0; i < c->sweep->point_count && best >= 0; i++)
        c->candidates[i] = c->candidates[i] && !surely_less(c, (uint32_t)best, i, metric);
}

/* Chooses the best point by the first metric, among candidates that are not worse than the base in
 * it: points that count as equal may still differ by the whole uncertainty. The next metrics decide
 * among equal points. */
static int64_t choose(struct chooser *c, const struct bound bounds[2], const int order[3])
{
    const struct sweep *sweep = c->sweep;
    const struct bound goal = {order[0], 1.0};
    for (uint32_t i = 0; i < sweep->point_count; i++)
        c->candidates[i] = is_measured(c, i) && !is_beaten(c, i) && keeps_to(c, i, &goal) &&
                           keeps_to(c, i, &bounds[0]) && keeps_to(c, i, &bounds[1]);
    for (int i = 0; i < 3; i++)
        keep_least(c, order[i]);
    if (c->candidates[sweep->base])
        return sweep->base;
    for (uint32_t i = 0; i < sweep->point_count; i++)
        if (c->candidates[i])
            return i;
    return -1;
}

/* "time (gpu_ms_median)" */
static char *write_name(const struct chooser *c, int metric)
{
    const struct sweep_metric *m = &c->sweep->metrics[metric];
    const char *word = metric == c->metrics->quality  ? "picture error"
                       : metric == c->metrics->memory ? "memory"
                       : strcmp(m->unit, "bytes") == 0 || strcmp(m->unit, "B") == 0 ? "loading"
                                                                                    : "time";
    return memory_text("%s (%s)", word, m->name);
}

/* Writes ", with a time (gpu_ms_median) up to 1.25 times the base's", or "" for a metric that is
 * not measured. */
static char *write_bound(const struct chooser *c, const struct bound *bound, const char *before)
{
    if (bound->metric < 0)
        return memory_copy_text("");
    char *name = write_name(c, bound->metric), *text;
    if (strcmp(c->sweep->metrics[bound->metric].unit, "dB") == 0)
        text = memory_text("%s%s up to %.2g dB above the base's", before, name,
                           20.0 * log10(bound->factor));
    else
        text = memory_text("%s%s up to %g times the base's", before, name, bound->factor);
    free(name);
    return text;
}

/* Explains when surely_less calls two points equal. */
static const char *equality(const struct chooser *c)
{
    return c->sweep->repeats < 2
               ? "equal: less than 10 % apart, as there is one repeat"
               : "equal: less than 1 % apart, or less than the repeats let one tell apart";
}

static char *write_rule(const struct chooser *c, int goal, int then, const struct bound bounds[2])
{
    char *first = write_name(c, goal), *second = write_name(c, then);
    char *one = write_bound(c, &bounds[0], ", with ");
    char *two = write_bound(c, &bounds[1], *one ? " and " : ", with ");
    char *rule =
        memory_text("least %s, never more than the base's%s%s; of equals the least %s (%s)", first,
                    one, two, second, equality(c));
    free(first);
    free(second);
    free(one);
    free(two);
    return rule;
}

void recommend(const struct sweep *sweep, const struct recommend_metrics *metrics,
               struct sweep_recommendation recommendations[RECOMMEND_COUNT])
{
    static const char *const names[] = {"quality", "balanced", "small memory"};
    const int q = metrics->quality, m = metrics->memory, t = metrics->time;
    const struct bound bounds[RECOMMEND_COUNT][2] = {
        {{m, 2.0}, {t, 2.0}}, {{q, 1.1}, {t, 1.25}}, {{q, 2.0}, {t, 1.5}}};
    const int orders[RECOMMEND_COUNT][3] = {{q, m, t}, {m, q, t}, {m, q, t}};
    struct chooser chooser = {sweep, metrics, memory_take(sweep->point_count, sizeof(bool)),
                              memory_take(sweep->repeats, sizeof(double))};
    bool possible = q >= 0 && m >= 0 && is_measured(&chooser, sweep->base);
    for (int i = 0; i < RECOMMEND_COUNT; i++) {
        recommendations[i] = (struct sweep_recommendation){names[i], NULL, -1};
        recommendations[i].rule =
            possible ? write_rule(&chooser, orders[i][0], orders[i][1], bounds[i])
                     : memory_copy_text("picture and memory of the base were not measured");
        if (possible)
            recommendations[i].point = choose(&chooser, bounds[i], orders[i]);
    }
    free(chooser.candidates);
    free(chooser.scratch);
}

void recommend_finish(struct sweep_recommendation recommendations[RECOMMEND_COUNT])
{
    for (int i = 0; i < RECOMMEND_COUNT; i++) {
        free((void *)(uintptr_t)recommendations[i].rule);
        recommendations[i].rule = NULL;
    }
}
