/*
 * Weighs texels for bicubic samples, and for derivatives of samples by their coordinates.
 *
 * The bicubic filter is a B-spline: smooth, never outside the range of its 4x4 texels, and slightly
 * blurry, because it does not interpolate texels. Pairs of texels with weights of one sign are one
 * linear sample. So a bicubic sample of a level is four bilinear samples, and so is each of its
 * derivatives.
 *
 * Source: Sigg and Hadwiger, "Fast Third-Order Texture Filtering", GPU Gems 2, chapter 20.
 */
#ifndef SLUICE_CUBIC_GLSL
#define SLUICE_CUBIC_GLSL

#include "language.glsl"

/** One axis of a sample of a level: the coordinates of two linear samples, and their weights. */
struct SluiceFilterAxis {
    vec2 at, weight;
};

/** Returns the weights of a cubic B-spline for texels -1 to 2. `t` runs from texel 0 to texel 1. */
vec4 sluiceSplineWeights(float t)
{
    float back = 1.0 - t;
    return vec4(back * back * back, (3.0 * t - 6.0) * t * t + 4.0,
                (3.0 * back - 6.0) * back * back + 4.0, t * t * t) / 6.0;
}

/** Returns the derivatives of sluiceSplineWeights by `t`. */
vec4 sluiceSplineSlopes(float t)
{
    float back = 1.0 - t;
    return 0.5 * vec4(-back * back, (3.0 * t - 4.0) * t, (4.0 - 3.0 * back) * back, t * t);
}

/**
 * Returns an axis of a sample, or of its derivative (`slope`) per unit of the coordinate. `n` is the
 * level's size in texels.
 */
SluiceFilterAxis sluiceFilterAxis(float coordinate, float n, bool cubic, bool slope)
{
    SluiceFilterAxis axis;
    axis.at = SLUICE_SPLAT(vec2, coordinate);
    axis.weight = vec2(1.0, 0.0);
    if (!cubic && !slope)
        return axis;
    float at = clamp(coordinate, -1.0e9, 1.0e9) * n - 0.5; /* beyond, nothing changes */
    float low = floor(at), t = at - low;
    vec4 w = slope ? n * sluiceSplineSlopes(t) : sluiceSplineWeights(t);
    if (!cubic)
        w = vec4(0.0, -n, n, 0.0); /* from the middle of one texel to that of the next */
    axis.weight = w.xz + w.yw;
    axis.at = (low + vec2(-0.5, 1.5) + (cubic ? w.yw / axis.weight : vec2(1.0, 0.0))) / n;
    return axis;
}

/*
 * Bilinear samples that one sample of a level is made of. Part 0 to 3 is of the color, 4 to 7 of its
 * derivative by u, 8 to 11 of that by v.
 */
struct SluiceFilterPart {
    vec2 uv;
    float weight; /* 0: not needed */
};

SluiceFilterPart sluiceFindFilterPart(vec2 uv, vec2 size, bool cubic, uint part)
{
    SluiceFilterAxis x = sluiceFilterAxis(uv.x, size.x, cubic, part >> 2u == 1u);
    SluiceFilterAxis y = sluiceFilterAxis(uv.y, size.y, cubic, part >> 2u == 2u);
    bool right = (part & 1u) != 0u, below = (part & 2u) != 0u;
    SluiceFilterPart result;
    result.uv = vec2(right ? x.at.y : x.at.x, below ? y.at.y : y.at.x);
    result.weight = (right ? x.weight.y : x.weight.x) * (below ? y.weight.y : y.weight.x);
    return result;
}

/**
 * Returns how much of a sample is bicubic if it is magnified by `levels`: the LOD that is shown less
 * the LOD that is wanted. 0 where the texture is not magnified, 1 from twice its size on, and 0 for
 * NaN.
 */
float sluiceCubicShare(float levels)
{
    return levels > 0.0 ? min(levels, 1.0) : 0.0;
}

#endif
