#include "device.h"

#include <stdio.h>
#include <stdlib.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/log.h"
#include "../../tools/common/text.h"

bool device_create(const struct tracer_options *o, const struct device *first, const char *name,
                   struct device *d)
{
    const struct gpu_request request = {
        .device = name,
        .validation = o->validation,
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_PAGED},
        .ray_tracing = o->path != PATH_COMPUTE,
        .first = first ? &first->gpu : NULL};
    d->options = o;
    if (!gpu_create(&request, &d->gpu, &d->unsupported))
        return false;
    d->unsupported = o->path == PATH_PIPELINE && !d->gpu.ray_tracing;
    return true;
}

static bool create_loader(struct device *d)
{
    const struct tracer_options *o = d->options;
    const SluiceVulkanContextCreateInfo context = {
        .structSize = sizeof context,
        .queueFamilyIndex = d->gpu.family,
        .instance = d->gpu.instance,
        .physicalDevice = d->gpu.physical_device,
        .device = d->gpu.device,
        .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
        .log = {.pfnLog = log_say},
        .loaderThreadCount = d->pool ? 0 : o->threads,
        .readPool = d->pool,
    };
    SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info,
        .pageCapacity = TRACER_PAGE_CAPACITY,
        .maxRequestsPerLaunch = o->requests,
        .memoryBudget = o->budget,
    };
    SluiceResult result = sluiceCreateVulkanContext(&context, &d->context);
    info.context = d->context;
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateDemandLoader(&info, &d->loader);
    if (result == SLUICE_SUCCESS)
        return true;
    text_say("textures cannot be loaded on demand: %s", sluiceGetResultName(result));
    d->unsupported = result == SLUICE_ERROR_UNSUPPORTED;
    return false;
}

static bool add_textures(struct device *d, struct textures *textures)
{
    d->ids = calloc(textures->count + 1u, sizeof *d->ids);
    if (!d->ids)
        fprintf(stderr, "out of memory\n");
    return d->ids && textures_add(d->options, textures, d->loader, d->ids);
}

bool device_open(struct device *d, const struct scene *scene, struct textures *textures,
                 struct film_share share)
{
    const struct tracer_options *o = d->options;
    if (!create_loader(d) || !add_textures(d, textures) ||
        !film_create(&d->gpu, o->size[0], o->size[1], share, &d->film))
        return false;
    const struct renderer_request request = {.options = o,
                                             .scene = scene,
                                             .textures = textures,
                                             .texture_ids = d->ids,
                                             .loader = d->loader,
                                             .film = &d->film};
    d->launches = (struct launches){.gpu = &d->gpu,
                                    .options = o,
                                    .loader = d->loader,
                                    .renderer = &d->renderer,
                                    .film = &d->film,
                                    .texture_ids = d->ids,
                                    .texture_count = textures->count,
                                    .quiet = d->index > 0,
                                    .user_data = d};
    return renderer_create(&d->gpu, &request, &d->renderer);
}

void device_destroy(struct device *d)
{
    if (d->gpu.device) {
        vkDeviceWaitIdle(d->gpu.device);
        renderer_destroy(&d->gpu, &d->renderer);
        film_destroy(&d->gpu, &d->film);
    }
    sluiceDestroyDemandLoader(d->loader);
    sluiceDestroyVulkanContext(d->context);
    free(d->ids);
    gpu_destroy(&d->gpu);
    history_finish(&d->history);
}

bool device_trace(struct device *d, const struct scene_camera *camera, struct picture *picture)
{
    const double start = clock_seconds();
    if (d->picture_count > 0)
        film_clear(&d->film);
    renderer_set_camera(&d->renderer, d->options, camera);
    if (!launches_run(&d->launches) || !film_read(&d->gpu, &d->film, picture))
        return false;
    d->missing_count += d->film.missing_count;
    d->done_count += (uint64_t)d->options->samples * d->film.pixel_count;
    d->picture_count++;
    d->end = clock_seconds();
    d->busy_seconds += d->end - start;
    return true;
}
