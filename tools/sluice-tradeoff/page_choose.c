#include "page_choose.h"

#include <math.h>

struct list {
    const struct sweep *sweep;
    struct page_choice *choices;
    uint32_t count;
};

static void add(struct list *list, uint32_t point, const char *role, const char *metric)
{
    if (point >= list->sweep->point_count || list->sweep->points[point].state != SWEEP_DONE)
        return;
    for (uint32_t i = 0; i < list->count; i++)
        if (list->choices[i].point == point)
            return;
    list->choices[list->count++] = (struct page_choice){point, role, metric};
}

/* Adds the point with the extreme value, which may be infinite. Ignores unknown values. */
static void add_extreme(struct list *list, const char *name, bool least)
{
    int metric = sweep_find_metric(list->sweep, name);
    int64_t found = -1;
    double best = NAN;
    for (uint32_t i = 0; i < list->sweep->point_count && metric >= 0; i++) {
        const struct sweep_point *point = &list->sweep->points[i];
        if (point->state != SWEEP_DONE || isnan(point->estimates[metric].mean))
            continue;
        double value = point->estimates[metric].mean;
        if (found < 0 || (least ? value < best : value > best)) {
            found = i;
            best = value;
        }
    }
    if (found >= 0)
        add(list, (uint32_t)found, least ? "least" : "most", name);
}

uint32_t page_choose(const struct sweep *sweep, const struct sweep_recommendation *recommendations,
                     uint32_t recommendation_count, struct page_choice *choices,
                     uint32_t *prominent)
{
    struct list list = {sweep, choices, 0};
    add(&list, sweep->base, "base", "");
    for (uint32_t i = 0; i < recommendation_count; i++)
        if (recommendations[i].point >= 0 && recommendations[i].point < (int64_t)UINT32_MAX)
            add(&list, (uint32_t)recommendations[i].point, recommendations[i].name, "");
    add_extreme(&list, "flip_mean", false);
    add_extreme(&list, "psnr_mean_db", true);
    add_extreme(&list, "psnr_lowest_db", true);
    add_extreme(&list, "resident_bytes_peak", true);
    add_extreme(&list, "flip_mean", true);
    add_extreme(&list, "resident_bytes_peak", false);
    *prominent = list.count;
    for (uint32_t i = 0; i < sweep->point_count; i++)
        add(&list, i, "", "");
    return list.count;
}
