#include "device.h"

#include "../../tools/common/clock.h"
#include "../../tools/common/log.h"
#include "../../tools/common/text.h"
#include "camera.h"
#include "emitters.h"
#include "flight.h"
#include "lights.h"

bool device_create(struct shared *shared, const struct device *first, const char *name,
                   struct device *d)
{
    const struct pbrt_options *o = shared->options;
    const struct gpu_request request = {
        .device = name,
        .validation = o->validation,
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_PAGED},
        .ray_tracing = o->path != PATH_COMPUTE,
        .build_queue = o->path != PATH_COMPUTE,
        .buffer_addresses = true,
        .first = first ? &first->gpu : NULL};
    d->shared = shared;
    if (!gpu_create(&request, &d->gpu, &d->unsupported))
        return false;
    d->unsupported = !d->gpu.buffer_addresses || (o->path == PATH_PIPELINE && !d->gpu.ray_tracing);
    if (!d->gpu.buffer_addresses)
        text_say("%s has no addresses of buffers", d->gpu.properties.deviceName);
    else if (request.ray_tracing && !d->gpu.ray_tracing)
        text_say("%s has no ray-tracing pipeline%s", d->gpu.properties.deviceName,
                 d->unsupported ? "" : ": rays are traced in a compute shader, which is slower");
    return true;
}

static bool create_loader(struct device *d)
{
    const struct pbrt_options *o = d->shared->options;
    const SluiceVulkanContextCreateInfo context = {
        .structSize = sizeof context,
        .queueFamilyIndex = d->gpu.family,
        .instance = d->gpu.instance,
        .physicalDevice = d->gpu.physical_device,
        .device = d->gpu.device,
        .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
        .log = {.pfnLog = log_say},
        .loaderThreadCount = d->shared->pool ? 0 : o->threads,
        .readPool = d->shared->pool,
    };
    SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info,
        .pageCapacity = PBRT_PAGE_CAPACITY,
        .memoryBudget = o->texture_budget,
        .maxRequestsPerLaunch = PBRT_MOST_REQUESTS,
    };
    SluiceResult result = sluiceCreateVulkanContext(&context, &d->context);
    info.context = d->context;
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateDemandLoader(&info, &d->loader);
    if (result == SLUICE_SUCCESS)
        return true;
    text_say("nothing can be loaded on demand: %s", sluiceGetResultName(result));
    d->unsupported = result == SLUICE_ERROR_UNSUPPORTED;
    return false;
}

static bool create_world(struct device *d)
{
    const struct pbrt_options *o = d->shared->options;
    const struct mesh_reading reading = {d->shared->meshes, d->index, o->threads};
    struct proxies *proxies = o->preload ? NULL : &d->proxies;
    if ((proxies && !proxies_create(d->loader, &d->shared->scene, proxies)) ||
        !world_create(&d->gpu, &d->shared->scene, &d->surfaces, o->preload_shapes ? NULL : proxies,
                      o->granularity == 1, &reading, &d->world))
        return false;
    d->world.budget = o->budget;
    d->surfaces.budget = o->material_budget;
    d->world.meshes.uncompacted = o->uncompacted;
    d->world.meshes.says_what_it_reads = o->verbose_loading;
    d->surfaces.says_what_it_makes = o->verbose_loading;
    return world_begin(&d->world);
}

static void set_constants(struct device *d, bool only_areas)
{
    const struct pbrt_options *o = d->shared->options;
    const struct scene *scene = &d->shared->scene;
    struct PbrtLaunch *c = &d->constants;
    float camera[12];
    camera_matrix(scene, &o->camera, camera);
    camera_constants(scene, camera, d->shared->size, c);
    lights_constants(scene, o, only_areas, d->emitters.count, c);
}

static bool open_launches(struct device *d)
{
    const struct pbrt_options *o = d->shared->options;
    d->launches = (struct launches){.gpu = &d->gpu,
                                    .options = o,
                                    .scene = &d->shared->scene,
                                    .loader = d->loader,
                                    .tracing = &d->tracing,
                                    .world = &d->world,
                                    .surfaces = &d->surfaces,
                                    .textures = &d->textures,
                                    .proxies = o->preload ? NULL : &d->proxies,
                                    .film = &d->film,
                                    .lights = &d->lights,
                                    .emitters = &d->emitters,
                                    .constants = d->constants,
                                    .user_data = d};
    return launches_create(&d->launches) && (!o->preload || launches_preload(&d->launches));
}

bool device_open(struct device *d, struct film_share share)
{
    struct shared *s = d->shared;
    const struct scene *scene = &s->scene;
    const bool paths = s->options->mode == PBRT_MODE_PATH;
    bool only_areas = false;
    if (!create_loader(d))
        return false;
    textures_create(d->loader, &s->pictures, &d->textures);
    d->textures.max_anisotropy = (float)s->options->anisotropy;
    if (!surfaces_create(&d->gpu, scene, &d->surfaces) ||
        !lights_create(&d->gpu, scene, &d->textures, &d->lights, &only_areas) ||
        !emitters_create(&d->gpu, scene, paths, &d->lights, &d->emitters) || !create_world(d) ||
        !film_create(&d->gpu, s->size[0], s->size[1], share, &d->film) ||
        !tracing_create(&d->gpu, d->loader, false, &d->tracing))
        return false;
    set_constants(d, only_areas);
    return open_launches(d);
}

void device_destroy(struct device *d)
{
    if (d->gpu.device) {
        vkDeviceWaitIdle(d->gpu.device);
        launches_finish(&d->launches);
        tracing_destroy(&d->gpu, &d->tracing);
        film_destroy(&d->gpu, &d->film);
        proxies_finish(&d->gpu, &d->world.structures, &d->proxies);
        world_finish(&d->world);
        surfaces_finish(&d->gpu, &d->surfaces);
        table_finish(&d->gpu, &d->lights);
        table_finish(&d->gpu, &d->emitters);
    }
    sluiceDestroyDemandLoader(d->loader);
    sluiceDestroyVulkanContext(d->context);
    textures_finish(&d->textures);
    gpu_destroy(&d->gpu);
}

bool device_render(struct device *d, double way, struct picture *picture)
{
    const double start = clock_seconds();
    const struct shared *s = d->shared;
    if (d->picture_count > 0)
        film_clear(&d->film);
    d->launches.constants = d->constants;
    flight_place_camera(&s->scene, s->options, s->size, way, &d->launches.constants);
    if (!launches_run(&d->launches) || !film_read(&d->gpu, &d->film, picture))
        return false;
    d->missing_count += d->film.missing_count;
    d->picture_count++;
    d->end = clock_seconds();
    d->busy_seconds += d->end - start;
    return true;
}
