/**
 * Renders scenes of pbrt with geometry, materials and textures on demand; see --help.
 *
 * launches.c has the loop, world.c what is built when a ray enters a box, surfaces.c what is made
 * when a ray hits a material, and shaders/mesh.rchit in which order a hit asks for them.
 */
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
#include "camera.h"
#include "emitters.h"
#include "flight.h"
#include "lights.h"
#include "picture_output.h"
#include "statistics.h"
#include "summary.h"

#define EXIT_USAGE 2
#define EXIT_NO_DEVICE 77

struct renderer {
    struct pbrt_options options;
    struct gpu gpu;
    bool unsupported;
    struct scene scene;
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    struct textures textures;
    struct surfaces surfaces;
    struct table lights, emitters;
    struct proxies proxies;
    struct world world;
    struct film film;
    struct tracing tracing;
    struct picture picture;
    struct contact_sheet sheet;
    struct launches launches;
    struct flight flight;
    double start; ///< of the program
};

static bool create_loader(struct renderer *r)
{
    const struct pbrt_options *o = &r->options;
    const SluiceVulkanContextCreateInfo context = {
        .structSize = sizeof context,
        .queueFamilyIndex = r->gpu.family,
        .instance = r->gpu.instance,
        .physicalDevice = r->gpu.physical_device,
        .device = r->gpu.device,
        .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
        .log = {.pfnLog = log_say},
        .loaderThreadCount = o->threads,
    };
    SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info,
        .pageCapacity = PBRT_PAGE_CAPACITY,
        .memoryBudget = o->texture_budget,
        .maxRequestsPerLaunch = PBRT_MOST_REQUESTS,
    };
    SluiceResult result = sluiceCreateVulkanContext(&context, &r->context);
    info.context = r->context;
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateDemandLoader(&info, &r->loader);
    if (result == SLUICE_SUCCESS)
        return true;
    text_say("nothing can be loaded on demand: %s", sluiceGetResultName(result));
    r->unsupported = result == SLUICE_ERROR_UNSUPPORTED;
    return false;
}

static bool create_gpu(struct renderer *r)
{
    const struct gpu_request request = {
        .device = r->options.device,
        .validation = r->options.validation,
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_PAGED},
        .ray_tracing = r->options.path != PATH_COMPUTE,
        .build_queue = r->options.path != PATH_COMPUTE,
        .buffer_addresses = true};
    if (!gpu_create(&request, &r->gpu, &r->unsupported))
        return false;
    r->unsupported =
        !r->gpu.buffer_addresses || (r->options.path == PATH_PIPELINE && !r->gpu.ray_tracing);
    if (!r->gpu.buffer_addresses)
        text_say("%s has no addresses of buffers", r->gpu.properties.deviceName);
    else if (request.ray_tracing && !r->gpu.ray_tracing)
        text_say("%s has no ray-tracing pipeline%s", r->gpu.properties.deviceName,
                 r->unsupported ? "" : ": rays are traced in a compute shader, which is slower");
    return !r->unsupported && create_loader(r);
}

/* Before anything takes its time. */
static bool can_write_outputs(const struct pbrt_options *o)
{
    const char *const paths[] = {o->file, o->dump, o->statistics, o->contact_sheet, o->bounds};
    bool good = output_add_input(o->scene) && picture_output_is_known(o->file);
    for (size_t i = 0; i < sizeof paths / sizeof *paths && good; i++)
        good = !paths[i] || output_can_write(paths[i]);
    return good && (!o->sequence || files_make_folders(o->sequence));
}

/** FILE.cache beside the picture, unless --cache names a folder. */
static bool create_textures(struct renderer *r)
{
    char cache[4096];
    const struct pbrt_options *o = &r->options;
    snprintf(cache, sizeof cache, "%s", o->cache ? o->cache : o->file);
    if (!o->cache)
        strncat(cache, ".cache", sizeof cache - strlen(cache) - 1);
    if (!textures_create(r->loader, cache, o->threads, &r->textures))
        return false;
    r->textures.max_anisotropy = (float)o->anisotropy;
    r->textures.says_what_it_reads = o->verbose_loading;
    return true;
}

static bool create_world(struct renderer *r)
{
    const struct pbrt_options *o = &r->options;
    struct proxies *proxies = o->preload ? NULL : &r->proxies;
    if ((proxies && !proxies_create(r->loader, &r->scene, proxies)) ||
        !world_create(&r->gpu, &r->scene, &r->surfaces, o->preload_shapes ? NULL : proxies,
                      o->granularity == 1, o->threads, &r->world))
        return false;
    r->world.budget = o->budget;
    r->surfaces.budget = o->material_budget;
    r->world.meshes.uncompacted = o->uncompacted;
    r->world.meshes.says_what_it_reads = o->verbose_loading;
    r->surfaces.says_what_it_makes = o->verbose_loading;
    return world_begin(&r->world);
}

static bool open_all(struct renderer *r)
{
    const struct pbrt_options *o = &r->options;
    uint32_t size[2];
    bool only_areas = false;
    if (!can_write_outputs(o) || !scene_open(o->scene, o->bounds, &r->scene))
        return false;
    if (!o->preload && !o->preload_shapes && !scene_cluster(&r->scene, o->cluster_size))
        return false;
    if (o->dump && !scene_dump(&r->scene, o->dump))
        return false;
    camera_size(&r->scene, o, size);
    struct PbrtLaunch *c = &r->launches.constants;
    if (!create_gpu(r) || !create_textures(r) ||
        !surfaces_create(&r->gpu, &r->scene, &r->surfaces) ||
        !lights_create(&r->gpu, &r->scene, &r->textures, &r->lights, &only_areas) ||
        !emitters_create(&r->gpu, &r->scene, o->mode == PBRT_MODE_PATH, &r->lights, &r->emitters) ||
        !create_world(r) ||
        !film_create(&r->gpu, size[0], size[1], (struct film_share){0}, &r->film) ||
        !picture_create(size[0], size[1], &r->picture) ||
        !tracing_create(&r->gpu, r->loader, &r->tracing))
        return false;
    float camera[12];
    camera_matrix(&r->scene, &o->camera, camera);
    camera_constants(&r->scene, camera, size, c);
    flight_place_camera(&r->scene, o, size, o->fly_at, c);
    lights_constants(&r->scene, o, only_areas, r->emitters.count, c);
    return true;
}

static void close_all(struct renderer *r)
{
    if (r->gpu.device) {
        vkDeviceWaitIdle(r->gpu.device);
        launches_finish(&r->launches);
        flight_finish(&r->flight);
        tracing_destroy(&r->gpu, &r->tracing);
        film_destroy(&r->gpu, &r->film);
        proxies_finish(&r->gpu, &r->world.structures, &r->proxies);
        world_finish(&r->world);
        surfaces_finish(&r->gpu, &r->surfaces);
        table_finish(&r->gpu, &r->lights);
        table_finish(&r->gpu, &r->emitters);
    }
    sluiceDestroyDemandLoader(r->loader);
    sluiceDestroyVulkanContext(r->context);
    textures_finish(&r->textures);
    gpu_destroy(&r->gpu);
    picture_destroy(&r->picture);
    contact_sheet_finish(&r->sheet);
    scene_finish(&r->scene);
}

static bool add_to_sheet(struct renderer *r)
{
    char caption[96];
    const double share = 100.0 * r->film.missing_count / ((double)r->film.width * r->film.height);
    const bool is_small = share > 0.0 && share < 10.0;
    snprintf(caption, sizeof caption, "launch %u: %llu shapes, %.*f%% missing", r->launches.count,
             (unsigned long long)r->world.entered_count, is_small ? 1 : 0, share);
    return contact_sheet_add(&r->sheet, &r->picture, r->options.exposure, caption);
}

static void tell_debug(const struct renderer *r)
{
    static const char *const kinds[] = {"is not traced", "hits nothing", "hits box", "hits shape"};
    struct PbrtDebug *d = r->launches.debug.mapped;
    if (d->pixel == PBRT_NONE || d->kind > 3)
        return;
    fprintf(stderr, "launch %u: pixel %u/%u %s", r->launches.count, r->options.debug[0],
            r->options.debug[1], kinds[d->kind]);
    if (d->kind == 3) {
        const SluicePbrtShape shape = scene_shape(&r->scene, r->world.places[d->place].node.shape);
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
    const struct pbrt_options *o = &r->options;
    char path[4096];
    tell_debug(r);
    if (!o->sequence && !o->contact_sheet)
        return true;
    if (!film_read(&r->gpu, &r->film, &r->picture))
        return false;
    snprintf(path, sizeof path, "%s/launch-%05u.png", o->sequence ? o->sequence : "",
             r->launches.count);
    return (!o->sequence || picture_output_write(&r->picture, o->exposure, path)) &&
           (!o->contact_sheet || add_to_sheet(r));
}

static bool write_files(struct renderer *r)
{
    const struct pbrt_options *o = &r->options;
    const struct summary summary = {&r->launches, clock_seconds() - r->start};
    if (!film_read(&r->gpu, &r->film, &r->picture) ||
        !picture_output_write(&r->picture, o->exposure, o->file) ||
        (o->contact_sheet && !contact_sheet_write(&r->sheet, o->contact_sheet)))
        return false;
    r->launches.after_launch = NULL;
    if (o->repeat > 0 && r->film.missing_count == 0 && !launches_repeat(&r->launches, o->repeat))
        return false;
    if (o->statistics && !statistics_write(&r->launches, o->scene, o->statistics))
        return false;
    if (o->json)
        gpu_print_json(&r->gpu);
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
    return r->options.fly == 0 || flight_run(&r->launches, &r->flight);
}

static bool render(struct renderer *r)
{
    const struct PbrtLaunch constants = r->launches.constants;
    r->picture.plain = true;
    r->launches = (struct launches){.gpu = &r->gpu,
                                    .options = &r->options,
                                    .scene = &r->scene,
                                    .loader = r->loader,
                                    .tracing = &r->tracing,
                                    .world = &r->world,
                                    .surfaces = &r->surfaces,
                                    .textures = &r->textures,
                                    .proxies = r->options.preload ? NULL : &r->proxies,
                                    .film = &r->film,
                                    .lights = &r->lights,
                                    .emitters = &r->emitters,
                                    .constants = constants,
                                    .user_data = r,
                                    .after_launch = after_launch};
    if (!launches_create(&r->launches) || (r->options.preload && !launches_preload(&r->launches)) ||
        !fly(r) || !launches_run(&r->launches))
        return false;
    const uint32_t missing = r->film.missing_count;
    if (missing > 0)
        fprintf(stderr, "%u pixels are still missing after %u launches\n", missing,
                r->launches.count);
    return write_files(r) && missing == 0;
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
    uint32_t messages = atomic_load(&renderer.gpu.validation_messages);
    if (messages > 0)
        fprintf(stderr, "the validation layers had %u messages\n", messages);
    if (!opened && renderer.unsupported)
        return EXIT_NO_DEVICE;
    return done && messages == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
