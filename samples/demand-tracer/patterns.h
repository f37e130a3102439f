/**
 * Procedural pictures: numbered tiles, stone, wood, cloth, worlds, mosaics, soil, leaves. They
 * repeat and have detail at every level. Detail finer than a texel is left out, so that levels
 * agree.
 */
#ifndef TRACER_PATTERNS_H
#define TRACER_PATTERNS_H

#include <sluice/image.h>

#include "scene.h"

struct pattern {
    uint32_t seed;
    enum texture_use use;
    uint32_t style;     ///< for TEXTURE_OF_THING: index of the picture
    float colors[3][3]; ///< linear RGB
};

/** Chooses a pattern. Seeds give different looks. */
struct pattern pattern_choose(enum texture_use use, uint32_t seed);

/** Returns linear RGBA at (u, v) in [0, 1). `footprint`: width of a texel. */
void pattern_color(const struct pattern *pattern, float u, float v, float footprint, float rgba[4]);

/** Creates a source of `size` x `size` texels, RGBA8 sRGB. `pattern` must outlive the source. */
SluiceResult pattern_open(const struct pattern *pattern, uint32_t size, SluiceImageSource **source);

#endif /* TRACER_PATTERNS_H */
