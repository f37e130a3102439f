/**
 * Marks that a sample must and may write, by brute force in double. Follows the meaning of a sample
 * in Vulkan, not the shaders. Sets hold tiles of all levels: a mark of level m requests the tiles
 * over its region at level m and all coarser levels.
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
 * Levels of detail that a device may choose. Vulkan's use the lengths of the derivatives, or the
 * axes of the ellipse that they span: its minor axis is at most the shorter length, its major axis
 * at least the longer one. Also the finest and the coarsest level of any mix of both. -INFINITY
 * without derivatives, NAN for arguments that are not finite.
 */
struct oracle_lod {
    double lengths, ellipse;
    double finest, coarsest;
    double isotropic; ///< LOD of the longer axis, for any anisotropy: the coarsest of all
};
struct oracle_lod oracle_lod(const struct SluiceTextureEntry *entry, const struct ConformInput *in);

/** Filter of the sampler. */
struct oracle_filter {
    bool nearest;       ///< nearest filter inside a level
    double subtexel;    ///< tolerance of texel coordinates
    double lod_offset;  ///< added to the level of detail
    double lod_quantum; ///< smaller fractions show no second level
    bool bias_scales;   ///< a LOD bias scales the length of an anisotropic footprint
    bool by_ellipse;    ///< level and footprint follow the ellipse, not the lengths
};

/** Adds the tiles of the texels that a sample reads. */
void oracle_require(struct oracle_tiles *t, const struct ConformInput *in,
                    struct oracle_filter filter);

/** Sets the tiles that the marks of a map request. */
void oracle_decode(struct oracle_tiles *t, const uint32_t *map);

/** Adds all coarser tiles over the set's tiles: a streamer loads no tile without them. */
void oracle_close(struct oracle_tiles *t);

/**
 * Regions where marks are allowed. A level below `level`, or beyond the chain, is wrong anywhere.
 * Marks from `wide_level` on may also be where some devices read coarser levels with anisotropy.
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
