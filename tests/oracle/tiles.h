/**
 * Counts the tiles of pictures that a camera's rays sample. Uses a cone around each ray and the
 * rules of the docs for levels, tiles and tails, without code of the library or the shaders.
 *
 * Supports only trilinear samples (--anisotropy 1 of demand-pbrt) and pictures of 8 bits or halves,
 * without skies and alpha textures.
 */
#ifndef TESTS_ORACLE_TILES_H
#define TESTS_ORACLE_TILES_H

#include "oracle/rays.h"

/** Certainty that a tile is sampled: floats and doubles round differently. */
enum oracle_tile { ORACLE_TILE_MAYBE, ORACLE_TILE_LIKELY, ORACLE_TILE_SURE };

/** Set `scene` and `spread`, and zero the rest. */
struct oracle_tiles {
    const struct oracle_scene *scene;
    double spread;           ///< radians per pixel
    struct oracle_key *keys; ///< owned; a hash table
    size_t count, size;
    struct oracle_shape *shapes; ///< owned; by texture: size of its picture
    size_t picture_count;        ///< pictures whose header was read; each has a tail
};

bool oracle_tiles_create(struct oracle_tiles *tiles, const struct oracle_scene *scene,
                         double spread);
void oracle_tiles_finish(struct oracle_tiles *tiles);

/** Returns false if a picture cannot be read, or when out of memory. */
bool oracle_tiles_add(struct oracle_tiles *tiles, const struct oracle_ray *ray,
                      const struct oracle_hit *hit);
/** Counts tiles of at least this certainty, and a tail per picture. */
size_t oracle_tiles_count(const struct oracle_tiles *tiles, enum oracle_tile least);

#endif /* TESTS_ORACLE_TILES_H */
