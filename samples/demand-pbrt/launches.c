#include "launches.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/text.h"
#include "budget.h"

/* Limit of launches in a row without a completed pixel or a new mesh, surface or picture. */
#define MOST_VAIN_LAUNCHES 200u
/* Launches in a row that complete no pixel, after which the budgets grow. */
#define STUCK_LAUNCHES 32u
#define NO_LEVEL UINT32_MAX ///< coarser than all levels: opens a picture and loads its mip tail

static bool check(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        text_say("%s: %s", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

bool launches_create(struct launches *l)
{
    const VkCommandBufferAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = l->gpu->command_pool,
                                              .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = 1};
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (!gpu_create_buffer(l->gpu, sizeof(uint32_t), usage, &l->unused) ||
        !gpu_create_buffer(l->gpu, sizeof(struct PbrtDebug), usage, &l->debug) ||
        !gpu_check(vkAllocateCommandBuffers(l->gpu->device, &info, &l->commands),
                   "vkAllocateCommandBuffers"))
        return false;
    memset(l->debug.mapped, 0, l->debug.size);
    struct PbrtDebug *debug = l->debug.mapped;
    const uint32_t *pixel = l->options->debug;
    debug->pixel = pixel[0] == UINT32_MAX ? PBRT_NONE : pixel[1] * l->film->width + pixel[0];
    return true;
}

void launches_finish(struct launches *l)
{
    if (!l->gpu)
        return;
    proxy_requests_finish(&l->requests);
    gpu_destroy_buffer(l->gpu, &l->unused);
    gpu_destroy_buffer(l->gpu, &l->debug);
}

static void bind_all(struct launches *l)
{
    const struct top_tree *top = &l->world->tree;
    const VkBuffer boxes = l->world->proxies ? l->proxies->buffer.buffer : l->unused.buffer;
    const VkBuffer buffers[PBRT_OWN_BUFFERS] = {
        [PBRT_BINDING_MESHES] = l->world->meshes.table.buffer.buffer,
        [PBRT_BINDING_PLACES] = l->world->place_table.buffer.buffer,
        [PBRT_BINDING_SURFACES] = l->surfaces->table.buffer.buffer,
        [PBRT_BINDING_OPS] = l->surfaces->ops.buffer.buffer,
        [PBRT_BINDING_LIGHTS] = l->lights->buffer.buffer,
        [PBRT_BINDING_EMITTERS] = l->emitters->buffer.buffer,
        [PBRT_BINDING_FILM] = l->film->sums.buffer,
        [PBRT_BINDING_LATEST] = l->film->latest.buffer,
        [PBRT_BINDING_LISTS] = l->film->lists.buffer,
        [PBRT_BINDING_COUNTERS] = l->film->counters.buffer,
        [PBRT_BINDING_WANTED] = l->surfaces->wanted.buffer.buffer,
        [PBRT_BINDING_USED] = l->world->used.buffer.buffer,
        [PBRT_BINDING_BOXES] = boxes,
        [PBRT_BINDING_DEBUG] = l->debug.buffer,
        [PBRT_BINDING_PROBES] = l->probes ? l->probes : l->unused.buffer,
        [PBRT_BINDING_WORLD] = top->world.buffer ? top->world.buffer : l->unused.buffer,
        [PBRT_BINDING_INSTANCES] =
            top->world.buffer ? top->instances.buffer.buffer : l->unused.buffer};
    tracing_bind(l->gpu, l->tracing, buffers, l->world->top.handle);
}

static void record(struct launches *l, uint32_t sample, VkDescriptorSet demand_set)
{
    struct PbrtLaunch launch = l->constants;
    launch.count = l->film->missing_count;
    launch.sampleIndex = sample;
    launch.launchIndex = l->count + 1;
    launch.flags |= l->film->list_index ? PBRT_LAUNCH_LIST_ONE : 0;
    if (l->proxies) {
        launch.surfacePage = l->proxies->surface_page;
        launch.proxyPage = l->proxies->box_page;
    }
    tracing_record(l->tracing, l->commands, demand_set, &launch);
    film_record_end(l->commands);
}

static bool submit(struct launches *l, const SluiceDemandLaunch *launch)
{
    const VkTimelineSemaphoreSubmitInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &launch->signalValue};
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .pNext = &timeline,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &l->commands,
                               .signalSemaphoreCount = 1,
                               .pSignalSemaphores = &launch->semaphore};
    return gpu_check(vkEndCommandBuffer(l->commands), "vkEndCommandBuffer") &&
           gpu_check(vkQueueSubmit(l->gpu->queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
}

/** A launch from preparation to requests, with or without rays. */
static bool launch_once(struct launches *l, bool traces, uint32_t sample,
                        SluiceDemandRequests *requests, SluiceDemandTicket *ticket)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    if (!gpu_check(vkBeginCommandBuffer(l->commands, &begin), "vkBeginCommandBuffer") ||
        !check(sluiceBeginDemandLaunch(l->loader, l->commands, &launch),
               "a launch cannot be prepared"))
        return false;
    l->tile_count += launch.tileCount;
    if (traces)
        record(l, sample, launch.descriptorSet);
    if (l->look)
        l->look(l->user_data, l->commands, launch.descriptorSet);
    if (!check(sluiceEndDemandLaunch(l->loader, l->commands), "a launch cannot be ended") ||
        !submit(l, &launch)) {
        sluiceAbandonDemandLaunch(l->loader, &launch); /* the next launch copies its tiles */
        return false;
    }
    return check(sluiceProcessDemandRequests(l->loader, &launch, UINT64_MAX, requests, ticket),
                 "requests cannot be served");
}

bool launches_idle(struct launches *l)
{
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    l->idle_count++;
    return launch_once(l, false, 0, &requests, NULL);
}

static bool wait_for(struct launches *l, SluiceDemandTicket ticket,
                     SluiceDemandTicketStatus *status)
{
    status->structSize = sizeof *status;
    return check(sluiceWaitDemandTicket(l->loader, ticket, UINT64_MAX, status),
                 "tiles cannot be waited for");
}

/**
 * Returns the level that rays want of a picture if it fits into one tile. Rays will miss that tile,
 * so it is loaded in advance. Otherwise returns NO_LEVEL, because the missed tiles are unknown.
 */
static uint32_t choose_level(const struct wanted_picture *picture)
{
    const SluiceImageInfo *info = &picture->use->image->info;
    uint32_t tile_width = 1, tile_height = 1, level = 0;
    if (info->width == 0 || !(picture->width > 0.0f) ||
        sluiceGetStandardTileShape(info->format, &tile_width, &tile_height) != SLUICE_SUCCESS)
        return NO_LEVEL;
    const float width = (float)(info->width > info->height ? info->width : info->height);
    if (width > picture->width)
        level = (uint32_t)floorf(log2f(width / picture->width));
    if (level >= info->mipLevelCount)
        return NO_LEVEL;
    const bool fits = info->width >> level <= tile_width && info->height >> level <= tile_height;
    return fits ? level : NO_LEVEL;
}

/** Begins to load all pictures. Waits for none. */
static bool begin_pictures(struct launches *l, bool are_open)
{
    struct surfaces *s = l->surfaces;
    for (uint32_t i = 0; i < s->picture_count; i++) {
        struct wanted_picture *picture = &s->pictures[i];
        const uint32_t level = are_open ? choose_level(picture) : NO_LEVEL;
        if (!check(sluicePreloadDemandTexture(l->loader, picture->use->id, level, &picture->ticket),
                   "a picture cannot be loaded"))
            return false;
    }
    return true;
}

static bool wait_for_pictures(struct launches *l)
{
    const struct surfaces *s = l->surfaces;
    SluiceDemandTicketStatus status;
    for (uint32_t i = 0; i < s->picture_count; i++)
        if (!wait_for(l, s->pictures[i].ticket, &status))
            return false;
    return true;
}

/** Opens the pictures of new surfaces, so that the next launch misses only tiles. The launch
 * without rays starts to read the mip tails of open pictures; the tickets after it do not wait for
 * them. */
static bool open_pictures(struct launches *l)
{
    if (!begin_pictures(l, false) || !wait_for_pictures(l) || !launches_idle(l) ||
        !wait_for_pictures(l) || !begin_pictures(l, true) || !wait_for_pictures(l))
        return false;
    surfaces_finish_pictures(l->surfaces);
    return true;
}

static bool realize(struct launches *l, const uint32_t *which, uint32_t count)
{
    const uint32_t launch = l->count + 1;
    bool fits = true;
    surfaces_begin(l->surfaces);
    if (!budget_make_surface_room(l->world, l->surfaces, launch, &fits))
        return false;
    for (uint32_t i = 0; i < count && fits; i++)
        if (!surfaces_realize(l->gpu, l->scene, l->textures, l->surfaces, which[i], launch) ||
            !budget_make_surface_room(l->world, l->surfaces, launch, &fits))
            return false;
    return l->surfaces->picture_count == 0 || open_pictures(l);
}

bool launches_serve(struct launches *l, bool *made)
{
    const struct pbrt_options *o = l->options;
    const struct proxy_order order = {o->sort_proxies, o->oneshot_geometry, o->oneshot_material};
    *made = false;
    if (!l->proxies)
        return true;
    if (!proxies_take(l->proxies, &order, &l->requests))
        return false;
    *made = l->requests.node_count + l->requests.surface_count > 0;
    for (uint32_t i = 0; i < l->requests.node_count; i++)
        if (!world_resolve(l->world, l->requests.nodes[i]))
            return false;
    return realize(l, l->requests.surfaces, l->requests.surface_count);
}

static void count_memory(struct launches *l)
{
    SluiceDemandStatistics statistics = {.structSize = sizeof statistics};
    if (sluiceGetDemandStatistics(l->loader, &statistics) != SLUICE_SUCCESS)
        return;
    const struct world *w = l->world;
    const uint64_t size = statistics.deviceMemorySize + statistics.hostVisibleMemorySize +
                          w->structures.arena.size + w->structures.scratch.size +
                          w->meshes.batch.scratch.size + w->meshes.data.size + w->instances.size +
                          w->tree.nodes.size + w->tree.instances.buffer.size +
                          w->place_table.buffer.size + w->meshes.table.buffer.size +
                          l->surfaces->table.buffer.size + l->surfaces->ops.buffer.size;
    if (size > l->peak_device)
        l->peak_device = size;
}

bool launches_trace(struct launches *l, uint32_t sample, SluiceDemandTicket *ticket, bool *progress)
{
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    const uint32_t before = l->film->missing_count;
    if (!world_build(l->world, l->count + 1))
        return false;
    bind_all(l);
    film_begin_launch(l->film);
    double start = clock_seconds();
    if (!launch_once(l, true, sample, &requests, ticket))
        return false;
    l->last_seconds = clock_seconds() - start;
    l->trace_seconds += l->last_seconds;
    film_end_launch(l->film);
    l->count++;
    l->ray_count += before;
    *progress = l->film->missing_count < before || requests.servedCount > 0;
    count_memory(l);
    return !l->after_launch || l->after_launch(l->user_data);
}

/* Doubles the budgets that are set. */
static bool grow_budgets(struct launches *l)
{
    uint64_t *meshes = &l->world->budget, *materials = &l->surfaces->budget;
    if (*meshes == 0 && *materials == 0)
        return false;
    *meshes *= 2;
    *materials *= 2;
    text_say("one path needs more than the budgets hold; they are %llu KiB of meshes, %llu KiB of "
             "materials now, 0 being no limit",
             (unsigned long long)(*meshes >> 10), (unsigned long long)(*materials >> 10));
    return true;
}

static bool trace_sample(struct launches *l, uint32_t sample, uint32_t most)
{
    uint32_t vain = 0, least = UINT32_MAX, stuck = 0;
    film_begin_sample(l->film);
    while (l->film->missing_count > 0 && l->count - l->first < most && vain < MOST_VAIN_LAUNCHES) {
        SluiceDemandTicket ticket;
        SluiceDemandTicketStatus status;
        bool progress, made = false;
        if (!launches_trace(l, sample, &ticket, &progress))
            return false;
        if (l->film->missing_count > 0 &&
            (!wait_for(l, ticket, &status) || !launches_serve(l, &made)))
            return false;
        vain = progress || made ? 0 : vain + 1;
        stuck = l->film->missing_count < least ? 0 : stuck + 1;
        least = l->film->missing_count < least ? l->film->missing_count : least;
        if (stuck == STUCK_LAUNCHES && grow_budgets(l))
            stuck = 0;
    }
    if (vain == MOST_VAIN_LAUNCHES)
        fprintf(stderr, "%u launches in a row made nothing\n", vain);
    return true;
}

static void note_fill(struct launches *l)
{
    if (l->fill_end > 0.0)
        return;
    l->fill_end = clock_seconds();
    l->fill_count = l->tile_count;
    l->fill_paths = l->path_count;
}

bool launches_run(struct launches *l)
{
    const struct pbrt_options *o = l->options;
    const uint32_t most = o->warmup < o->launches ? o->warmup + 1 : o->launches;
    l->first = l->count;
    l->sample_count = 0;
    for (uint32_t sample = 0; sample < o->samples; sample++) {
        if (!trace_sample(l, sample, most))
            return false;
        l->path_count += l->film->pixel_count - l->film->missing_count;
        if (l->film->missing_count > 0)
            break;
        l->sample_count++;
        note_fill(l);
    }
    return true;
}

bool launches_repeat(struct launches *l, uint32_t times)
{
    const uint32_t count = l->count;
    for (uint32_t i = 0; i < times; i++) {
        SluiceDemandTicket ticket;
        bool progress;
        film_begin_sample(l->film);
        if (!launches_trace(l, 0, &ticket, &progress))
            return false;
        if (l->repeat_seconds == 0.0 || l->last_seconds < l->repeat_seconds)
            l->repeat_seconds = l->last_seconds;
    }
    l->count = count;
    return true;
}

/* Waits for a ticket. Launches without rays request the tiles of opened pictures and copy loaded
 * ones. */
static bool finish_ticket(struct launches *l, SluiceDemandTicket ticket)
{
    SluiceDemandTicketStatus status;
    do {
        if (!wait_for(l, ticket, &status) || !launches_idle(l))
            return false;
    } while (status.remainingCount > 0);
    return true;
}

bool launches_preload(struct launches *l)
{
    surfaces_begin(l->surfaces);
    for (uint32_t i = 0; i < l->scene->info.materialCount + l->scene->info.textureCount; i++)
        if (!surfaces_realize(l->gpu, l->scene, l->textures, l->surfaces, i, l->count + 1))
            return false;
    for (uint32_t i = 0; i < l->textures->use_count; i++) {
        SluiceDemandTicket ticket;
        if (!check(sluicePreloadDemandTexture(l->loader, l->textures->uses[i]->id, 0, &ticket),
                   "a picture cannot be loaded") ||
            !finish_ticket(l, ticket))
            return false;
    }
    surfaces_finish_pictures(l->surfaces);
    return true;
}
