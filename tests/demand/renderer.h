/**
 * A renderer that samples rectangles of pyramid textures in each launch, and knows nothing but its
 * page table. The residency must make it converge.
 */
#ifndef TESTS_DEMAND_RENDERER_H
#define TESTS_DEMAND_RENDERER_H

#include "demand/fake_memory.h"

enum {
    RENDERER_TEXTURES = 24,
    RENDERER_LEVELS = 7, ///< levels with tiles; the tail is below
    RENDERER_PAGES = 1 << 17,
    RENDERER_VIEWS = 32,
    RENDERER_IN_FLIGHT = 3
};

struct pyramid {
    uint32_t width, height, level_count; ///< tiles of level 0
    uint32_t first[RENDERER_LEVELS], tail;
    uint32_t kind;
};

/** A part of a texture, in [0, 1], seen at a level of detail. */
struct view {
    uint32_t texture;
    float x, y, width, height, lod;
};

/** Pages that a launch used and missed, each listed once. */
struct flight {
    uint32_t *used, *missed; ///< owned
    uint32_t used_count, missed_count;
};

struct renderer {
    struct slc_demand_residency *residency;
    struct fake_memory memory;
    struct pyramid textures[RENDERER_TEXTURES];
    uint32_t texture_count, page_end;
    struct view views[RENDERER_VIEWS];
    uint32_t view_count;
    uint32_t list_limit, in_flight,
        slowest_load; ///< `slowest_load`: most launches that a read takes
    uint64_t random, launch;
    uint8_t shown[RENDERER_PAGES]; ///< the page table
    struct flight flights[RENDERER_IN_FLIGHT];
    uint8_t marks[RENDERER_PAGES];
    uint8_t left_over[RENDERER_PAGES]; ///< bits of requests that did not fit into the list
    float bias;                        ///< bias of the last recorded launch
    uint64_t ready[RENDERER_PAGES];    ///< by page: launch after which its read ends; 0: no read
    struct slc_page_request requests[RENDERER_PAGES];
    /* Results of the last launch. */
    uint32_t missing, loads, refused;
};

void renderer_init(struct renderer *r, uint64_t seed, uint32_t texture_count, uint32_t kinds);
/** Starts with `limit` places of tiles for the residency, and `memory_places` in memory. */
void renderer_start(struct renderer *r, const struct slc_page_residency_create_info *info,
                    uint64_t limit, uint32_t memory_places, uint32_t chunk_size);
void renderer_finish(struct renderer *r);
void renderer_random_views(struct renderer *r, uint32_t count);
/** Counts pages that all views need at a bias: without tails, or with `tails` only the tails. */
uint32_t renderer_need(struct renderer *r, float bias, bool tails);
/** Launches, scans, processes and loads. */
void renderer_launch(struct renderer *r);

#endif /* TESTS_DEMAND_RENDERER_H */
