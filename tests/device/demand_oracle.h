/**
 * Texels that a sample of a demand texture consists of, by brute force in long double. Follows
 * Vulkan's address modes and filters, not the shaders.
 *
 * Shaders compute in float and weigh in steps of 1/256, so filters have no sharp ends. A certain
 * texel has more weight than these errors. An uncertain texel may count or not.
 */
#ifndef TESTS_DEVICE_DEMAND_ORACLE_H
#define TESTS_DEVICE_DEMAND_ORACLE_H

#include <sluice/shared/demand.h>

#include <stdbool.h>

#include "demand_probe_shared.h"

/** A filter at one level. */
struct demand_tap {
    uint32_t level;
    long double u, v;
    double weight; ///< 0: may count, but should not
    double cubic;  ///< share of the bicubic filter; the rest is linear
    bool nearest;
    bool sure;
    bool spline, smart; ///< filter of the texture, or of DEMAND_CUBIC
    double wanted_lod;
};

/** A texel of a tap. x -1: border. */
struct demand_touch {
    int32_t x, y;
    double weight;
    double du, dv; ///< weights of derivatives
    bool sure;
};

/** Lists the taps of DEMAND_GRAD, _LOD or _CUBIC for an open texture outside grids. `bias`: the
 * loader's. Returns false if float could give another number of taps: weights are unknown then. */
bool demand_oracle_taps(const struct SluiceDemandTexture *texture, const struct DemandInput *in,
                        double bias, void (*visit)(void *user, const struct demand_tap *tap),
                        void *user);

void demand_oracle_touches(const struct SluiceDemandTexture *texture, const struct demand_tap *tap,
                           void (*visit)(void *user, const struct demand_touch *touch), void *user);

/** Returns the bicubic share of the level shown in place of `tap->level`. */
double demand_oracle_share(const struct demand_tap *tap, double shown_lod);

/** Returns whether derivatives of a linear part jump here. */
bool demand_oracle_jumps(const struct SluiceDemandTexture *texture, const struct demand_tap *tap);

/** Computes the LOD without bias, for derivatives in texels. INFINITY if they are not finite. */
long double demand_oracle_lod(const float dx[2], const float dy[2], double anisotropy);

#endif /* TESTS_DEVICE_DEMAND_ORACLE_H */
