/**
 * Renders pbrt scenes with geometry, materials and textures on demand. See --help.
 *
 * device.c has the objects of each GPU. launches.c is the launch loop. world.c builds geometry when
 * a ray enters a box. surfaces.c makes materials that rays hit. shaders/mesh.rchit sets the order
 * in which a hit requests them.
 */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/descriptors.h"
#include "../../tools/common/files.h"
#include "../../tools/common/log.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"
#include "../common/contact_sheet.h"
#include "../common/crew.h"
#include "../common/device_crew.h"
#include "camera.h"
#include "flight.h"
#include "picture_output.h"
#include "statistics.h"
#include "summary.h"

#define EXIT_USAGE 2
#define EXIT_NO_DEVICE 77

struct renderer {
    struct pbrt_options options;
    struct shared shared;
    struct device *devices;  ///< owned
    struct device_crew crew; ///< devices as crew members
    bool unsupported;
    uint32_t validation_messages; ///< sum over all devices, read after their destruction
    struct contact_sheet sheet;
    struct flight flight; ///< camera flight; one device only
    double start;         ///< clock_seconds() at the program's start
    double trace_start;   ///< clock_seconds() at the first launch
};

static uint32_t first_picture(const struct pbrt_options *o)
{
    return o->pictures.given ? o->pictures.first - 1 : 0;
}

/** Index after the last picture. */
static uint32_t end_of_pictures(const struct pbrt_options *o)
{
    return o->pictures.given ? o->pictures.last : o->animation > 0 ? o->animation : 1;
}

/** Path of a picture: FILE, or FILE with the picture's number before its extension. */
static void name_picture(const struct pbrt_options *o, uint32_t picture, char path[4096])
{
    const char *ending = strrchr(o->file, '.');
    if (o->animation > 0 && ending)
        snprintf(path, 4096, "%.*s-%04u%s", (int)(ending - o->file), o->file, picture + 1, ending);
    else
        snprintf(path, 4096, "%s", o->file);
}

/* Checks all output paths before any long work. */
static bool can_write_outputs(const struct pbrt_options *o)
{
    const char *const paths[] = {o->dump, o->statistics, o->contact_sheet, o->bounds};
    char path[4096];
    bool good = output_add_input(o->scene) && picture_output_is_known(o->file);
    for (uint32_t i = first_picture(o); i < end_of_pictures(o) && good; i++) {
        name_picture(o, i, path);
        good = output_can_write(path);
    }
    for (size_t i = 0; i < sizeof paths / sizeof *paths && good; i++)
        good = !paths[i] || output_can_write(paths[i]);
    return good && (!o->sequence || files_make_folders(o->sequence));
}

/** Uses FILE.cache beside the picture, unless --cache names a folder. */
static bool create_pictures(struct renderer *r)
{
    char cache[4096];
    const struct pbrt_options *o = &r->options;
    snprintf(cache, sizeof cache, "%s", o->cache ? o->cache : o->file);
    if (!o->cache)
        strncat(cache, ".cache", sizeof cache - strlen(cache) - 1);
    if (!picture_files_create(cache, o->threads, &r->shared.pictures))
        return false;
    r->shared.pictures.says_what_it_reads = o->verbose_loading;
    return true;
}

static bool open_scene(struct renderer *r)
{
    const struct pbrt_options *o = &r->options;
    struct scene *scene = &r->shared.scene;
    r->shared.options = o;
    if (!can_write_outputs(o) || !scene_open(o->scene, o->bounds, NULL, scene) ||
        (!o->preload && !o->preload_shapes && !scene_cluster(scene, o->cluster_size)) ||
        (o->dump && !scene_dump(scene, o->dump)))
        return false;
    camera_size(scene, o, r->shared.size);
    return true;
}

static bool create_device(void *user_data, uint32_t index, const char *name, bool *exists)
{
    struct renderer *r = user_data;
    struct device *d = &r->devices[index];
    d->index = index;
    *exists = device_create(&r->shared, index > 0 ? r->devices : NULL, name, d);
    r->unsupported = r->unsupported || d->unsupported;
    return *exists && !d->unsupported;
}

/** Creates all devices. The first one owns the instance. */
static bool create_devices(struct renderer *r)
{
    const struct pbrt_options *o = &r->options;
    bool none = false;
    r->devices = calloc(DEVICE_LIST_MOST, sizeof *r->devices);
    const bool done = r->devices && device_crew_create(&r->crew, &o->devices, o->device,
                                                       &r->devices[0].gpu, &none);
    r->unsupported = r->unsupported || none;
    return done;
}

static bool open_device(void *user_data, uint32_t index)
{
    struct renderer *r = user_data;
    return device_open(&r->devices[index], device_crew_share(&r->crew, index));
}

static bool write_picture(void *user_data, const struct picture *picture, uint32_t index)
{
    const struct renderer *r = user_data;
    const struct pbrt_options *o = &r->options;
    char path[4096];
    name_picture(o, index, path);
    return picture_output_write(picture, o->exposure, path);
}

/** Share of the camera path, 0 to 1. */
static double way_of(const struct pbrt_options *o, uint32_t picture)
{
    return o->animation > 0 ? (picture + 1.0) / o->animation : o->fly_at;
}

static bool render_picture(void *user_data, uint32_t device, uint32_t index,
                           struct picture *picture)
{
    struct renderer *r = user_data;
    return device_render(&r->devices[device], way_of(&r->options, index), picture);
}

/** Call after the scene is open. */
static void set_up_crew(struct renderer *r)
{
    static const struct device_crew_calls calls = {create_device, render_picture, write_picture};
    const struct pbrt_options *o = &r->options;
    r->crew = (struct device_crew){.calls = &calls,
                                   .user_data = r,
                                   .split = o->split,
                                   .first_picture = first_picture(o),
                                   .end_of_pictures = end_of_pictures(o),
                                   .size = {r->shared.size[0], r->shared.size[1]},
                                   .plain = true};
}

static bool open_all(struct renderer *r)
{
    const struct pbrt_options *o = &r->options;
    if (!open_scene(r))
        return false;
    set_up_crew(r);
    if (!create_devices(r) || !create_pictures(r) ||
        !read_sharing_create(o->read_sharing, r->crew.device_count, o->threads, &r->shared.pool))
        return false;
    r->shared.meshes = mesh_cache_create(&r->shared.scene, r->crew.device_count, MESH_CACHE_BYTES);
    const bool done = r->shared.meshes && crew_run(r->crew.device_count, open_device, r);
    for (uint32_t i = 0; i < r->crew.device_count; i++)
        r->unsupported = r->unsupported || r->devices[i].unsupported;
    return done && device_crew_create_pictures(&r->crew);
}

static void close_all(struct renderer *r)
{
    flight_finish(&r->flight);
    for (uint32_t i = r->crew.device_count; i-- > 0;)
        device_destroy(&r->devices[i]);
    sluiceDestroyReadPool(r->shared.pool);
    mesh_cache_destroy(r->shared.meshes);
    picture_files_finish(&r->shared.pictures);
    device_crew_finish(&r->crew);
    contact_sheet_finish(&r->sheet);
    scene_finish(&r->shared.scene);
    if (r->devices)
        r->validation_messages = atomic_load(&r->devices[0].gpu.validation_messages);
    free(r->devices);
}

static bool add_to_sheet(struct renderer *r, const struct device *d)
{
    char caption[96];
    const double pixels = (double)d->film.width * d->film.height;
    const double share = 100.0 * d->film.missing_count / pixels;
    const bool is_small = share > 0.0 && share < 10.0;
    snprintf(caption, sizeof caption, "launch %u: %llu shapes, %.*f%% missing", d->launches.count,
             (unsigned long long)d->world.entered_count, is_small ? 1 : 0, share);
    return contact_sheet_add(&r->sheet, r->crew.picture, r->options.exposure, caption);
}

static void tell_debug(const struct renderer *r, const struct device *device)
{
    static const char *const kinds[] = {"is not traced", "hits nothing", "hits box", "hits shape"};
    struct PbrtDebug *d = device->launches.debug.mapped;
    if (d->pixel == PBRT_NONE || d->kind > 3)
        return;
    fprintf(stderr, "launch %u: pixel %u/%u %s", device->launches.count, r->options.debug[0],
            r->options.debug[1], kinds[d->kind]);
    if (d->kind == 3) {
        const SluicePbrtShape shape =
            scene_shape(&r->shared.scene, device->world.places[d->place].node.shape);
        fprintf(stderr, " of %s:%u, triangle %u, material %u, diffuse %g %g %g", shape.pFile,
                shape.line, d->triangle, shape.material, d->diffuse[0], d->diffuse[1],
                d->diffuse[2]);
    } else if (d->kind == 2) {
        fprintf(stderr, " %u", d->place);
    }
    fprintf(stderr, " at %.9g%s\n", d->distance, d->missing ? ", and something is missing" : "");
    d->kind = 0;
}

static bool after_launch(void *user_data)
{
    struct renderer *r = user_data;
    const struct device *d = &r->devices[0]; /* --verbose shows launches of a single device only */
    const struct pbrt_options *o = &r->options;
    char path[4096];
    if (atomic_load(&r->crew.ends))
        return false;
    tell_debug(r, d);
    if (!o->sequence && !o->contact_sheet)
        return true;
    if (!film_read(&d->gpu, &d->film, r->crew.picture))
        return false;
    snprintf(path, sizeof path, "%s/launch-%05u.png", o->sequence ? o->sequence : "",
             d->launches.count);
    return (!o->sequence || picture_output_write(r->crew.picture, o->exposure, path)) &&
           (!o->contact_sheet || add_to_sheet(r, d));
}

static bool repeat_share(void *user_data, uint32_t index)
{
    struct renderer *r = user_data;
    struct launches *l = &r->devices[index].launches;
    l->after_launch = NULL;
    return launches_repeat(l, r->options.repeat);
}

static bool tell(struct renderer *r, uint64_t missing)
{
    const struct pbrt_options *o = &r->options;
    const struct summary summary = {.devices = r->devices,
                                    .device_count = r->crew.device_count,
                                    .start = r->start,
                                    .trace_start = r->trace_start};
    if (o->contact_sheet && !contact_sheet_write(&r->sheet, o->contact_sheet))
        return false;
    if (o->repeat > 0 && missing == 0 && !crew_run(r->crew.device_count, repeat_share, r))
        return false;
    if (o->statistics && !statistics_write(&r->devices[0].launches, o->scene, o->statistics))
        return false;
    if (o->json)
        gpu_print_json(&r->devices[0].gpu);
    if (o->fly > 0)
        flight_print(&r->flight, o->json);
    return summary_print(&summary, o->json);
}

static double read_clock(void *user_data)
{
    (void)user_data;
    return clock_seconds();
}

static bool fly(struct renderer *r)
{
    r->flight =
        (struct flight){.frame_count = r->options.fly,
                        .budget = {.seconds = 1e-3 * r->options.frame_budget, .now = read_clock}};
    return r->options.fly == 0 || flight_run(&r->devices[0].launches, &r->flight);
}

static bool render(struct renderer *r)
{
    uint64_t missing = 0;
    if (r->crew.ring.count > 0)
        r->crew.picture =
            picture_ring_next(&r->crew.ring); /* launches of a flight are written as its pictures */
    r->trace_start = clock_seconds();
    for (uint32_t i = 0; i < r->crew.device_count; i++) {
        r->devices[i].launches.user_data = r;
        r->devices[i].launches.after_launch = after_launch;
    }
    if (!fly(r) || !device_crew_trace(&r->crew))
        return false;
    for (uint32_t i = 0; i < r->crew.device_count; i++)
        missing += r->devices[i].missing_count;
    if (missing > 0)
        fprintf(stderr, "%llu pixels are still missing after %u launches\n",
                (unsigned long long)missing, r->devices[0].launches.count);
    return tell(r, missing) && missing == 0;
}

int main(int argc, char **argv)
{
    struct renderer renderer = {.start = clock_seconds()};
    switch (pbrt_options_parse(argc, argv, &renderer.options)) {
    case OPTIONS_HELP: return text_exit_status(EXIT_SUCCESS);
    case OPTIONS_ERROR: return EXIT_USAGE;
    case OPTIONS_RUN: break;
    }
    descriptors_raise();
    if (renderer.options.list_devices)
        return text_exit_status(gpu_list_devices() > 0 ? EXIT_SUCCESS : EXIT_NO_DEVICE);
    bool opened = open_all(&renderer);
    bool done = opened && render(&renderer);
    close_all(&renderer);
    log_finish();
    const uint32_t messages = renderer.validation_messages;
    if (messages > 0)
        fprintf(stderr, "the validation layers had %u messages\n", messages);
    if (!opened && renderer.unsupported)
        return EXIT_NO_DEVICE;
    return done && messages == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
