/** Launch, learn what is missing, make it, launch again. */
#ifndef DEMAND_PBRT_LAUNCHES_H
#define DEMAND_PBRT_LAUNCHES_H

#include "../common/film.h"
#include "tracing.h"
#include "world.h"

/** Zeroed but for what main.c fills is the beginning. */
struct launches {
    const struct gpu *gpu;
    const struct pbrt_options *options;
    const struct scene *scene;
    SluiceDemandLoader *loader;
    struct tracing *tracing;
    struct world *world;
    struct surfaces *surfaces;
    struct textures *textures;
    struct proxies *proxies; ///< NULL: nothing is made on demand but tiles
    struct film *film;
    const struct table *lights, *emitters;
    struct PbrtLaunch constants;
    struct proxy_requests requests;
    struct gpu_buffer unused, debug; ///< the first stands for buffers that there are not
    VkCommandBuffer commands;
    uint32_t count;        ///< launches so far
    uint32_t first;        ///< launches before those that --launches counts
    uint32_t idle_count;   ///< launches that trace nothing: opened pictures go on to their tiles
    uint32_t sample_count; ///< complete samples per pixel of this picture
    uint64_t path_count;   ///< complete paths
    double fill_end;       ///< clock_seconds() when the first sample was complete; 0: never
    uint64_t fill_count;   ///< tiles loaded until then
    uint64_t fill_paths;   ///< complete paths until then
    uint64_t ray_count;    ///< pixels traced, again and again ones among them
    uint64_t tile_count;   ///< tiles loaded
    uint64_t peak_device;  ///< bytes
    double trace_seconds;  ///< of launches that trace
    double last_seconds;   ///< of the last one
    double repeat_seconds; ///< of the fastest launch of launches_repeat; 0: there was none
    void *user_data;
    bool (*after_launch)(void *user_data); ///< false ends it all
};

/** Says on stderr why it failed. */
bool launches_create(struct launches *launches);
void launches_finish(struct launches *launches);

/** Makes all surfaces and loads all tiles. */
bool launches_preload(struct launches *launches);
/** Traces all samples of a picture, each until nothing is missing, or until there were enough
 * launches. */
bool launches_run(struct launches *launches);
/** Builds what has changed, and traces the film's list once. `*progress`: pixels became complete,
 * or tiles were asked for. */
bool launches_trace(struct launches *launches, uint32_t sample, SluiceDemandTicket *ticket,
                    bool *progress);
/** Makes all that launches asked for, and waits for it. `*made`: there was something. Says on
 * stderr why it failed. */
bool launches_serve(struct launches *launches, bool *made);
/** A launch without rays: opened pictures go on to their tiles, and memory above the budget is
 *  freed. */
bool launches_idle(struct launches *launches);
/** Traces all pixels again some times. The film is of no use afterwards. */
bool launches_repeat(struct launches *launches, uint32_t times);

#endif /* DEMAND_PBRT_LAUNCHES_H */
