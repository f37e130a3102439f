/**
 * Pictures that are computed: tiles with numbers, stone, wood, cloth, worlds, mosaics, soil,
 * leaves. They repeat, have something to show at every level, and leave out what is finer than a
 * texel, so that levels agree with each other.
 */
#ifndef TRACER_PATTERNS_H
#define TRACER_PATTERNS_H

#include <sluice/image.h>

#include "scene.h"

struct pattern {
    uint32_t seed;
    enum texture_use use;
    uint32_t style;     ///< of things: which of the pictures
    float colors[3][3]; ///< linear RGB
};

/** Different seeds look different. */
struct pattern pattern_choose(enum texture_use use, uint32_t seed);

/** Linear RGBA at (u, v) in [0, 1), of a texel `footprint` wide. */
void pattern_color(const struct pattern *pattern, float u, float v, float footprint, float rgba[4]);

/** A source of `size` x `size` texels, RGBA8 sRGB. `pattern` must outlive it. */
SluiceResult pattern_open(const struct pattern *pattern, uint32_t size, SluiceImageSource **source);

#endif /* TRACER_PATTERNS_H */
