/** The launch loop: trace, find missing resources, make them, trace again. */
#ifndef DEMAND_PBRT_LAUNCHES_H
#define DEMAND_PBRT_LAUNCHES_H

#include "../common/film.h"
#include "tracing.h"
#include "world.h"

/** Launches of one device. Zeroed, except for the fields that main.c sets. */
struct launches {
    const struct gpu *gpu;
    const struct pbrt_options *options;
    const struct scene *scene;
    SluiceDemandLoader *loader;
    struct tracing *tracing;
    struct world *world;
    struct surfaces *surfaces;
    struct textures *textures;
    struct proxies *proxies; ///< NULL: only tiles are made on demand
    struct film *film;
    const struct table *lights, *emitters;
    struct PbrtLaunch constants;
    struct proxy_requests requests;
    struct gpu_buffer unused, debug; ///< `unused` is bound in place of absent buffers
    VkCommandBuffer commands;
    uint32_t count;        ///< launches so far
    uint32_t first;        ///< launches that --launches does not count
    uint32_t idle_count;   ///< launches without rays, which let opened pictures load tiles
    uint32_t sample_count; ///< complete samples per pixel of this picture
    uint64_t path_count;   ///< complete paths
    double fill_end;       ///< clock_seconds() when the first sample was complete; 0: never
    uint64_t fill_count;   ///< tiles loaded until then
    uint64_t fill_paths;   ///< complete paths until then
    uint64_t ray_count;    ///< traced pixels, repeated ones included
    uint64_t tile_count;   ///< tiles loaded
    uint64_t peak_device;  ///< bytes
    double trace_seconds;  ///< total time of launches that trace
    double last_seconds;   ///< time of the last launch that traced
    double repeat_seconds; ///< time of the fastest launch of launches_repeat; 0: none
    VkBuffer probes;       ///< borrowed; PbrtProbe of each pixel; VK_NULL_HANDLE without preview
    void *user_data;
    bool (*after_launch)(void *user_data); ///< returns false to stop
    /** Records commands into each launch, behind its rays. May be NULL. */
    void (*look)(void *user_data, VkCommandBuffer commands, VkDescriptorSet demand_set);
};

/** Reports errors on stderr. */
bool launches_create(struct launches *launches);
void launches_finish(struct launches *launches);

/** Makes all surfaces and loads all tiles. */
bool launches_preload(struct launches *launches);
/** Traces all samples of a picture. Repeats each sample until nothing is missing, or until the
 * launch limit is reached. */
bool launches_run(struct launches *launches);
/** Builds changed structures, and traces the film's list once. `*progress`: whether pixels became
 * complete or tiles were requested. */
bool launches_trace(struct launches *launches, uint32_t sample, SluiceDemandTicket *ticket,
                    bool *progress);
/** Makes all resources that launches requested, and waits for them. `*made`: whether there were
 * any. Reports errors on stderr. */
bool launches_serve(struct launches *launches, bool *made);
/** Runs a launch without rays: opened pictures begin to load tiles, and memory above the budget is
 * freed. */
bool launches_idle(struct launches *launches);
/** Traces all pixels `times` times more. Overwrites the film. */
bool launches_repeat(struct launches *launches, uint32_t times);

#endif /* DEMAND_PBRT_LAUNCHES_H */
