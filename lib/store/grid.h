/**
 * How a texture is cut into chunks, what a chunk holds, and how chunks are counted: layer by layer,
 * in a layer level by level, in a level row by row, the tail last. Pure arithmetic.
 */
#ifndef SLC_STORE_GRID_H
#define SLC_STORE_GRID_H

#include <sluice/store.h>

/** Bytes of the texels of a whole tile. */
#define SLC_STORE_TILE_SIZE 65536u
/** No tail has as many bytes: its first level is less than a tile, the others less than that. */
#define SLC_STORE_MAX_CHUNK_SIZE 131072u
/** Where chunks of uncompressed files begin is a multiple of it. */
#define SLC_STORE_ALIGNMENT 4096u

/** A tile, or with level = tailFirstLevel and x = y = 0 a tail. */
struct slc_store_place {
    uint32_t layer, level, x, y;
};

struct slc_store_grid {
    SluiceStoreLayout layout;
    SluiceFormatInfo format;
    uint32_t layer_count;
    uint64_t chunk_count;                              ///< of all layers
    uint64_t first_chunk[SLUICE_STORE_MAX_MIP_LEVELS]; ///< of a level, up to the tail, in a layer
    uint64_t first_byte[SLUICE_STORE_MAX_MIP_LEVELS];  ///< the same in an uncompressed layer
    uint64_t layer_size;                               ///< bytes of an uncompressed layer
};

/** Errors: as sluiceGetStoreLayout; INVALID_ARGUMENT for no layers or too many. */
SluiceResult slc_store_grid_init(struct slc_store_grid *grid, uint32_t width, uint32_t height,
                                 SluiceFormat format, uint32_t layer_count);

/** The chunk that a tile is, or a level of the tail lies in; false if there is no such tile. */
bool slc_store_grid_find(const struct slc_store_grid *grid, uint32_t layer, uint32_t level,
                         uint32_t x, uint32_t y, struct slc_store_place *place);

uint64_t slc_store_chunk_number(const struct slc_store_grid *grid,
                                const struct slc_store_place *place);
struct slc_store_place slc_store_chunk_place(const struct slc_store_grid *grid, uint64_t number);

static inline bool slc_store_is_tail(const struct slc_store_grid *grid,
                                     const struct slc_store_place *place)
{
    return place->level == grid->layout.tailFirstLevel;
}

/** Bytes of the texels of a chunk, 1 to SLC_STORE_MAX_CHUNK_SIZE. */
uint32_t slc_store_chunk_size(const struct slc_store_grid *grid,
                              const struct slc_store_place *place);

/** Where a chunk of an uncompressed file begins, from where its first one begins. */
uint64_t slc_store_chunk_offset(const struct slc_store_grid *grid,
                                const struct slc_store_place *place);

/** Where a level begins in the texels of the tail. */
uint32_t slc_store_tail_offset(const struct slc_store_grid *grid, uint32_t level);

/** The texels of a chunk that is not a tail. */
SluiceImageRegion slc_store_chunk_region(const struct slc_store_grid *grid,
                                         const struct slc_store_place *place);

#endif /* SLC_STORE_GRID_H */
