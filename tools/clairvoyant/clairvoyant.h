/**
 * A policy that knows a whole feedback trace in advance, and bounds for all policies.
 *
 * The rules are those of docs/replay.md. A frame's maps are sampled before they are processed. A
 * tile handed out in a frame holds its slot from then on, and is resident for the maps of frame +
 * latency + 1. At most `budget` tiles are handed out per frame. A tile counts only if all coarser
 * tiles over it are resident. Nothing is loaded before frame 0, so the first latency + 1 frames see
 * nothing. Packed tiles of all textures are loaded, never dropped, and do not count in `cap`.
 * Followers are not sampled; their tiles are loaded and dropped with the primary's.
 *
 * Exact results:
 * - clv_belady: the fewest uploads with no level too coarse, without a limit of time.
 * - struct prices, `bound`: every schedule under these limits has at least this many levels too
 *   coarse.
 * Heuristic results, which show what can be reached:
 * - clv_schedule without prices: earliest next use first, coarse levels first among equals; drops
 *   the tile with the farthest next use.
 * - clv_schedule with prices: highest value first, at the prices that gave the bound.
 *
 * Without memory the program prints a message and exits.
 *
 * A node is a tile of a set: one tile in the primary and in each follower, so it stands for `size`
 * tiles. Parents (coarser tiles) have lower numbers than their children. The packed tiles of set i
 * are node i.
 */
#ifndef CLAIRVOYANT_H
#define CLAIRVOYANT_H

#include <feedback_trace.h>

#include <stdio.h>

#define NO_NODE UINT32_MAX

/** A map that needs a node. If the node is absent then, `regions` regions are one level coarser. */
struct use {
    uint32_t frame : 31;
    uint32_t follows : 1; ///< true: the previous map of the set needs the node too
    uint16_t regions;     ///< regions that need the node
    uint16_t exact;       ///< regions among them that request exactly this level
};

struct node {
    uint32_t set, parent;
    uint32_t first_use; ///< index in workload.uses; uses of a node are in order of time
    uint16_t size;
    uint8_t level;
    bool packed;
    uint32_t tile; ///< index within its texture, for plans
};

struct frame_use {
    uint32_t node, use;
};

/** Levels too coarse that any manager pays that loads only requested tiles: tiles are unknown until
 * first seen. */
struct reactive_floor {
    uint64_t appears; ///< levels too coarse because the set was never seen before
    uint64_t enters;  ///< ... because the region was never touched before
    uint64_t finer;   ///< ... because the region was never touched at a level this fine
    uint64_t regions; ///< regions with any of these
};

struct workload {
    uint32_t frame_count, set_count, node_count, use_count;
    struct node *nodes; ///< node_count + 1 elements; the last one ends the uses
    struct use *uses;
    uint32_t *frame_first; ///< index in frame_uses; frame_count + 1 elements
    struct frame_use *frame_uses;
    uint32_t *visit_first; ///< index in visits; set_count + 1 elements
    uint32_t *visits;      ///< frames in which a set's map was read
    uint32_t *set_texture; ///< primary texture by set
    uint64_t regions;      ///< touched regions of all maps
    uint64_t packed_tiles; ///< packed tiles of all textures
    struct reactive_floor reactive;
};

struct limits {
    uint64_t cap; ///< slots for tiles that are not packed; UINT64_MAX: no limit
    uint32_t budget, latency;
    bool hold; ///< true: no tile is dropped and loaded again between two maps that need it
};

struct belady {
    uint64_t uploads, distinct;
    uint64_t largest_instant; ///< most tiles that the maps of one frame need
    uint32_t frames_over_cap;
    uint64_t unserved; ///< tiles that could not be resident, summed over those frames
};

/** Minimum of values[from..to], from a table of positions of minima over 2^k values. */
struct range_least {
    const double *values;
    uint32_t *places;
    uint32_t count;
};

/** Prices of an upload in a frame, and of a slot from a frame to the next, in levels too coarse. */
struct prices {
    uint32_t frame_count;
    double *upload, *slot;
    double *held;                    ///< sum of the slot prices before a frame
    double *load[2];                 ///< upload - held; [1], for packed tiles: upload
    struct range_least least[2];     ///< minima of `load`
    double *after_free, *after_held; ///< by use: best gain after it, without and with a slot
    double bound;                    ///< every schedule has at least this many levels too coarse
};

struct outcome {
    uint64_t uploads, deficit, too_coarse, stale, unused, returned, peak;
};

void *clv_alloc(size_t count, size_t size);

/**
 * Reads the trace from its first frame on. Returns false if it cannot be used, with a message on
 * stderr: textures of a set must be consecutive, have one shape and packed tiles, and a region must
 * lie in one tile. `latency`: latency of the reactive floor.
 */
bool clv_workload_read(struct workload *w, struct feedback_trace *trace, uint32_t latency);
/** Numbers the uses by node and by frame. `draft` is ordered by time, then by node. */
void clv_workload_index(struct workload *w, const struct frame_use *draft,
                        const struct use *draft_uses);
void clv_workload_finish(struct workload *w);

struct belady clv_belady(const struct workload *w, uint64_t cap);

/**
 * Searches prices with the greatest bound. `known`: deficit of some schedule. Use in one frame
 * beyond `crowd` times the limit does not lengthen the steps.
 */
void clv_prices_find(struct prices *p, const struct workload *w, const struct limits *limits,
                     uint64_t known, uint32_t rounds, double crowd);
/** Returns the frame in [from, to] with the lowest price of a load. */
uint32_t clv_cheapest_load(const struct prices *p, bool packed, uint32_t from, uint32_t to);
void clv_prices_finish(struct prices *p);

/** Plays the trace under the limits. `prices` NULL: earliest deadline first. Writes the schedule to
 * `plan` unless NULL. */
struct outcome clv_schedule(const struct workload *w, const struct limits *limits,
                            const struct prices *prices, FILE *plan);

/**
 * Searches twice: the search that counts whole crowds mostly finds the better schedule, the other
 * one the better bound. Returns the schedule with fewer levels too coarse. `*best`: its prices,
 * with the better bound of both. The caller frees them with clv_prices_finish.
 */
struct outcome clv_schedule_best(const struct workload *w, const struct limits *limits,
                                 uint64_t known, uint32_t rounds, struct prices *best);

#endif
