#include "table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/text.h"

#define CELL 24

/* Shows bytes as MiB, to keep columns narrow. */
static double scale_of(const struct sweep_metric *metric)
{
    return strcmp(metric->unit, "bytes") == 0 ? 1.0 / 1048576.0 : 1.0;
}

static const char *unit_of(const struct sweep_metric *metric)
{
    return strcmp(metric->unit, "bytes") == 0 ? "MiB" : metric->unit;
}

static void print_estimate(const struct sweep_metric *metric, const struct sweep_estimate *e)
{
    char text[64] = "-";
    double scale = scale_of(metric);
    if (!isnan(e->mean) && isnan(e->half_width))
        snprintf(text, sizeof text, "%.4g", scale * e->mean);
    else if (!isnan(e->mean))
        snprintf(text, sizeof text, "%.4g +-%.2g", scale * e->mean, scale * e->half_width);
    printf(" %*s", CELL, text);
}

/* Chooses the columns: quality, memory and time, then up to three that explain them. */
static uint32_t choose_columns(const struct sweep *sweep, const struct recommend_metrics *metrics,
                               int columns[6])
{
    static const char *const others[] = {"missing_pixels_percent", "bytes_uploaded", "launches"};
    const int first[] = {metrics->quality, metrics->memory, metrics->time};
    uint32_t count = 0;
    for (int i = 0; i < 3; i++)
        if (first[i] >= 0)
            columns[count++] = first[i];
    for (int i = 0; i < 3; i++) {
        int found = sweep_find_metric(sweep, others[i]);
        if (found >= 0)
            columns[count++] = found;
    }
    return count;
}

static int label_width(const struct sweep *sweep)
{
    size_t width = 5;
    for (uint32_t i = 0; i < sweep->point_count; i++)
        if (strlen(sweep->points[i].label) > width)
            width = strlen(sweep->points[i].label);
    return width > 48 ? 48 : (int)width;
}

static void print_header(const struct sweep *sweep, const int *columns, uint32_t count, int width)
{
    printf("%-*s", width, "");
    for (uint32_t i = 0; i < count; i++)
        printf(" %*s", CELL, sweep->metrics[columns[i]].name);
    printf("\n%-*s", width, "");
    for (uint32_t i = 0; i < count; i++)
        printf(" %*s", CELL, unit_of(&sweep->metrics[columns[i]]));
    printf("\n");
}

/* Escapes the label, whose values come from the command line. */
static void print_label(const char *label, int width)
{
    text_write(stdout, label);
    printf("%*s", width > (int)strlen(label) ? width - (int)strlen(label) : 0, "");
}

void table_print(const struct sweep *sweep, const struct recommend_metrics *metrics,
                 const struct sweep_recommendation *recommendations, uint32_t count)
{
    int columns[6], width = label_width(sweep);
    uint32_t column_count = choose_columns(sweep, metrics, columns);
    print_header(sweep, columns, column_count, width);
    for (uint32_t i = 0; i < sweep->point_count; i++) {
        const struct sweep_point *point = &sweep->points[i];
        print_label(point->label, width);
        for (uint32_t c = 0; c < column_count && point->state == SWEEP_DONE; c++)
            print_estimate(&sweep->metrics[columns[c]], &point->estimates[columns[c]]);
        if (point->state != SWEEP_DONE) {
            fputs(point->state == SWEEP_FAILED ? "  failed: " : "  not yet run", stdout);
            text_write(stdout, point->reason ? point->reason : "");
        }
        printf("\n");
    }
    printf("\n");
    for (uint32_t i = 0; i < count; i++) {
        const struct sweep_recommendation *r = &recommendations[i];
        printf("%-13s ", r->name);
        text_write(stdout, r->point < 0 ? "none" : sweep->points[r->point].label);
        printf("\n%-13s (%s)\n", "", r->rule);
    }
}

static void print_count(const char *name, double value, const char *unit)
{
    printf("{\"name\": \"%s\", \"value\": %.0f, \"unit\": \"%s\"}\n", name, value, unit);
}

static void print_point(const struct sweep *sweep, const struct sweep_point *point)
{
    for (uint32_t m = 0; m < sweep->metric_count; m++) {
        const struct sweep_estimate *e = &point->estimates[m];
        if (isnan(e->mean))
            continue;
        printf("{\"name\": \"%s\", \"value\": %.10g, \"unit\": \"%s\", \"half_width\": ",
               sweep->metrics[m].name, e->mean, sweep->metrics[m].unit);
        if (isnan(e->half_width))
            fputs("null", stdout);
        else
            printf("%.10g", e->half_width);
        fputs(", \"point\": ", stdout);
        text_write_json(stdout, point->label);
        fputs("}\n", stdout);
    }
}

void table_print_json(const struct runs *runs, const struct sweep_recommendation *recommendations,
                      uint32_t count)
{
    const struct sweep *sweep = runs->sweep;
    uint32_t failed = 0, done = 0, kept = 0;
    for (uint32_t i = 0; i < sweep->point_count; i++)
        failed += sweep->points[i].state == SWEEP_FAILED;
    for (uint32_t i = 0; i < runs->count; i++) {
        done += runs->items[i].state == SWEEP_DONE;
        kept += runs->items[i].was_there;
    }
    print_count("points", sweep->point_count, "points");
    print_count("points_failed", failed, "points");
    print_count("runs", runs->count, "runs");
    print_count("runs_done", done, "runs");
    print_count("runs_kept", kept, "runs");
    for (uint32_t i = 0; i < sweep->point_count; i++)
        print_point(sweep, &sweep->points[i]);
    for (uint32_t i = 0; i < count; i++) {
        char *name = memory_text("recommended: %s", recommendations[i].name);
        fputs("{\"name\": ", stdout);
        text_write_json(stdout, name);
        fputs(", \"value\": ", stdout);
        if (recommendations[i].point < 0)
            fputs("null", stdout);
        else
            text_write_json(stdout, sweep->points[recommendations[i].point].label);
        fputs(", \"unit\": \"point\"}\n", stdout);
        free(name);
    }
}
