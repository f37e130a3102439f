#include "results.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "../common/output_file.h"
#include "../common/text.h"
#include "../sluice-replay/file.h"
#include "statistics.h"

static bool is_measured(const struct runs *runs, const char *name)
{
    for (uint32_t i = 0; i < runs->count; i++)
        if (!isnan(figures_value(&runs->items[i].figures, name)))
            return true;
    return false;
}

static const struct scene_metric *find_metric(const struct scene *scene, const char *name)
{
    for (uint32_t i = 0; i < scene->metric_count; i++)
        if (strcmp(scene->metrics[i].metric.name, name) == 0)
            return &scene->metrics[i];
    return NULL;
}

static void collect_metrics(const struct runs *runs, struct sweep *sweep)
{
    const struct scene *scene = runs->options->scene;
    struct sweep_metric *metrics = memory_take(scene->metric_count, sizeof *metrics);
    sweep->metric_count = 0;
    for (uint32_t i = 0; i < scene->metric_count; i++)
        if (is_measured(runs, scene->metrics[i].metric.name))
            metrics[sweep->metric_count++] = scene->metrics[i].metric;
    sweep->metrics = metrics;
}

/* Writes a point's values by repeat. NaN: unknown. */
static void get_values(const struct runs *runs, uint32_t point, const char *name, double *values)
{
    const struct scene_metric *metric = find_metric(runs->options->scene, name);
    uint32_t repeats = runs->sweep->repeats;
    for (uint32_t r = 0; r < repeats; r++)
        values[r] = figures_value(&runs->items[r * runs->sweep->point_count + point].figures, name);
    if (metric && metric->is_time && repeats > 1)
        values[0] = NAN;
}

static void estimate_point(const struct runs *runs, struct sweep *sweep, uint32_t index)
{
    struct sweep_point *point = &sweep->points[index];
    double *base = memory_take(sweep->repeats, sizeof *base);
    point->estimates = memory_take(sweep->metric_count, sizeof *point->estimates);
    point->deltas = memory_take(sweep->metric_count, sizeof *point->deltas);
    point->measured =
        memory_take((size_t)sweep->metric_count * sweep->repeats, sizeof *point->measured);
    for (uint32_t m = 0; m < sweep->metric_count; m++) {
        double *values = point->measured + (size_t)m * sweep->repeats;
        get_values(runs, index, sweep->metrics[m].name, values);
        get_values(runs, sweep->base, sweep->metrics[m].name, base);
        bool decibels = strcmp(sweep->metrics[m].unit, "dB") == 0;
        point->estimates[m] = decibels ? statistics_decibels(values, sweep->repeats)
                                       : statistics_estimate(values, sweep->repeats);
        point->deltas[m] = decibels ? statistics_paired_decibels(values, base, sweep->repeats)
                                    : statistics_paired(values, base, sweep->repeats);
    }
    free(base);
}

static void judge_point(const struct runs *runs, struct sweep *sweep, uint32_t index)
{
    struct sweep_point *point = &sweep->points[index];
    const struct run *first = &runs->items[index];
    struct text_list arguments = {0};
    uint32_t done = 0;
    point->state = SWEEP_PENDING;
    for (uint32_t i = index; i < runs->count; i += sweep->point_count) {
        done += runs->items[i].state == SWEEP_DONE;
        if (runs->items[i].state != SWEEP_FAILED || point->state == SWEEP_FAILED)
            continue;
        point->state = SWEEP_FAILED;
        point->reason = memory_copy_text(runs->items[i].reason ? runs->items[i].reason : "");
    }
    if (done == sweep->repeats)
        point->state = SWEEP_DONE;
    /* A command line to paste into a shell must not overwrite measurements. */
    char *again = memory_text("%s/again", runs->results);
    runs_add_arguments(runs, first, again, &arguments);
    point->command_line = text_list_join(&arguments);
    free(again);
    point->folder = memory_copy_text(first->folder);
    text_list_finish(&arguments);
}

/* Returns a text that some run printed, or NULL. */
static const char *find_text(const struct runs *runs, const char *name)
{
    for (uint32_t i = 0; i < runs->count; i++) {
        const struct figure *figure = figures_find(&runs->items[i].figures, name);
        if (figure && figure->text && *figure->text)
            return figure->text;
    }
    return NULL;
}

/* Returns whether all runs agree. Runs are kept whatever drew them, so devices may differ. */
static bool is_of_one(const struct runs *runs, const char *name)
{
    const char *first = find_text(runs, name);
    for (uint32_t i = 0; i < runs->count && first; i++) {
        const struct figure *figure = figures_find(&runs->items[i].figures, name);
        if (figure && figure->text && strcmp(figure->text, first) != 0)
            return false;
    }
    return true;
}

/* Describes device and driver, if some run printed them, and this machine. */
static char *describe_this_machine(const struct runs *runs)
{
    struct utsname system = {0};
    const char *device = find_text(runs, "device"), *driver = find_text(runs, "driver");
    const char *others =
        is_of_one(runs, "device") && is_of_one(runs, "driver") ? "" : " and others";
    uname(&system);
    return memory_text("%s%s%s%s%s%s%ld processors, %s %s %s", device ? device : "",
                       driver ? " (" : "", driver ? driver : "", driver ? ")" : "", others,
                       device || driver ? "; " : "", sysconf(_SC_NPROCESSORS_ONLN), system.sysname,
                       system.release, system.machine);
}

/* Reads the machine of the measurement, which may not be this one. */
static char *recall_machine(const struct runs *runs)
{
    size_t size;
    char *line = NULL, *path = memory_text("%s/machine.txt", runs->results);
    read_file(path, &line, &size);
    free(path);
    if (line)
        line[strcspn(line, "\n")] = '\0';
    return line;
}

bool results_remember_machine(const struct runs *runs)
{
    char *path = memory_text("%s/machine.txt", runs->results);
    char *line = describe_this_machine(runs);
    if (!is_of_one(runs, "device") || !is_of_one(runs, "driver"))
        text_say(
            "sluice-tradeoff: these runs are of several devices or drivers: --fresh makes them "
            "anew");
    bool written = output_file_print(path, "%s\n", line);
    free(line);
    free(path);
    return written;
}

void results_collect(const struct runs *runs, struct sweep *sweep)
{
    collect_metrics(runs, sweep);
    for (uint32_t i = 0; i < sweep->point_count; i++) {
        judge_point(runs, sweep, i);
        estimate_point(runs, sweep, i);
    }
    sweep->machine = recall_machine(runs);
    if (!sweep->machine)
        sweep->machine = describe_this_machine(runs);
}

int results_pick(const struct sweep *sweep, const char *const *names)
{
    for (; names && *names; names++) {
        int metric = sweep_find_metric(sweep, *names);
        if (metric >= 0 && !isnan(sweep->points[sweep->base].estimates[metric].mean))
            return metric;
    }
    return -1;
}
