#include "summary.h"

#include <math.h>
#include <stdio.h>
#include <sys/resource.h>

#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

void summary_print_figure(const struct figure *figure, bool json)
{
    char value[32];
    const bool whole = figure->value == floor(figure->value) && fabs(figure->value) < 1e15;
    snprintf(value, sizeof value, whole ? "%.0f" : "%.7g", figure->value);
    if (json)
        printf("{\"name\": \"%s\", \"value\": %s, \"unit\": \"%s\"}\n", figure->name, value,
               figure->unit);
    else
        printf("%-22s %16s %s\n", figure->name, value, figure->unit);
}

/* Linux counts it in KiB. */
static double peak_host_bytes(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (double)usage.ru_maxrss * 1024.0 : 0.0;
}

/** Of instances, and shapes of no object, that are boxes or in clusters: all memory for boxes and
 *  clusters, their structure among it. */
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

bool summary_print(const struct summary *s, bool json)
{
    const struct launches *l = s->launches;
    const struct world *w = l->world;
    SluiceDemandStatistics d = {.structSize = sizeof d};
    if (sluiceGetDemandStatistics(l->loader, &d) != SLUICE_SUCCESS)
        return false;
    const double pixels = (double)l->film->width * l->film->height;
    const double rate = l->repeat_seconds > 0.0 ? pixels / l->repeat_seconds / 1e6 : 0.0;
    const double resolve =
        w->resolved_count ? 1e6 * w->resolve_seconds / (double)w->resolved_count : 0.0;
    const double per_node = bytes_per_unresolved(l);
    const struct figure figures[] = {
        {"launches", "", l->count},
        {"ray_tracing_pipeline", "", l->gpu->ray_tracing},
        {"build_queue", "", l->gpu->has_build_queue},
        {"launches_without_rays", "", l->idle_count},
        {"samples_complete", "per pixel", l->sample_count},
        {"pixels_missing", "", l->film->missing_count},
        {"rays_from_camera", "", (double)l->ray_count},
        {"shapes_placed", "", (double)l->scene->place_count},
        {"shapes_entered", "", (double)w->entered_count},
        {"boxes_added", "", l->proxies ? (double)l->proxies->added_count : 0.0},
        {"boxes_left", "", l->proxies ? proxies_box_count(l->proxies) : 0.0},
        {"boxes_added_most", "by one", (double)w->most_added},
        {"bytes_per_box", "B", l->proxies ? l->proxies->bytes_per_box : 0.0},
        {"bytes_per_unresolved", "B", per_node},
        {"geometries_built", "", (double)w->meshes.built_count},
        {"geometries_failed", "", (double)w->meshes.failed_count},
        {"geometries_evicted", "", (double)w->meshes.evicted_count},
        {"triangles_built", "", (double)w->meshes.triangle_count},
        {"materials", "", l->surfaces->material_count},
        {"materials_realized", "", (double)l->surfaces->material_realized_count},
        {"materials_evicted", "with alphas", (double)l->surfaces->evicted_count},
        {"material_bytes", "B", (double)surfaces_size(l->surfaces)},
        {"alphas_realized", "", (double)l->surfaces->alpha_realized_count},
        {"textures_opened", "", (double)d.texturesOpened},
        {"textures_failed", "", (double)d.texturesFailed},
        {"tiles_loaded", "", (double)l->tile_count},
        {"lod_bias", "levels", d.lodBias},
        {"parse_seconds", "s", l->scene->parse_seconds},
        {"bounds_seconds", "s", l->scene->bounds_seconds},
        {"cluster_seconds", "s", l->scene->cluster_seconds},
        {"clusters", "", (l->scene->clusters.tree.node_count + 1) / 2},
        {"read_seconds", "s", w->meshes.read_seconds},
        {"build_seconds", "s", w->meshes.build_seconds},
        {"top_level_seconds", "s", w->top_seconds},
        {"tree_items_built", "", (double)w->tree.tree.built_count},
        {"resolve_per_1000", "ms", resolve},
        {"trace_seconds", "s", l->trace_seconds},
        {"complete_seconds", "s", s->complete_seconds},
        {"repeat_rate", "Mpixel/s", rate},
        {"geometry_bytes_peak", "B", (double)w->peak_size},
        {"geometry_bytes", "B", (double)w->meshes.size},
        {"peak_host_bytes", "B", peak_host_bytes()},
        {"peak_device_bytes", "B", (double)l->peak_device},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        summary_print_figure(&figures[i], json);
    return text_flush("");
}
