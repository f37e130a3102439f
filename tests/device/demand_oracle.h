/**
 * What a sample of a texture that is loaded on demand is made of, by brute force in long double
 * from Vulkan's meaning of address modes and filters, not from the shaders.
 *
 * Shaders compute in float and weigh in steps of 1/256, so at their ends filters are not sharp:
 * what is sure has more weight than that can take away, and what is not sure may count or not.
 */
#ifndef TESTS_DEVICE_DEMAND_ORACLE_H
#define TESTS_DEVICE_DEMAND_ORACLE_H

#include <sluice/shared/demand.h>

#include <stdbool.h>

#include "demand_probe_shared.h"

/** One filter of one level. */
struct demand_tap {
    uint32_t level;
    long double u, v;
    double weight; ///< 0 for what may count, but should not
    double cubic;  ///< share of the bicubic filter; the rest is linear
    bool nearest;
    bool sure;
    bool spline, smart; ///< of the texture, or of DEMAND_CUBIC
    double wanted_lod;
};

/** One texel of a tap; x -1: the border. */
struct demand_touch {
    int32_t x, y;
    double weight;
    double du, dv; ///< weights of derivatives
    bool sure;
};

/** DEMAND_GRAD, _LOD or _CUBIC of an open texture, that is not in a grid; `bias` is the loader's.
 *  False: float could come to another number of taps, so weights are not known. */
bool demand_oracle_taps(const struct SluiceDemandTexture *texture, const struct DemandInput *in,
                        double bias, void (*visit)(void *user, const struct demand_tap *tap),
                        void *user);

void demand_oracle_touches(const struct SluiceDemandTexture *texture, const struct demand_tap *tap,
                           void (*visit)(void *user, const struct demand_touch *touch), void *user);

/** Bicubic share of the level that is shown in place of `tap->level`. */
double demand_oracle_share(const struct demand_tap *tap, double shown_lod);

/** Whether derivatives of a linear part jump here. */
bool demand_oracle_jumps(const struct SluiceDemandTexture *texture, const struct demand_tap *tap);

/** Without bias; derivatives in texels. INFINITY where they are not finite. */
long double demand_oracle_lod(const float dx[2], const float dy[2], double anisotropy);

#endif /* TESTS_DEVICE_DEMAND_ORACLE_H */
