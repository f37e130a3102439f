#include "traced.h"

#include "../../samples/demand-pbrt/emitters.h"
#include "../../samples/demand-pbrt/lights.h"
#include "../common/clock.h"
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

/* Creates the scene like main.c of demand-pbrt. Reads emitters in all modes, so that the mode can
 * change. */
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
           world_begin(&t->world);
}

static void record_look(void *user_data, VkCommandBuffer commands, VkDescriptorSet demand_set)
{
    struct traced *t = user_data;
    t->looked = t->looks && t->parts->view.count > 0;
    if (t->looked)
        traced_view_record(&t->parts->view, commands, demand_set);
}

static bool begin_launches(struct traced *t)
{
    t->launches = (struct launches){.gpu = t->gpu,
                                    .options = &t->options,
                                    .scene = &t->pbrt->scene,
                                    .loader = t->loader,
                                    .tracing = &t->parts->tracing,
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

/* Returns parts that a thread has made, unless the threads changed since. Otherwise makes parts. */
static struct traced_parts *take_parts(struct scene_pbrt *pbrt, const struct stage_request *request)
{
    struct traced_parts *parts = pbrt->parts;
    pbrt->parts = NULL;
    if (parts && parts->threads == request->threads)
        return parts;
    traced_parts_destroy(parts);
    return traced_parts_create(request->gpu, request->threads);
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
    t->parts = take_parts(pbrt, request);
    if (t->parts) {
        t->context = t->parts->context;
        t->loader = t->parts->loader;
    }
    if (t->parts && create_pictures(t) && create_scene(t) && begin_launches(t)) {
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
    traced_tiles_finish(&t->tiles);
    if (t->launches.commands)
        vkFreeCommandBuffers(t->gpu->device, t->gpu->command_pool, 1, &t->launches.commands);
    launches_finish(&t->launches);
    film_destroy(t->gpu, &t->film);
    proxies_finish(t->gpu, &t->world.structures, &t->proxies);
    if (t->world.gpu)
        world_finish(&t->world);
    surfaces_finish(t->gpu, &t->surfaces);
    table_finish(t->gpu, &t->lights);
    table_finish(t->gpu, &t->emitters);
    if (t->parts)
        traced_parts_destroy_loader(t->parts);
    textures_finish(&t->textures);
    picture_files_finish(&t->files);
    traced_parts_destroy(t->parts);
    mesh_cache_destroy(t->meshes);
    free(t->pictures);
    scene_pbrt_close(t->pbrt);
    free(t);
}

/* Returns true if a setting changed that accumulated samples depend on. */
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
        /* Boxes and materials that rays requested are pages, too. All pages must fit. */
        now.forgetAfterLaunches = 0;
        check(sluiceSetDemandLoaderSettings(t->loader, &now), "sluiceSetDemandLoaderSettings");
    }
    t->restarts = t->restarts || changes_picture(&t->settings, settings);
    t->settings = *settings;
    /* The truth has everything, so a freeze of requests does not apply to it. */
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
