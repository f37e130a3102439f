/**
 * Chunks of a texture: their texels and their numbers. Chunks are numbered layer by layer, level by
 * level, row by row, with the tail of a layer last. Pure arithmetic.
 */
#ifndef SLC_STORE_GRID_H
#define SLC_STORE_GRID_H

#include <sluice/store.h>

/** Bytes of a whole tile. */
#define SLC_STORE_TILE_SIZE 65536u
/** Limit of a tail's bytes: its first level is less than a tile, all others together less again. */
#define SLC_STORE_MAX_CHUNK_SIZE 131072u
/** Alignment of chunks of uncompressed files, in bytes. */
#define SLC_STORE_ALIGNMENT 4096u

/** Position of a chunk: a tile, or, with level = tailFirstLevel and x = y = 0, the tail. */
struct slc_store_place {
    uint32_t layer, level, x, y;
};

struct slc_store_grid {
    SluiceStoreLayout layout;
    SluiceFormatInfo format;
    uint32_t layer_count;
    uint64_t chunk_count;                              ///< chunks of all layers
    uint64_t first_chunk[SLUICE_STORE_MAX_MIP_LEVELS]; ///< by level up to the tail, in a layer
    uint64_t first_byte[SLUICE_STORE_MAX_MIP_LEVELS];  ///< by level, in an uncompressed layer
    uint64_t layer_size;                               ///< bytes of an uncompressed layer
};

/** Computes the grid. Errors: as sluiceGetStoreLayout; INVALID_ARGUMENT for no layers or too many.
 */
SluiceResult slc_store_grid_init(struct slc_store_grid *grid, uint32_t width, uint32_t height,
                                 SluiceFormat format, uint32_t layer_count);

/** Finds the chunk of a tile or of a level of the tail. False if there is no such tile. */
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

/** Returns the bytes of a chunk's texels, 1 to SLC_STORE_MAX_CHUNK_SIZE. */
uint32_t slc_store_chunk_size(const struct slc_store_grid *grid,
                              const struct slc_store_place *place);

/** Returns the offset of a chunk of an uncompressed file, counted from the first chunk. */
uint64_t slc_store_chunk_offset(const struct slc_store_grid *grid,
                                const struct slc_store_place *place);

/** Returns the offset of a level in the texels of the tail. */
uint32_t slc_store_tail_offset(const struct slc_store_grid *grid, uint32_t level);

/** Returns the texels of a chunk other than a tail. */
SluiceImageRegion slc_store_chunk_region(const struct slc_store_grid *grid,
                                         const struct slc_store_place *place);

#endif /* SLC_STORE_GRID_H */
