/** The launch loop: trace, find missing tiles, load them, trace again. Shows the use of
 * sluice/demand.h. */
#ifndef TRACER_LAUNCHES_H
#define TRACER_LAUNCHES_H

#include "renderer.h"

/** Counts of one launch. */
struct launch_record {
    uint32_t index;         ///< from 1
    uint32_t sample;        ///< from 0
    uint32_t traced_count;  ///< pixels
    uint32_t missing_count; ///< pixels among them that must be traced again
    SluiceDemandRequests requests;
};

struct launches {
    const struct gpu *gpu;
    const struct tracer_options *options;
    SluiceDemandLoader *loader;
    struct renderer *renderer;
    struct film *film;
    const SluiceDemandTextureId *texture_ids; ///< ids of the loader
    uint32_t texture_count;
    bool quiet; ///< true: launches_preload shows no progress
    VkCommandBuffer commands;
    uint32_t count;          ///< launches so far
    uint32_t first;          ///< launches before this picture
    uint64_t ray_count;      ///< traced paths, repeated ones included
    uint32_t complete_count; ///< complete samples per pixel of this picture
    uint64_t path_count;     ///< complete paths
    double fill_end;         ///< clock_seconds() when the first sample was complete; 0: never
    uint64_t fill_count;     ///< tiles loaded until then
    uint64_t fill_paths;     ///< complete paths until then
    uint32_t preload_count;  ///< launches of --preload, which trace nothing
    uint64_t tile_count;     ///< loaded tiles, counting repeated loads and --preload
    void *user_data;
    /** Called after each launch that traced something. Returns false to stop. */
    bool (*after_launch)(void *user_data, const struct launch_record *record);
};

/**
 * Traces all samples of a picture. Repeats each sample until no pixel is missing, or until the
 * launch limit is reached. Pixels that are still missing then are no error. Reports errors on
 * stderr.
 */
bool launches_run(struct launches *launches);
/** Loads all tiles of all textures. */
bool launches_preload(struct launches *launches);

#endif /* TRACER_LAUNCHES_H */
