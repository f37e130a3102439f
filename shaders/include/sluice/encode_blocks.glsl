/*
 * Compresses 4 x 4 texels to a block of BC1, BC4, BC5 or BC7, for shaders that make texels: one
 * invocation per block. Texels are in rows, from the top. Blocks go to a buffer, and from there to
 * an image by vkCmdCopyBufferToImage (docs/producers.md).
 *
 * Values are clamped to 0..1 and encoded as they are: encode sRGB before. They must be finite.
 * BC7 has blocks of modes 1, 4, 5 and 6. docs/producers.md has the quality.
 */
#ifndef SLUICE_ENCODE_BLOCKS_GLSL
#define SLUICE_ENCODE_BLOCKS_GLSL

/* The texels of a block as one line: `end[0]` at weight 0, `end[1]` at weight 1. */
struct SluiceBlockLine {
    vec4 end[2];
};

/* The line through the mean of the texels of `members` along the axis of their largest variance. `mask`: 0 in
 * channels to ignore. */
SluiceBlockLine sluiceFitPartOfBlock(vec4 texels[16], uint members, vec4 mask)
{
    vec4 mean = vec4(0), low = vec4(1), high = vec4(0);
    float count = float(bitCount(members));
    for (int i = 0; i < 16; i++)
        if ((members >> i & 1u) != 0u) {
            mean += texels[i] / count;
            low = min(low, texels[i]);
            high = max(high, texels[i]);
        }
    mat4 covariance = mat4(0);
    for (int i = 0; i < 16; i++) {
        vec4 d = (members >> i & 1u) != 0u ? (texels[i] - mean) * mask : vec4(0);
        covariance += outerProduct(d, d);
    }
    /* The row of the channel that varies most: it is not perpendicular to the axis. */
    vec4 range = (high - low) * mask, axis = covariance[0];
    float widest = range.x;
    for (int c = 1; c < 4; c++)
        if (range[c] > widest) {
            widest = range[c];
            axis = covariance[c];
        }
    for (int i = 0; i < 6; i++) {
        float largest = max(max(abs(axis.x), abs(axis.y)), max(abs(axis.z), abs(axis.w)));
        if (largest > 0)
            axis = covariance * (axis / largest);
    }
    float square = dot(axis, axis), first = 0, last = 0;
    if (square > 0) {
        axis *= inversesqrt(square);
        for (int i = 0; i < 16; i++) {
            float t = (members >> i & 1u) != 0u ? dot(texels[i] - mean, axis) : 0;
            first = min(first, t);
            last = max(last, t);
        }
    }
    return SluiceBlockLine(vec4[2](clamp(mean + axis * first, 0, 1), clamp(mean + axis * last, 0, 1)));
}

/* The line of all texels. */
SluiceBlockLine sluiceFitBlockLine(vec4 texels[16], vec4 mask)
{
    return sluiceFitPartOfBlock(texels, 0xFFFFu, mask);
}

/* Returns the point of the line nearest to the texel: 0..1. */
float sluicePlaceOnLine(SluiceBlockLine line, vec4 texel, vec4 mask)
{
    vec4 d = (line.end[1] - line.end[0]) * mask;
    float square = dot(d, d);
    return square > 0 ? clamp(dot(texel - line.end[0], d) / square, 0, 1) : 0;
}

/* The ends that fit the texels of `members` best if texel i has weight w[i]. */
SluiceBlockLine sluiceRefitPartOfBlock(SluiceBlockLine line, vec4 texels[16], uint members, float w[16])
{
    float aa = 0, ab = 0, bb = 0;
    vec4 a = vec4(0), b = vec4(0);
    for (int i = 0; i < 16; i++) {
        float own = float(members >> i & 1u), v = own * (1 - w[i]), u = own * w[i];
        aa += v * v;
        ab += v * u;
        bb += u * u;
        a += v * texels[i];
        b += u * texels[i];
    }
    float determinant = aa * bb - ab * ab;
    if (determinant > 1e-4) {
        line.end[0] = clamp((bb * a - ab * b) / determinant, 0, 1);
        line.end[1] = clamp((aa * b - ab * a) / determinant, 0, 1);
    }
    return line;
}

/* The ends that fit all texels best. */
SluiceBlockLine sluiceRefitBlockLine(SluiceBlockLine line, vec4 texels[16], float w[16])
{
    return sluiceRefitPartOfBlock(line, texels, 0xFFFFu, w);
}

/* --- BC1 --- */

uint sluiceQuantizeBc1(vec4 color)
{
    uvec3 q = uvec3(round(color.rgb * vec3(31, 63, 31)));
    return q.r << 11 | q.g << 5 | q.b;
}

vec4 sluiceBc1Color(uint q)
{
    uvec3 c = uvec3(q >> 11, q >> 5 & 63u, q & 31u);
    c = uvec3(c.r << 3 | c.r >> 2, c.g << 2 | c.g >> 4, c.b << 3 | c.b >> 2);
    return vec4(vec3(c) / 255, 1);
}

/* Picks indices for two ends; `w` receives the weights. Returns the squared error. */
float sluiceIndexBc1(inout uvec2 ends, vec4 texels[16], out uint indices, out float w[16])
{
    if (ends.x < ends.y)
        ends = ends.yx; /* the order of blocks with four colors */
    SluiceBlockLine line = SluiceBlockLine(vec4[2](sluiceBc1Color(ends.x), sluiceBc1Color(ends.y)));
    float error = 0;
    indices = 0u;
    for (int i = 0; i < 16; i++) {
        uint third = uint(round(sluicePlaceOnLine(line, texels[i], vec4(1, 1, 1, 0)) * 3));
        w[i] = float(third) / 3;
        vec4 d = mix(line.end[0], line.end[1], w[i]) - texels[i];
        error += dot(d.rgb, d.rgb);
        uint index = third == 0u ? 0u : third == 3u ? 1u : third + 1u;
        indices |= index << 2 * i;
    }
    if (ends.x == ends.y)
        indices = 0u; /* a block of three colors: index 3 would be black */
    return error;
}

/** BC1 without transparency. `texels`: alpha is ignored. */
uvec2 sluiceEncodeBc1(vec4 texels[16])
{
    for (int i = 0; i < 16; i++)
        texels[i] = vec4(clamp(texels[i].rgb, 0, 1), 1);
    SluiceBlockLine line = sluiceFitBlockLine(texels, vec4(1, 1, 1, 0));
    uvec2 best = uvec2(0);
    uint bestIndices = 0u;
    float bestError = 1e9;
    for (int pass = 0; pass < 3; pass++) {
        uvec2 ends = uvec2(sluiceQuantizeBc1(line.end[0]), sluiceQuantizeBc1(line.end[1]));
        uint indices;
        float w[16];
        float error = sluiceIndexBc1(ends, texels, indices, w);
        if (error < bestError) {
            bestError = error;
            best = ends;
            bestIndices = indices;
        }
        line = sluiceRefitBlockLine(SluiceBlockLine(vec4[2](sluiceBc1Color(ends.x), sluiceBc1Color(ends.y))), texels, w);
    }
    return uvec2(best.x | best.y << 16, bestIndices);
}

/* --- BC4 and BC5 --- */

float sluiceIndexBc4(uvec2 ends, vec4 texels[16], out uvec2 block, out float w[16])
{
    vec2 e = vec2(ends) / 255;
    float error = 0;
    block = uvec2(ends.x | ends.y << 8, 0);
    for (int i = 0; i < 16; i++) {
        float t = ends.x > ends.y ? clamp((texels[i].x - e.x) / (e.y - e.x), 0, 1) : 0;
        uint step = uint(round(t * 7));
        w[i] = float(step) / 7;
        float d = mix(e.x, e.y, w[i]) - texels[i].x;
        error += d * d;
        uint index = step == 0u ? 0u : step == 7u ? 1u : step + 1u;
        int at = 16 + 3 * i;
        if (at < 32)
            block.x |= index << at;
        if (at < 32 && at > 29)
            block.y |= index >> 32 - at;
        if (at >= 32)
            block.y |= index << at - 32;
    }
    return error;
}

/** BC4. 0 and 1 are exact. */
uvec2 sluiceEncodeBc4(float values[16])
{
    vec4 texels[16];
    float low = 1, high = 0;
    for (int i = 0; i < 16; i++) {
        texels[i] = vec4(clamp(values[i], 0, 1), 0, 0, 0);
        low = min(low, texels[i].x);
        high = max(high, texels[i].x);
    }
    SluiceBlockLine line = SluiceBlockLine(vec4[2](vec4(high), vec4(low)));
    uvec2 best = uvec2(0);
    float bestError = 1e9;
    for (int pass = 0; pass < 2; pass++) {
        uvec2 ends = uvec2(floor(vec2(line.end[0].x, line.end[1].x) * 255 + 0.5));
        uvec2 block;
        float w[16];
        float error = sluiceIndexBc4(ends, texels, block, w);
        if (error < bestError && ends.x >= ends.y) {
            bestError = error;
            best = block;
        }
        line = sluiceRefitBlockLine(line, texels, w);
    }
    return best;
}

/** BC5: two blocks of BC4. */
uvec4 sluiceEncodeBc5(float red[16], float green[16])
{
    return uvec4(sluiceEncodeBc4(red), sluiceEncodeBc4(green));
}

#include "encode_bc7.glsl"

#endif /* SLUICE_ENCODE_BLOCKS_GLSL */
