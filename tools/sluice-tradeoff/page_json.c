#include "page_json.h"

#include <inttypes.h>
#include <math.h>

#include "../common/text.h"

void page_put_text(FILE *file, const char *text)
{
    if (text)
        text_write_json(file, text);
    else
        fputs("null", file);
}

static void put_digits(FILE *file, double value, int digits)
{
    if (isnan(value))
        fputs("null", file);
    else if (isinf(value))
        fputs(value > 0.0 ? "\"inf\"" : "\"-inf\"", file);
    else
        fprintf(file, "%.*g", digits, value);
}

void page_put_number(FILE *file, double value)
{
    put_digits(file, value, 5);
}

static void put_member(FILE *file, const char *name, const char *text)
{
    fprintf(file, "\"%s\":", name);
    page_put_text(file, text);
    fputc(',', file);
}

static void put_settings(FILE *file, const struct sweep *sweep)
{
    fputs("\"settings\":[", file);
    for (uint32_t i = 0; i < sweep->setting_count; i++) {
        const struct sweep_setting *setting = &sweep->settings[i];
        fputs(i > 0 ? ",\n{" : "{", file);
        put_member(file, "name", setting->name);
        put_member(file, "meaning", setting->meaning);
        fputs("\"unit\":", file);
        page_put_text(file, setting->unit);
        fputc('}', file);
    }
    fputs("],\n", file);
}

static const char *better_name(enum sweep_better better)
{
    switch (better) {
    case SWEEP_LESS_IS_BETTER: return "less";
    case SWEEP_MORE_IS_BETTER: return "more";
    case SWEEP_NEITHER: break;
    }
    return "neither";
}

static void put_metrics(FILE *file, const struct sweep *sweep)
{
    fputs("\"metrics\":[", file);
    for (uint32_t i = 0; i < sweep->metric_count; i++) {
        const struct sweep_metric *metric = &sweep->metrics[i];
        fputs(i > 0 ? ",\n{" : "{", file);
        put_member(file, "name", metric->name);
        put_member(file, "unit", metric->unit);
        put_member(file, "meaning", metric->meaning);
        fprintf(file, "\"better\":\"%s\"}", better_name(metric->better));
    }
    fputs("],\n", file);
}

static const char *state_name(enum sweep_state state)
{
    switch (state) {
    case SWEEP_PENDING: return "pending";
    case SWEEP_DONE: return "done";
    case SWEEP_FAILED: break;
    }
    return "failed";
}

/* Writes [mean, half width, count]. Means have enough digits for exact bytes, because differences
 * are computed from them. */
static void put_estimate(FILE *file, const struct sweep_estimate *estimate)
{
    fputc('[', file);
    put_digits(file, estimate->mean, 12);
    fputc(',', file);
    page_put_number(file, estimate->half_width);
    fprintf(file, ",%" PRIu32 "]", estimate->count);
}

static void put_estimates(FILE *file, const struct sweep_estimate *estimates, uint32_t count)
{
    if (!estimates) {
        fputs("null", file);
        return;
    }
    fputc('[', file);
    for (uint32_t i = 0; i < count; i++) {
        fputs(i > 0 ? "," : "", file);
        put_estimate(file, &estimates[i]);
    }
    fputc(']', file);
}

static void put_point(FILE *file, const struct sweep *sweep, const struct sweep_point *point)
{
    fputs("{\"values\":[", file);
    for (uint32_t i = 0; i < sweep->setting_count; i++) {
        fputs(i > 0 ? "," : "", file);
        page_put_text(file, point->values[i]);
    }
    fputs("],", file);
    put_member(file, "label", point->label);
    put_member(file, "command_line", point->command_line);
    put_member(file, "folder", point->folder);
    put_member(file, "reason", point->reason);
    fprintf(file, "\"state\":\"%s\",\"estimates\":", state_name(point->state));
    bool done = point->state == SWEEP_DONE;
    put_estimates(file, done ? point->estimates : NULL, sweep->metric_count);
    fputs(",\"deltas\":", file);
    put_estimates(file, done ? point->deltas : NULL, sweep->metric_count);
    fputc('}', file);
}

static void put_recommendations(FILE *file, const struct sweep_recommendation *recommendations,
                                uint32_t count)
{
    fputs("\"recommendations\":[", file);
    for (uint32_t i = 0; i < count; i++) {
        fputs(i > 0 ? ",\n{" : "{", file);
        put_member(file, "name", recommendations[i].name);
        put_member(file, "rule", recommendations[i].rule);
        fprintf(file, "\"point\":%" PRId64 "}", recommendations[i].point);
    }
    fputc(']', file);
}

void page_put_sweep(FILE *file, const struct sweep *sweep,
                    const struct sweep_recommendation *recommendations, uint32_t count)
{
    fputs("{\n", file);
    put_member(file, "title", sweep->title);
    put_member(file, "scene", sweep->scene);
    put_member(file, "machine", sweep->machine);
    put_member(file, "command_line", sweep->command_line);
    fprintf(file, "\n\"base\":%" PRIu32 ",\"repeats\":%" PRIu32 ",\n", sweep->base, sweep->repeats);
    put_settings(file, sweep);
    put_metrics(file, sweep);
    fputs("\"points\":[", file);
    for (uint32_t i = 0; i < sweep->point_count; i++) {
        fputs(i > 0 ? ",\n" : "", file);
        put_point(file, sweep, &sweep->points[i]);
    }
    fputs("],\n", file);
    put_recommendations(file, recommendations, count);
    fputs("}\n", file);
}
