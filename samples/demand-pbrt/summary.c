#include "summary.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

void summary_print_figure(const struct figure *figure, bool json)
{
    char value[32];
    const bool whole = figure->value == floor(figure->value) && fabs(figure->value) < 1e15;
    snprintf(value, sizeof value, whole ? "%.0f" : "%.7g", figure->value);
    if (isnan(figure->value) && !json)
        return;
    if (isnan(figure->value))
        snprintf(value, sizeof value, "null");
    if (json)
        printf("{\"name\": \"%s\", \"value\": %s, \"unit\": \"%s\"}\n", figure->name, value,
               figure->unit);
    else
        printf("%-22s %16s %s\n", figure->name, value, figure->unit);
}

/* ru_maxrss is in KiB on Linux. */
static double peak_host_bytes(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (double)usage.ru_maxrss * 1024.0 : 0.0;
}

/** Bytes per unresolved node: memory of boxes and clusters, divided by the instances and free
 * shapes that are still in boxes or clusters. */
static double bytes_per_unresolved(const struct launches *l)
{
    const struct scene *scene = l->scene;
    const struct box_tree *tree = &scene->clusters.tree;
    const double clusters =
        (double)tree->node_count * sizeof *tree->nodes +
        (tree->node_count > 0 ? (double)scene->node_count * sizeof *tree->order : 0.0);
    if (!l->world->proxies || l->world->resolved_nodes >= scene->node_count)
        return 0.0;
    return (clusters + proxies_memory(l->proxies)) /
           (double)(scene->node_count - l->world->resolved_nodes);
}

/** Rules that combine the figures of several devices. */
enum rule { FIRST, SUM, MOST };

struct device_figure {
    enum rule rule;
    const char *name, *unit;
    double value;
};

#define MOST_FIGURES 64

/** Returns the number of figures. Returns 0 on error and reports it on stderr. */
static size_t list_figures(const struct device *device, struct device_figure list[MOST_FIGURES])
{
    const struct launches *l = &device->launches;
    const struct world *w = l->world;
    SluiceDemandStatistics d = {.structSize = sizeof d};
    SluiceResult result = sluiceGetDemandStatistics(l->loader, &d);
    if (result != SLUICE_SUCCESS) {
        text_say("there are no statistics: %s", sluiceGetResultName(result));
        return 0;
    }
    const double resolve =
        w->resolved_count ? 1e6 * w->resolve_seconds / (double)w->resolved_count : 0.0;
    const double per_node = bytes_per_unresolved(l);
    const struct device_figure figures[] = {
        {SUM, "launches", "", l->count},
        {FIRST, "ray_tracing_pipeline", "", l->gpu->ray_tracing},
        {FIRST, "build_queue", "", l->gpu->has_build_queue},
        {SUM, "launches_without_rays", "", l->idle_count},
        {SUM, "pixels_missing", "", (double)device->missing_count},
        {SUM, "rays_from_camera", "", (double)l->ray_count},
        {FIRST, "shapes_placed", "", (double)l->scene->place_count},
        {SUM, "shapes_entered", "", (double)w->entered_count},
        {SUM, "boxes_added", "", l->proxies ? (double)l->proxies->added_count : 0.0},
        {SUM, "boxes_left", "", l->proxies ? proxies_box_count(l->proxies) : 0.0},
        {MOST, "boxes_added_most", "by one", (double)w->most_added},
        {MOST, "bytes_per_box", "B", l->proxies ? l->proxies->bytes_per_box : 0.0},
        {MOST, "bytes_per_unresolved", "B", per_node},
        {SUM, "geometries_built", "", (double)w->meshes.built_count},
        {SUM, "geometries_failed", "", (double)w->meshes.failed_count},
        {SUM, "geometries_evicted", "", (double)w->meshes.evicted_count},
        {SUM, "triangles_built", "", (double)w->meshes.triangle_count},
        {FIRST, "materials", "", l->surfaces->material_count},
        {SUM, "materials_realized", "", (double)l->surfaces->material_realized_count},
        {SUM, "materials_evicted", "with alphas", (double)l->surfaces->evicted_count},
        {SUM, "material_bytes", "B", (double)surfaces_size(l->surfaces)},
        {SUM, "alphas_realized", "", (double)l->surfaces->alpha_realized_count},
        {SUM, "textures_opened", "", (double)d.texturesOpened},
        {SUM, "textures_failed", "", (double)d.texturesFailed},
        {SUM, "tiles_loaded", "", (double)l->tile_count},
        {MOST, "lod_bias", "levels", d.lodBias},
        {FIRST, "parse_seconds", "s", l->scene->parse_seconds},
        {FIRST, "bounds_seconds", "s", l->scene->bounds_seconds},
        {FIRST, "cluster_seconds", "s", l->scene->cluster_seconds},
        {FIRST, "clusters", "", (l->scene->clusters.tree.node_count + 1) / 2},
        {SUM, "read_seconds", "s", w->meshes.read_seconds},
        {SUM, "build_seconds", "s", w->meshes.build_seconds},
        {SUM, "top_level_seconds", "s", w->top_seconds},
        {SUM, "tree_items_built", "", (double)w->tree.tree.built_count},
        {MOST, "resolve_per_1000", "ms", resolve},
        {SUM, "trace_seconds", "s", l->trace_seconds},
        {SUM, "geometry_bytes_peak", "B", (double)w->peak_size},
        {SUM, "geometry_bytes", "B", (double)w->meshes.size},
        {SUM, "peak_device_bytes", "B", (double)l->peak_device},
    };
    const size_t count = sizeof figures / sizeof *figures;
    _Static_assert(sizeof figures / sizeof *figures <= MOST_FIGURES, "there is room");
    memcpy(list, figures, sizeof figures);
    return count;
}

static void merge(struct device_figure *sum, const struct device_figure *figure)
{
    if (sum->rule == SUM)
        sum->value += figure->value;
    else if (sum->rule == MOST)
        sum->value = fmax(sum->value, figure->value);
}

/** Returns NAN without elapsed time. */
static double rate(double count, double seconds)
{
    return seconds > 0.0 && count > 0.0 ? count / seconds : NAN;
}

/** Prints rates over the complete pictures. All devices share one clock. */
static void print_rates(const struct summary *s, bool json)
{
    double paths = 0.0, fill_paths = 0.0, fill_tiles = 0.0, end = s->trace_start, repeat = 0.0;
    double fill_end = 0.0, first_end = INFINITY, complete = INFINITY;
    for (uint32_t i = 0; i < s->device_count; i++) {
        const struct device *d = &s->devices[i];
        const struct launches *l = &d->launches;
        if (d->picture_count == 0)
            continue;
        const double filled = l->fill_end > 0.0 ? l->fill_end : INFINITY;
        paths += (double)l->path_count;
        fill_paths += (double)l->fill_paths;
        fill_tiles += (double)l->fill_count;
        end = fmax(end, d->end);
        fill_end = fmax(fill_end, filled);
        first_end = fmin(first_end, filled);
        complete = fmin(complete, l->sample_count);
        repeat = fmax(repeat, l->repeat_seconds);
    }
    const double pixels = (double)s->devices[0].film.width * s->devices[0].film.height;
    const double fill = isfinite(fill_end) ? fill_end - s->trace_start : NAN;
    uint64_t read_count, shared_count;
    mesh_cache_get_counts(s->devices[0].shared->meshes, &read_count, &shared_count);
    const struct figure figures[] = {
        {"devices", "", s->device_count},
        {"samples_complete", "per pixel", complete},
        {"complete_seconds", "s", end - s->start},
        {"path_rate", "Mpaths/s", 1e-6 * rate(paths, end - s->trace_start)},
        {"path_rate_later", "Mpaths/s", 1e-6 * rate(paths - fill_paths, end - first_end)},
        {"fill_time", "s", fill},
        {"fill_rate", "tiles/s", rate(fill_tiles, fill)},
        {"repeat_rate", "Mpixel/s", repeat > 0.0 ? 1e-6 * pixels / repeat : 0.0},
        {"meshes_read", "", (double)read_count},
        {"meshes_shared", "", (double)shared_count},
        {"peak_host_bytes", "B", peak_host_bytes()},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        summary_print_figure(&figures[i], json);
}

/** Prints figures per device. */
static void print_device(const struct device *d, const struct device_figure *list, size_t count,
                         bool json)
{
    static const char *const names[] = {"launches",         "rays_from_camera", "shapes_entered",
                                        "triangles_built",  "tiles_loaded",     "geometry_bytes",
                                        "peak_device_bytes"};
    char name[64];
    if (json) {
        printf("{\"name\": \"device_%u\", \"value\": ", d->index);
        text_write_json(stdout, d->gpu.properties.deviceName);
        printf(", \"unit\": \"\"}\n");
    }
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < sizeof names / sizeof *names; j++)
            if (strcmp(list[i].name, names[j]) == 0) {
                snprintf(name, sizeof name, "device_%u_%s", d->index, names[j]);
                summary_print_figure(&(struct figure){name, list[i].unit, list[i].value}, json);
            }
    snprintf(name, sizeof name, "device_%u_pictures", d->index);
    summary_print_figure(&(struct figure){name, "", d->picture_count}, json);
    snprintf(name, sizeof name, "device_%u_time", d->index);
    summary_print_figure(&(struct figure){name, "s", d->busy_seconds}, json);
}

static void print_pool_figure(const char *name, const char *unit, double value, bool json)
{
    summary_print_figure(&(struct figure){name, unit, value}, json);
}

static void print_place(const struct pbrt_options *o)
{
    const char *ending = strrchr(o->file, '.');
    char name[4096];
    if (o->animation > 0 && ending)
        snprintf(name, sizeof name, "%.*s-NNNN%s", (int)(ending - o->file), o->file, ending);
    else
        snprintf(name, sizeof name, "%s", o->file);
    fputs(o->animation > 0 ? "the pictures are " : "the picture is ", stdout);
    text_write(stdout, name);
    putchar('\n');
}

bool summary_print(const struct summary *s, bool json)
{
    struct device_figure sum[MOST_FIGURES], list[MOST_FIGURES];
    const size_t count = list_figures(&s->devices[0], sum);
    for (uint32_t i = 1; i < s->device_count && count > 0; i++) {
        if (list_figures(&s->devices[i], list) == 0)
            return false;
        for (size_t j = 0; j < count; j++)
            merge(&sum[j], &list[j]);
    }
    for (size_t i = 0; i < count; i++)
        summary_print_figure(&(struct figure){sum[i].name, sum[i].unit, sum[i].value}, json);
    if (count == 0)
        return false;
    print_rates(s, json);
    read_sharing_print(s->devices[0].shared->pool, print_pool_figure, json);
    for (uint32_t i = 0; i < s->device_count && s->device_count > 1; i++) {
        if (list_figures(&s->devices[i], list) == 0)
            return false;
        print_device(&s->devices[i], list, count, json);
    }
    if (!json)
        print_place(s->devices[0].shared->options);
    return text_flush("");
}
