/**
 * Tiler: collects the rows of all levels into bands of one tile's height, and hands complete tiles
 * to the pool. The pool writes tiles into the store.
 */
#ifndef SLC_BAKE_TILER_H
#define SLC_BAKE_TILER_H

#include <sluice/store.h>

#include "bake/blocks.h"
#include "bake/work_pool.h"

/** Bands of a level: the open band, the band in writing, and the band that is completed last. */
#define SLC_MAX_BANDS 3

struct slc_tiler;
struct slc_band;

struct slc_tile_job {
    struct slc_job base;
    struct slc_band *band;
    uint32_t x;
    uint64_t turn; ///< the writer's turn
};

/** Band: the texel rows of one row of tiles. */
struct slc_band {
    struct slc_tiler *tiler;
    uint32_t level, y;  ///< tile coordinates; valid for open bands and bands in writing
    uint32_t row_count; ///< rows so far
    uint32_t pending;   ///< tiles still to be written; under the pool's mutex
    bool is_open;
    char *texels;
    struct slc_tile_job *jobs; ///< one per tile of a row
};

struct slc_tiler_level {
    uint32_t width, height;
    uint32_t band_count; ///< 0 in the tail
    struct slc_band bands[SLC_MAX_BANDS];
    size_t tail_offset; ///< bytes in `tail`
};

struct slc_tiler {
    SluiceAllocationCallbacks allocator;
    struct slc_bake_jobs *jobs;
    SluiceStoreLayout layout;
    SluiceFormat texel_format;        ///< format in rows: the layout's, or the encoder's input
    struct slc_block_encoder encoder; ///< set it after init
    SluiceStoreWriter *writer;
    uint32_t layer;            ///< store layer; set it after init
    uint64_t *next_turn;       ///< the writer's, for all layers of a store; set it after init
    SluiceResult result;       ///< the first failure; under the pool's mutex
    uint64_t found_tile_count; ///< tiles of an earlier run; under the pool's mutex
    char *tail;                ///< texels of the tail's levels, one after the other
    size_t tail_size;
    struct slc_tiler_level levels[SLUICE_STORE_MAX_MIP_LEVELS];
};

/** Returns the bytes that slc_tiler_init allocates. */
uint64_t slc_tiler_memory(const SluiceStoreLayout *layout, SluiceFormat texel_format,
                          bool reaches_around);

/** Allocates bands. `reaches_around`: the first band of a level may be completed last. Errors:
 * OUT_OF_HOST_MEMORY; call slc_tiler_finish then, too. */
SluiceResult slc_tiler_init(struct slc_tiler *tiler, const SluiceAllocationCallbacks *cb,
                            struct slc_bake_jobs *jobs, const SluiceStoreLayout *layout,
                            SluiceFormat texel_format, bool reaches_around);
/** Waits for tiles in writing and frees the bands. */
void slc_tiler_finish(struct slc_tiler *tiler);

/** Waits for room and returns the memory of a row: fill the row, then end it. NULL: failure. */
void *slc_tiler_begin_row(struct slc_tiler *tiler, uint32_t level, uint32_t y);
void slc_tiler_end_row(struct slc_tiler *tiler, uint32_t level, uint32_t y);

/** Waits for all tiles and writes the tail. Call it after the last row. */
SluiceResult slc_tiler_complete(struct slc_tiler *tiler);

/** Returns the first failure. */
SluiceResult slc_tiler_result(struct slc_tiler *tiler);

#endif /* SLC_BAKE_TILER_H */
