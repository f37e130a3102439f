#include "results.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/output_file.h"

/* Writes a cell as in RFC 4180: quoted if necessary, with doubled quotes. */
static void put_cell(FILE *file, const char *text)
{
    if (text[strcspn(text, ",\"\r\n")] == '\0') {
        fputs(text, file);
        return;
    }
    fputc('"', file);
    for (; *text; text++) {
        if (*text == '"')
            fputc('"', file);
        fputc(*text, file);
    }
    fputc('"', file);
}

/* Writes a comma, and the number if it is known. */
static void put_number(FILE *file, double value)
{
    fputc(',', file);
    if (!isnan(value))
        fprintf(file, "%.10g", value);
}

static void put_text(FILE *file, const char *text)
{
    fputc(',', file);
    put_cell(file, text ? text : "");
}

static const char *state_name(enum sweep_state state)
{
    switch (state) {
    case SWEEP_PENDING: return "pending";
    case SWEEP_DONE: return "done";
    case SWEEP_FAILED: return "failed";
    }
    return "";
}

static void put_settings(FILE *file, const struct sweep *sweep, const struct sweep_point *point)
{
    for (uint32_t i = 0; i < sweep->setting_count; i++)
        put_text(file, point ? point->values[i] : sweep->settings[i].name);
}

static void put_points_header(FILE *file, const struct sweep *sweep)
{
    static const char *const parts[] = {"",      "_half_width", "_least",
                                        "_most", "_delta",      "_delta_half_width"};
    fputs("point,label,state,reason", file);
    put_settings(file, sweep, NULL);
    for (uint32_t m = 0; m < sweep->metric_count; m++)
        for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
            fprintf(file, ",%s%s", sweep->metrics[m].name, parts[i]);
    fputc('\n', file);
}

bool results_write_points(const struct sweep *sweep, const char *path)
{
    struct output_file *output = output_file_begin(path);
    if (!output)
        return false;
    FILE *file = output_file_stream(output);
    put_points_header(file, sweep);
    for (uint32_t i = 0; i < sweep->point_count; i++) {
        const struct sweep_point *point = &sweep->points[i];
        fprintf(file, "%u", i);
        put_text(file, point->label);
        put_text(file, state_name(point->state));
        put_text(file, point->reason);
        put_settings(file, sweep, point);
        for (uint32_t m = 0; m < sweep->metric_count; m++) {
            const struct sweep_estimate *e = &point->estimates[m], *d = &point->deltas[m];
            const double values[] = {e->mean, e->half_width, e->least,
                                     e->most, d->mean,       d->half_width};
            for (size_t v = 0; v < sizeof values / sizeof *values; v++)
                put_number(file, values[v]);
        }
        fputc('\n', file);
    }
    return output_file_end(output, true);
}

bool results_write_runs(const struct runs *runs, const char *path)
{
    const struct sweep *sweep = runs->sweep;
    struct output_file *output = output_file_begin(path);
    if (!output)
        return false;
    FILE *file = output_file_stream(output);
    fputs("point,label,repeat,state,reason,folder", file);
    put_settings(file, sweep, NULL);
    for (uint32_t m = 0; m < sweep->metric_count; m++)
        fprintf(file, ",%s", sweep->metrics[m].name);
    fputc('\n', file);
    for (uint32_t i = 0; i < runs->count; i++) {
        const struct run *run = &runs->items[i];
        fprintf(file, "%u", run->point);
        put_text(file, sweep->points[run->point].label);
        put_number(file, run->repeat + 1);
        put_text(file, state_name(run->state));
        put_text(file, run->reason);
        put_text(file, run->key);
        put_settings(file, sweep, &sweep->points[run->point]);
        for (uint32_t m = 0; m < sweep->metric_count; m++)
            put_number(file, figures_value(&run->figures, sweep->metrics[m].name));
        fputc('\n', file);
    }
    return output_file_end(output, true);
}
