#include "recommend.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"

#define LEAST_DIFFERENCE 0.01 ///< of the mean

/** What a point must keep to: a metric at most `factor` times that of the base. */
struct bound {
    int metric;
    double factor;
};

struct chooser {
    const struct sweep *sweep;
    const struct recommend_metrics *metrics;
    bool *candidates; ///< per point
};

/* So that less is better: decibels become the root of the squared error. */
static double cost_of(const struct sweep *sweep, int metric, double value)
{
    const struct sweep_metric *m = &sweep->metrics[metric];
    if (strcmp(m->unit, "dB") == 0 && m->better == SWEEP_MORE_IS_BETTER)
        return value >= 999.0 ? 0.0 : pow(10.0, -value / 20.0);
    if (m->better == SWEEP_MORE_IS_BETTER)
        return -value;
    return value;
}

/* The range in which a point's cost lies. */
static void get_range(const struct sweep *sweep, uint32_t point, int metric, double *low,
                      double *high)
{
    const struct sweep_estimate *e = &sweep->points[point].estimates[metric];
    double half = isnan(e->half_width) ? 0.0 : e->half_width;
    double a = cost_of(sweep, metric, e->mean - half), b = cost_of(sweep, metric, e->mean + half);
    double slack = 0.5 * LEAST_DIFFERENCE * fabs(cost_of(sweep, metric, e->mean));
    *low = fmin(a, b) - slack;
    *high = fmax(a, b) + slack;
}

static double cost(const struct chooser *c, uint32_t point, int metric)
{
    return cost_of(c->sweep, metric, c->sweep->points[point].estimates[metric].mean);
}

static bool surely_less(const struct chooser *c, uint32_t a, uint32_t b, int metric)
{
    double low_a, high_a, low_b, high_b;
    get_range(c->sweep, a, metric, &low_a, &high_a);
    get_range(c->sweep, b, metric, &low_b, &high_b);
    return high_a < low_b;
}

static bool is_measured(const struct chooser *c, uint32_t point)
{
    const int metrics[] = {c->metrics->quality, c->metrics->memory, c->metrics->time};
    if (c->sweep->points[point].state != SWEEP_DONE)
        return false;
    for (int i = 0; i < 3; i++)
        if (metrics[i] >= 0 && isnan(c->sweep->points[point].estimates[metrics[i]].mean))
            return false;
    return true;
}

/* Whether `other` is no worse in anything and surely better in something. */
static bool beats(const struct chooser *c, uint32_t other, uint32_t point)
{
    const int metrics[] = {c->metrics->quality, c->metrics->memory, c->metrics->time};
    bool better = false;
    for (int i = 0; i < 3; i++) {
        if (metrics[i] < 0)
            continue;
        if (cost(c, other, metrics[i]) > cost(c, point, metrics[i]))
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

/* A point is out only if it surely exceeds a bound. */
static bool keeps_to(const struct chooser *c, uint32_t point, const struct bound *bound)
{
    if (bound->metric < 0)
        return true;
    double low, high, limit = bound->factor * cost(c, c->sweep->base, bound->metric);
    get_range(c->sweep, point, bound->metric, &low, &high);
    return low <= limit;
}

/* Leaves the candidates that are not surely worse than the one with the least mean. */
static void keep_least(struct chooser *c, int metric)
{
    int64_t best = -1;
    for (uint32_t i = 0; i < c->sweep->point_count && metric >= 0; i++)
        if (c->candidates[i] && (best < 0 || cost(c, i, metric) < cost(c, (uint32_t)best, metric)))
            best = i;
    for (uint32_t i = 0; i < c->sweep->point_count && best >= 0; i++)
        c->candidates[i] = c->candidates[i] && !surely_less(c, (uint32_t)best, i, metric);
}

/* The best by the first metric; of those that are equal in it by the next. */
static int64_t choose(struct chooser *c, const struct bound bounds[2], const int order[3])
{
    const struct sweep *sweep = c->sweep;
    for (uint32_t i = 0; i < sweep->point_count; i++)
        c->candidates[i] = is_measured(c, i) && !is_beaten(c, i) && keeps_to(c, i, &bounds[0]) &&
                           keeps_to(c, i, &bounds[1]);
    for (int i = 0; i < 3; i++)
        keep_least(c, order[i]);
    if (c->candidates[sweep->base])
        return sweep->base;
    for (uint32_t i = 0; i < sweep->point_count; i++)
        if (c->candidates[i])
            return i;
    return -1;
}

/* ", with gpu_ms_median up to 1.25 times the base's"; "" for what is not measured. */
static char *write_bound(const struct sweep *sweep, const struct bound *bound, const char *before)
{
    if (bound->metric < 0)
        return memory_copy_text("");
    const struct sweep_metric *metric = &sweep->metrics[bound->metric];
    if (strcmp(metric->unit, "dB") == 0)
        return memory_text("%s%s at most %.0f dB below the base's", before, metric->name,
                           20.0 * log10(bound->factor));
    return memory_text("%s%s up to %g times the base's", before, metric->name, bound->factor);
}

static const char *goal_word(const struct sweep_metric *metric)
{
    return metric->better == SWEEP_MORE_IS_BETTER ? "greatest" : "least";
}

static char *write_rule(const struct sweep *sweep, int goal, int then, const struct bound bounds[2])
{
    const struct sweep_metric *first = &sweep->metrics[goal], *second = &sweep->metrics[then];
    char *one = write_bound(sweep, &bounds[0], ", with ");
    char *two = write_bound(sweep, &bounds[1], *one ? " and " : ", with ");
    char *rule = memory_text("%s %s%s%s; of equals the %s %s", goal_word(first), first->name, one,
                             two, goal_word(second), second->name);
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
        {{m, 2.0}, {t, 2.0}}, {{q, 1.1}, {t, 1.1}}, {{q, 2.0}, {t, 1.5}}};
    const int orders[RECOMMEND_COUNT][3] = {{q, m, t}, {m, q, t}, {m, q, t}};
    struct chooser chooser = {sweep, metrics, memory_take(sweep->point_count, sizeof(bool))};
    bool possible = q >= 0 && m >= 0 && is_measured(&chooser, sweep->base);
    for (int i = 0; i < RECOMMEND_COUNT; i++) {
        recommendations[i] = (struct sweep_recommendation){names[i], NULL, -1};
        recommendations[i].rule =
            possible ? write_rule(sweep, orders[i][0], orders[i][1], bounds[i])
                     : memory_copy_text("picture and memory of the base were not measured");
        if (possible)
            recommendations[i].point = choose(&chooser, bounds[i], orders[i]);
    }
    free(chooser.candidates);
}

void recommend_finish(struct sweep_recommendation recommendations[RECOMMEND_COUNT])
{
    for (int i = 0; i < RECOMMEND_COUNT; i++) {
        free((void *)(uintptr_t)recommendations[i].rule);
        recommendations[i].rule = NULL;
    }
}
