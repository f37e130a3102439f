/**
 * What one sample must mark and what it may mark, by brute force in double from the meaning of a
 * sample in Vulkan, not from the shaders. Sets of tiles of all levels: a mark of level m asks for
 * the tiles over its region of level m and of all coarser levels.
 */
#ifndef TESTS_DEVICE_ORACLE_H
#define TESTS_DEVICE_ORACLE_H

#include <sluice/shared/texture_table.h>

#include <stdbool.h>

#include "conform_shared.h"

#define ORACLE_LEVELS 16u
#define ORACLE_TILES 65536u
#define ORACLE_REGIONS 4096u ///< per axis

struct oracle_tiles {
    struct SluiceTextureEntry entry;
    uint32_t first[ORACLE_LEVELS], width[ORACLE_LEVELS], height[ORACLE_LEVELS];
    uint32_t count;
    bool has[ORACLE_TILES];
};

void oracle_tiles_init(struct oracle_tiles *t, const struct SluiceTextureEntry *entry);
bool *oracle_tile(struct oracle_tiles *t, uint32_t level, uint32_t x, uint32_t y);

/**
 * Levels of detail that a device may choose: Vulkan's, by the lengths of the derivatives, or by the
 * axes of the ellipse that they span, which is narrower than either is short and longer than either
 * is long; and the finest and the coarsest that come of mixing both. -INFINITY for no derivatives,
 * NAN where an argument is not finite.
 */
struct oracle_lod {
    double lengths, ellipse;
    double finest, coarsest;
    double isotropic; ///< by the longer axis, whatever the anisotropy: the coarsest of all
};
struct oracle_lod oracle_lod(const struct SluiceTextureEntry *entry, const struct ConformInput *in);

/** How the sampler filters. */
struct oracle_filter {
    bool nearest;       ///< inside a level
    double subtexel;    ///< texel coordinates may be off by so much
    double lod_offset;  ///< added to the level of detail
    double lod_quantum; ///< a fraction below it shows no second level
    bool bias_scales;   ///< a LOD bias makes an anisotropic footprint longer or shorter
    bool by_ellipse;    ///< level and footprint follow the ellipse, not the lengths
};

/** Adds the tiles of the texels that a sample reads. */
void oracle_require(struct oracle_tiles *t, const struct ConformInput *in,
                    struct oracle_filter filter);

/** The tiles that the marks of a map ask for. */
void oracle_decode(struct oracle_tiles *t, const uint32_t *map);

/** Adds all coarser tiles over those that are there: a streamer loads no tile without them. */
void oracle_close(struct oracle_tiles *t);

/**
 * Where marks may be; a level below `level` or one that does not exist is wrong anywhere. Marks
 * from `wide_level` on may also be where the coarser levels reach that some devices read with
 * anisotropy.
 */
struct oracle_allowed {
    uint32_t level, wide_level;
    bool x[ORACLE_REGIONS], y[ORACLE_REGIONS];
    bool wide_x[ORACLE_REGIONS], wide_y[ORACLE_REGIONS];
};
bool oracle_allows(const struct oracle_allowed *a, uint32_t level, uint32_t x, uint32_t y);
void oracle_allow(struct oracle_allowed *a, const struct SluiceTextureEntry *entry,
                  const struct ConformInput *in);

#endif /* TESTS_DEVICE_ORACLE_H */
