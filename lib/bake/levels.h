/** Baking of one picture: filters its levels, and writes them as tiles of a store. */
#ifndef SLC_BAKE_LEVELS_H
#define SLC_BAKE_LEVELS_H

#include "bake/coverage.h"
#include "bake/plan.h"
#include "bake/pyramid.h"
#include "bake/tiler.h"

struct slc_baking {
    SluiceAllocationCallbacks allocator;
    struct slc_picture *picture;
    struct slc_astc_pool *astc;
    struct slc_plan plan;
    uint32_t layer;       ///< layer of the store
    uint64_t *next_turn;  ///< next turn of the writer, for all layers of the store
    uint32_t layer_count; ///< layers of the store, for the progress
    struct slc_pyramid pyramid;
    struct slc_tiler tiler;
    struct slc_coverage coverage;
    bool counts; ///< true: counts alpha; false: writes
    float alpha_scales[SLC_MAX_LEVELS];
    float *row;                   ///< [width][4]
    struct slc_replaced replaced; ///< counts for level 0
    uint64_t done, total;         ///< texels of level 0, over all passes and layers
    void *user;
    bool (*progress)(void *user, uint64_t done, uint64_t total); ///< NULL: none
};

/** Returns the bytes that baking takes, without reading. */
uint64_t slc_baking_memory(const struct slc_picture *picture, const struct slc_plan *plan,
                           const SluiceStoreLayout *layout);

/**
 * Initializes the other fields. Set allocator, picture, astc, plan, layer,
 * layer_count, user and progress first. Finish
 * it even after an error. Errors: OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_baking_init(struct slc_baking *baking, struct slc_bake_jobs *jobs,
                             const SluiceStoreLayout *layout);
void slc_baking_finish(struct slc_baking *baking);

/** Writes all levels. Errors: those of reading and writing; CANCELED. */
SluiceResult slc_baking_run(struct slc_baking *baking, SluiceStoreWriter *writer);

#endif /* SLC_BAKE_LEVELS_H */
