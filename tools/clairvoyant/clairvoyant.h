/**
 * A policy that knows the whole of a feedback trace in advance, and bounds for all others.
 *
 * The rules are those of docs/replay.md: a frame's maps are sampled before they are processed; a
 * tile handed out in a frame holds its slot from then on and is there for the maps of frame +
 * latency + 1; at most `budget` tiles are handed out per frame; a tile counts only if all coarser
 * ones are there. Nothing is loaded before frame 0, so the first latency + 1 frames see nothing.
 * Every texture's packed tiles are loaded and never dropped, and do not count in `cap`. The
 * residency of followers is not sampled; their tiles are loaded and dropped with the primary's all
 * the same.
 *
 * What is exact:
 * - clv_belady: the fewest uploads with no level too coarse at all, whatever time they take.
 * - struct prices, `bound`: no schedule under these limits has fewer levels too coarse.
 * What is heuristic, and so an example of what can be reached:
 * - clv_schedule without prices: earliest next use first, coarse levels first among equals; drops
 *   the farthest.
 * - with prices: what is worth most at the prices that gave the bound.
 *
 * Memory that runs out ends the program, with a message.
 *
 * A node is a tile of a set: the same tile of the primary and of each follower, so it stands for
 * `size` tiles. Nodes are numbered so that a parent (the coarser tile over it) comes first; the
 * packed tiles of set number i are node i.
 */
#ifndef CLAIRVOYANT_H
#define CLAIRVOYANT_H

#include <feedback_trace.h>

#include <stdio.h>

#define NO_NODE UINT32_MAX

/** A map that needs a node. A node absent there makes `regions` regions one level coarser. */
struct use {
    uint32_t frame : 31;
    uint32_t follows : 1; ///< the map of the same set before this one needs the node too
    uint16_t regions;     ///< that need this node
    uint16_t exact;       ///< of those, the ones that want this very level
};

struct node {
    uint32_t set, parent;
    uint32_t first_use; ///< in workload.uses; those of a node are in order of time
    uint16_t size;
    uint8_t level;
    bool packed;
    uint32_t tile; ///< index within its texture, for plans
};

struct frame_use {
    uint32_t node, use;
};

/** What the first sight of tiles costs a manager that loads only what was asked for. */
struct reactive_floor {
    uint64_t appears; ///< levels too coarse: the set was never seen before
    uint64_t enters;  ///< the region was never touched before
    uint64_t finer;   ///< the region was touched, but never at a level this fine
    uint64_t regions; ///< regions with any of these
};

struct workload {
    uint32_t frame_count, set_count, node_count, use_count;
    struct node *nodes; ///< one more than node_count, to end the last one's uses
    struct use *uses;
    uint32_t *frame_first; ///< into frame_uses, frame_count + 1 of them
    struct frame_use *frame_uses;
    uint32_t *visit_first; ///< into visits, set_count + 1 of them
    uint32_t *visits;      ///< frames in which a set's map was read
    uint32_t *set_texture; ///< the primary of a set
    uint64_t regions;      ///< touched regions of all maps
    uint64_t packed_tiles; ///< of all textures
    struct reactive_floor reactive;
};

struct limits {
    uint64_t cap; ///< slots for tiles that are not packed, UINT64_MAX for no cap
    uint32_t budget, latency;
    bool hold; ///< no tile is dropped and brought back between two maps that both need it
};

struct belady {
    uint64_t uploads, distinct;
    uint64_t largest_instant; ///< tiles that one frame's maps need at once
    uint32_t frames_over_cap;
    uint64_t unserved; ///< tiles that could not be there, summed over those frames
};

/** Least of values[from..to], by a table of the places of the least of 2^k values. */
struct range_least {
    const double *values;
    uint32_t *places;
    uint32_t count;
};

/** Prices of an upload in a frame and of a slot from a frame to the next, in levels too coarse. */
struct prices {
    uint32_t frame_count;
    double *upload, *slot;
    double *held;                    ///< sum of the slot prices before a frame
    double *load[2];                 ///< upload - held; [1], for packed tiles: upload
    struct range_least least[2];     ///< of `load`
    double *after_free, *after_held; ///< per use: best gain after it, by whether it has its slot
    double bound;                    ///< no schedule has fewer levels too coarse than this
};

struct outcome {
    uint64_t uploads, deficit, too_coarse, stale, unused, returned, peak;
};

void *clv_alloc(size_t count, size_t size);

/**
 * Reads the trace from its first frame on. False, with a message on stderr, if it cannot be used:
 * textures of a set must stand together, be of one shape and have packed tiles, and a region must
 * lie in one tile. `latency` is that of the reactive floor.
 */
bool clv_workload_read(struct workload *w, struct feedback_trace *trace, uint32_t latency);
/** Numbers the uses by node and by frame; `draft` has them in order of time and of node. */
void clv_workload_index(struct workload *w, const struct frame_use *draft,
                        const struct use *draft_uses);
void clv_workload_finish(struct workload *w);

struct belady clv_belady(const struct workload *w, uint64_t cap);

/**
 * Looks for the prices with the greatest bound. `known` is the deficit of some schedule. What is
 * taken in one frame beyond `crowd` times the limit does not make the steps larger.
 */
void clv_prices_find(struct prices *p, const struct workload *w, const struct limits *limits,
                     uint64_t known, uint32_t rounds, double crowd);
/** The frame in [from, to] in which to load at the least price. */
uint32_t clv_cheapest_load(const struct prices *p, bool packed, uint32_t from, uint32_t to);
void clv_prices_finish(struct prices *p);

/** Without prices: earliest deadline first. Writes the schedule to `plan` unless that is NULL. */
struct outcome clv_schedule(const struct workload *w, const struct limits *limits,
                            const struct prices *prices, FILE *plan);

/**
 * Looks twice, because the search that counts whole crowds mostly ends with the better schedule and
 * the other with the better bound. `*best` are the prices of the schedule with fewer levels too
 * coarse, which is returned; their bound is the better one of both. The caller finishes them.
 */
struct outcome clv_schedule_best(const struct workload *w, const struct limits *limits,
                                 uint64_t known, uint32_t rounds, struct prices *best);

#endif
