/**
 * Which tiles of pictures the hits of a camera's rays sample: counted with a cone around each ray,
 * from what docs say of levels, tiles and tails, without code of the library or the shaders.
 *
 * Trilinear samples alone (--anisotropy 1 of demand-pbrt), pictures of 8 bits and of halves, no
 * skies, and no alpha textures.
 */
#ifndef TESTS_ORACLE_TILES_H
#define TESTS_ORACLE_TILES_H

#include "oracle/rays.h"

/** How sure it is that a tile is sampled: floats and doubles round differently. */
enum oracle_tile { ORACLE_TILE_MAYBE, ORACLE_TILE_LIKELY, ORACLE_TILE_SURE };

/** Zeroed but for `scene` and `spread` is empty. */
struct oracle_tiles {
    const struct oracle_scene *scene;
    double spread;           ///< radians of a pixel
    struct oracle_key *keys; ///< owned; a hash table
    size_t count, size;
    struct oracle_shape *shapes; ///< owned; of the picture of each texture
    size_t picture_count;        ///< whose header is read: each has a tail
};

bool oracle_tiles_create(struct oracle_tiles *tiles, const struct oracle_scene *scene,
                         double spread);
void oracle_tiles_finish(struct oracle_tiles *tiles);

/** False if a picture cannot be read, or without memory. */
bool oracle_tiles_add(struct oracle_tiles *tiles, const struct oracle_ray *ray,
                      const struct oracle_hit *hit);
/** Tiles that are at least so sure, and a tail for each picture. */
size_t oracle_tiles_count(const struct oracle_tiles *tiles, enum oracle_tile least);

#endif /* TESTS_ORACLE_TILES_H */
