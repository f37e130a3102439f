/** Launch, learn what is missing, load it, launch again: what sluice/demand.h is for. */
#ifndef TRACER_LAUNCHES_H
#define TRACER_LAUNCHES_H

#include "renderer.h"

/** What is known after a launch. */
struct launch_record {
    uint32_t index;         ///< from 1 on
    uint32_t sample;        ///< from 0 on
    uint32_t traced_count;  ///< pixels
    uint32_t missing_count; ///< pixels among them that are to be traced again
    SluiceDemandRequests requests;
};

struct launches {
    const struct gpu *gpu;
    const struct tracer_options *options;
    SluiceDemandLoader *loader;
    struct renderer *renderer;
    struct film *film;
    const SluiceDemandTextureId *texture_ids; ///< of the loader
    uint32_t texture_count;
    bool quiet; ///< launches_preload shows no progress
    VkCommandBuffer commands;
    uint32_t count;          ///< launches so far
    uint32_t first;          ///< launches before those of this picture
    uint64_t ray_count;      ///< paths traced, again and again ones among them
    uint32_t complete_count; ///< samples per pixel of this picture that are complete
    uint64_t path_count;     ///< complete paths
    double fill_end;         ///< clock_seconds() when the first sample was complete; 0: never
    uint64_t fill_count;     ///< tiles loaded until then
    uint64_t fill_paths;     ///< complete paths until then
    uint32_t preload_count;  ///< launches of --preload, which trace nothing
    uint64_t tile_count;     ///< tiles loaded, as often as they were, those of --preload included
    void *user_data;
    /** After each launch that traced something; false ends it all. */
    bool (*after_launch)(void *user_data, const struct launch_record *record);
};

/**
 * Traces all samples of a picture, each until no pixel of it is missing, or until there were enough
 * launches. Says on stderr why it failed, which missing pixels in the end are not.
 */
bool launches_run(struct launches *launches);
/** Loads everything first. */
bool launches_preload(struct launches *launches);

#endif /* TRACER_LAUNCHES_H */
