/**
 * Plans: which pictures are baked how and where to, with an estimate of the work. Several processes
 * or machines bake one plan. docs/cluster.md describes the file.
 */
#ifndef TOOLS_SLUICE_BAKE_BAKE_PLAN_H
#define TOOLS_SLUICE_BAKE_BAKE_PLAN_H

#include <sluice/bake.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct plan_picture {
    char *input, *output; ///< owned
    double cost;          ///< estimated seconds on one processor, at least 0
    uint64_t size;        ///< bytes of the input
    uint32_t width, height, layers;
    SluiceFormat format;
};

struct plan {
    SluiceBakeSettings settings; ///< for all pictures
    uint64_t settings_hash;
    struct plan_picture *pictures; ///< owned, sorted by output
    size_t count, capacity;
};

/** Adds a picture and takes over both names. A name may be NULL after a failed allocation. Returns
 * false, with a message on stderr, when out of memory. */
bool plan_add(struct plan *plan, const struct plan_picture *picture);

/** Estimates seconds on one processor. `texels`: of level 0, all layers. */
double plan_cost(const SluiceBakeSettings *settings, SluiceFormat format, double texels,
                 uint64_t input_size);

/** Writes a plan. Reports errors on stderr. */
bool plan_write(const struct plan *plan, const char *path);
/** Reads a plan. Reports errors on stderr, with file and line. */
bool plan_read(struct plan *plan, const char *path);
void plan_finish(struct plan *plan);

/**
 * Assigns each picture to a shard, counted from 0. The costliest picture comes first; each goes to
 * the shard with the least cost. `shards`: one number per picture. Returns false when out of
 * memory.
 */
bool plan_balance(const struct plan *plan, uint32_t shard_count, uint32_t *shards);

#endif /* TOOLS_SLUICE_BAKE_BAKE_PLAN_H */
