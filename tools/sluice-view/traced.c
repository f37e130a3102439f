#include "traced.h"

#include "../../samples/demand-pbrt/emitters.h"
#include "../../samples/demand-pbrt/lights.h"
#include "../common/clock.h"
#include "../common/log.h"
#include "../common/text.h"

#include <stdlib.h>

#define LEAST_BUDGET (4ull << 20)

static bool check(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        text_say("sluice-view: %s: %s", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static double read_clock(void *user_data)
{
    (void)user_data;
    return clock_seconds();
}

static void note_failure(void *user_data, const SluiceTileReadFailure *failure)
{
    struct traced *t = user_data;
    if (!failure->willRetry)
        atomic_fetch_add(&t->failed_reads, 1);
}

static bool create_loader(struct traced *t, uint32_t threads)
{
    const struct gpu *gpu = t->gpu;
    const SluiceVulkanContextCreateInfo context = {
        .structSize = sizeof context,
        .queueFamilyIndex = gpu->family,
        .instance = gpu->instance,
        .physicalDevice = gpu->physical_device,
        .device = gpu->device,
        .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
        .log = {.pfnLog = log_say},
        .loaderThreadCount = threads,
    };
    if (!check(sluiceCreateVulkanContext(&context, &t->context), "sluiceCreateVulkanContext"))
        return false;
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info,
        .context = t->context,
        .pageCapacity = PBRT_PAGE_CAPACITY,
        .maxRequestsPerLaunch = PBRT_MOST_REQUESTS,
        .failure = {t, note_failure},
    };
    return check(sluiceCreateDemandLoader(&info, &t->loader), "sluiceCreateDemandLoader");
}

static bool create_pictures(struct traced *t)
{
    t->picture_count = t->pbrt->picture_count;
    t->pictures = calloc(t->picture_count + 1u, sizeof *t->pictures);
    for (uint32_t i = 0; t->pictures && i < t->picture_count; i++)
        t->pictures[i] = (struct traced_picture){.texture = {.id = i + 1,
                                                             .name = t->pbrt->pictures[i].name,
                                                             .path = t->pbrt->pictures[i].path,
                                                             .primary = STAGE_NO_TEXTURE,
                                                             .format = "not read"},
                                                 .finest = UINT32_MAX};
    if (!t->pictures)
        text_say("sluice-view: out of memory");
    return t->pictures;
}

/* As main.c of demand-pbrt. Emitters are read in all modes, so that the mode can change. */
static bool create_scene(struct traced *t)
{
    struct scene *scene = &t->pbrt->scene;
    const struct pbrt_options *o = &t->options;
    t->meshes = mesh_cache_create(scene, 1, MESH_CACHE_BYTES);
    if (!t->meshes || !picture_files_create(t->pbrt->cache, o->threads, &t->files))
        return false;
    textures_create(t->loader, &t->files, &t->textures);
    const struct mesh_reading reading = {t->meshes, 0, o->threads};
    t->textures.max_anisotropy = (float)o->anisotropy;
    return surfaces_create(t->gpu, scene, &t->surfaces) &&
           lights_create(t->gpu, scene, &t->textures, &t->lights, &t->only_areas) &&
           emitters_create(t->gpu, scene, true, &t->lights, &t->emitters) &&
           proxies_create(t->loader, scene, &t->proxies) &&
           world_create(t->gpu, scene, &t->surfaces, &t->proxies, false, &reading, &t->world) &&
           world_begin(&t->world) && tracing_create(t->gpu, t->loader, true, &t->tracing);
}

static void record_look(void *user_data, VkCommandBuffer commands, VkDescriptorSet demand_set)
{
    struct traced *t = user_data;
    t->looked = t->looks && t->view.count > 0;
    if (t->looked)
        traced_view_record(&t->view, commands, demand_set);
}

static bool begin_launches(struct traced *t)
{
    t->launches = (struct launches){.gpu = t->gpu,
                                    .options = &t->options,
                                    .scene = &t->pbrt->scene,
                                    .loader = t->loader,
                                    .tracing = &t->tracing,
                                    .world = &t->world,
                                    .surfaces = &t->surfaces,
                                    .textures = &t->textures,
                                    .proxies = &t->proxies,
                                    .film = &t->film,
                                    .lights = &t->lights,
                                    .emitters = &t->emitters,
                                    .user_data = t,
                                    .look = record_look};
    t->flight = (struct flight){.budget = {.seconds = TRACED_FRAME_SECONDS, .now = read_clock}};
    return launches_create(&t->launches);
}

struct traced *traced_create(const struct stage_request *request,
                             const struct view_settings *settings, struct scene_pbrt *pbrt)
{
    struct traced *t = calloc(1, sizeof *t);
    if (!t) {
        scene_pbrt_close(pbrt);
        return NULL;
    }
    t->gpu = request->gpu;
    t->pbrt = pbrt;
    t->waits = request->waits;
    t->options = (struct pbrt_options){.debug = {UINT32_MAX, UINT32_MAX},
                                       .warmup = UINT32_MAX,
                                       .anisotropy = settings->anisotropy,
                                       .threads = request->threads};
    if (!t->gpu->buffer_addresses || !t->gpu->byte_pages)
        text_say("sluice-view: %s cannot load on demand: scenes of pbrt need paged mode and "
                 "addresses of buffers",
                 t->gpu->properties.deviceName);
    else if (create_loader(t, request->threads) && create_pictures(t) && create_scene(t) &&
             begin_launches(t) && traced_view_create(t->gpu, t->loader, &t->view) &&
             traced_show_create(t->gpu, &t->show)) {
        traced_apply(t, settings);
        return t;
    }
    traced_destroy(t);
    return NULL;
}

void traced_destroy(struct traced *t)
{
    if (!t)
        return;
    vkDeviceWaitIdle(t->gpu->device);
    traced_show_destroy(&t->show);
    traced_view_destroy(&t->view);
    traced_tiles_finish(&t->tiles);
    if (t->launches.commands)
        vkFreeCommandBuffers(t->gpu->device, t->gpu->command_pool, 1, &t->launches.commands);
    launches_finish(&t->launches);
    tracing_destroy(t->gpu, &t->tracing);
    film_destroy(t->gpu, &t->film);
    proxies_finish(t->gpu, &t->world.structures, &t->proxies);
    if (t->world.gpu)
        world_finish(&t->world);
    surfaces_finish(t->gpu, &t->surfaces);
    table_finish(t->gpu, &t->lights);
    table_finish(t->gpu, &t->emitters);
    sluiceDestroyDemandLoader(t->loader);
    sluiceDestroyVulkanContext(t->context);
    textures_finish(&t->textures);
    picture_files_finish(&t->files);
    mesh_cache_destroy(t->meshes);
    free(t->pictures);
    scene_pbrt_close(t->pbrt);
    free(t);
}

/* What pictures are gathered with. */
static bool changes_picture(const struct view_settings *a, const struct view_settings *b)
{
    return a->budget != b->budget || a->load != b->load || a->render_mode != b->render_mode ||
           a->depth != b->depth;
}

void traced_apply(struct traced *t, const struct view_settings *settings)
{
    SluiceDemandLoaderSettings now = {.structSize = sizeof now};
    uint64_t budget =
        settings->budget && settings->budget < LEAST_BUDGET ? LEAST_BUDGET : settings->budget;
    budget = settings->load == VIEW_LOAD_EVERYTHING ? 0 : budget;
    check(sluiceSetVulkanMemoryBudget(t->context, budget), "sluiceSetVulkanMemoryBudget");
    if (check(sluiceGetDemandLoaderSettings(t->loader, &now), "sluiceGetDemandLoaderSettings")) {
        /* The boxes and materials that rays asked for are pages, too: all must fit. */
        now.forgetAfterLaunches = 0;
        check(sluiceSetDemandLoaderSettings(t->loader, &now), "sluiceSetDemandLoaderSettings");
    }
    t->restarts = t->restarts || changes_picture(&t->settings, settings);
    t->settings = *settings;
    /* The truth does not depend on what was frozen before it was opened. */
    t->settings.freeze_wants = settings->freeze_wants && settings->load == VIEW_LOAD_WANTED;
}

uint64_t traced_geometry_size(const struct traced *t)
{
    const struct world *w = &t->world;
    return w->structures.arena.size + w->structures.scratch.size + w->meshes.batch.scratch.size +
           w->meshes.data.size + w->instances.size + w->tree.nodes.size +
           w->tree.instances.buffer.size + w->place_table.buffer.size +
           w->meshes.table.buffer.size + t->surfaces.table.buffer.size +
           t->surfaces.ops.buffer.size;
}
