/*
 * Compresses 4 x 4 texels to a block of BC7. Only encode_blocks.glsl includes this file.
 */
#ifndef SLUICE_ENCODE_BC7_GLSL
#define SLUICE_ENCODE_BC7_GLSL

/* --- BC7, mode 6: one line, ends of 7 bits and a shared lowest bit, 16 weights --- */

const uint sluiceBc7Weights[16] = uint[16](0u, 4u, 9u, 13u, 17u, 21u, 26u, 30u, 34u, 38u, 43u, 47u, 51u, 55u, 60u, 64u);

/* 8 bits per channel, whose lowest bits are equal: of the two ways, the nearer one. */
uvec4 sluiceQuantizeBc7(vec4 color)
{
    vec4 c = color * 255;
    uvec4 even = uvec4(clamp(floor(c / 2 + 0.5), 0, 127)) * 2u;
    uvec4 odd = uvec4(clamp(floor((c - 1) / 2 + 0.5), 0, 127)) * 2u + 1u;
    vec4 e = vec4(even) - c, o = vec4(odd) - c;
    /* Full opacity is exact. */
    return color.a < 1 && dot(e, e) < dot(o, o) ? even : odd;
}

float sluiceIndexBc7(uvec4 ends[2], vec4 texels[16], out uint indices[16], out float w[16])
{
    SluiceBlockLine line = SluiceBlockLine(vec4[2](vec4(ends[0]) / 255, vec4(ends[1]) / 255));
    float error = 0;
    for (int i = 0; i < 16; i++) {
        /* Steps of the weights are 4 or 5 of 64: the index is a step below or above at most. */
        float t = sluicePlaceOnLine(line, texels[i], vec4(1)) * 64;
        uint index = uint(round(t * 15 / 64));
        if (index > 0u && abs(t - float(sluiceBc7Weights[index - 1u])) < abs(t - float(sluiceBc7Weights[index])))
            index--;
        if (index < 15u && abs(t - float(sluiceBc7Weights[index + 1u])) < abs(t - float(sluiceBc7Weights[index])))
            index++;
        indices[i] = index;
        w[i] = float(sluiceBc7Weights[index]) / 64;
        vec4 d = mix(line.end[0], line.end[1], w[i]) - texels[i];
        error += dot(d, d);
    }
    return error;
}

void sluicePutBits(inout uvec4 block, inout int at, uint value, int bits)
{
    block[at >> 5] |= value << (at & 31);
    if ((at & 31) + bits > 32)
        block[(at >> 5) + 1] |= value >> 32 - (at & 31);
    at += bits;
}

uvec4 sluicePackBc7(uvec4 ends[2], uint indices[16])
{
    /* The first index has three bits: its highest one is 0. */
    bool turn = indices[0] > 7u;
    uvec4 a = turn ? ends[1] : ends[0], b = turn ? ends[0] : ends[1];
    uvec4 block = uvec4(0);
    int at = 0;
    sluicePutBits(block, at, 1u << 6, 7);
    for (int c = 0; c < 4; c++) {
        sluicePutBits(block, at, a[c] >> 1, 7);
        sluicePutBits(block, at, b[c] >> 1, 7);
    }
    sluicePutBits(block, at, a.x & 1u, 1);
    sluicePutBits(block, at, b.x & 1u, 1);
    for (int i = 0; i < 16; i++)
        sluicePutBits(block, at, turn ? 15u - indices[i] : indices[i], i == 0 ? 3 : 4);
    return block;
}

/* --- BC7, mode 5: one channel apart, with weights of its own. Ends of 7 and 8 bits, 4 weights --- */

/* Alpha changes places with channel `rotation - 1`; 0: stays. */
vec4 sluiceRotateBc7(vec4 texel, uint rotation)
{
    return rotation == 1u   ? texel.agbr
           : rotation == 2u ? texel.rabg
           : rotation == 3u ? texel.rgab
                            : texel;
}

struct SluiceBc7Split {
    uvec4 ends[2]; /* as stored: 7 bits of color, 8 of alpha */
    uvec2 indices; /* of color, of alpha: 2 bits each */
};

/* Weights 21 and 43 of 64 for a third and two thirds. */
float sluiceBc7Third(uint index)
{
    return float(21u * index + (index > 1u ? 1u : 0u)) / 64;
}

/* Picks indices for two ends; `line` becomes their fit. Returns the squared error. */
float sluiceIndexBc7Split(inout SluiceBlockLine line, vec4 texels[16], out SluiceBc7Split block)
{
    const vec4 color = vec4(1, 1, 1, 0), alpha = vec4(0, 0, 0, 1);
    SluiceBlockLine stored;
    for (int e = 0; e < 2; e++) {
        block.ends[e] = uvec4(floor(line.end[e] * vec4(127, 127, 127, 255) + 0.5));
        uvec4 bytes = uvec4(block.ends[e].rgb << 1 | block.ends[e].rgb >> 6, block.ends[e].a);
        stored.end[e] = vec4(bytes) / 255;
    }
    float w[16], v[16], error = 0;
    block.indices = uvec2(0);
    for (int i = 0; i < 16; i++) {
        uint c = uint(round(sluicePlaceOnLine(stored, texels[i], color) * 3));
        uint a = uint(round(sluicePlaceOnLine(stored, texels[i], alpha) * 3));
        w[i] = sluiceBc7Third(c);
        v[i] = sluiceBc7Third(a);
        block.indices |= uvec2(c, a) << 2 * i;
        vec4 d = mix(stored.end[0], stored.end[1], vec4(vec3(w[i]), v[i])) - texels[i];
        error += dot(d, d);
    }
    SluiceBlockLine colors = sluiceRefitBlockLine(stored, texels, w);
    SluiceBlockLine alphas = sluiceRefitBlockLine(stored, texels, v);
    for (int e = 0; e < 2; e++)
        line.end[e] = vec4(colors.end[e].rgb, alphas.end[e].a);
    return error;
}

uvec4 sluicePackBc7Split(SluiceBc7Split split, uint rotation)
{
    /* The first indices have one bit: their higher one is 0. */
    bvec2 turn = notEqual(split.indices & 2u, uvec2(0));
    uvec2 indices = uvec2(turn.x ? ~split.indices.x : split.indices.x, turn.y ? ~split.indices.y : split.indices.y);
    uvec4 block = uvec4(0);
    int at = 0;
    sluicePutBits(block, at, 1u << 5, 6);
    sluicePutBits(block, at, rotation, 2);
    for (int c = 0; c < 4; c++) {
        uint first = split.ends[0][c], second = split.ends[1][c];
        bool swap = c < 3 ? turn.x : turn.y;
        sluicePutBits(block, at, swap ? second : first, c < 3 ? 7 : 8);
        sluicePutBits(block, at, swap ? first : second, c < 3 ? 7 : 8);
    }
    for (int k = 0; k < 2; k++) {
        sluicePutBits(block, at, indices[k] & 1u, 1);
        sluicePutBits(block, at, indices[k] >> 2, 30);
    }
    return block;
}

/* Replaces `block` if a channel apart has a smaller error. */
void sluiceTryBc7Split(vec4 texels[16], inout float bestError, inout uvec4 block)
{
    SluiceBc7Split best;
    uint bestRotation = 4u;
    for (uint rotation = 0u; rotation < 4u; rotation++) {
        vec4 rotated[16];
        float low = 1, high = 0;
        for (int i = 0; i < 16; i++) {
            rotated[i] = sluiceRotateBc7(texels[i], rotation);
            low = min(low, rotated[i].a);
            high = max(high, rotated[i].a);
        }
        SluiceBlockLine line = sluiceFitBlockLine(rotated, vec4(1, 1, 1, 0));
        line.end[0].a = low;
        line.end[1].a = high;
        for (int pass = 0; pass < 2; pass++) {
            SluiceBc7Split split;
            float error = sluiceIndexBc7Split(line, rotated, split);
            if (error < bestError) {
                bestError = error;
                best = split;
                bestRotation = rotation;
            }
        }
    }
    if (bestRotation < 4u)
        block = sluicePackBc7Split(best, bestRotation);
}

/** BC7 of RGBA, by mode 6 or 5. Channels that vary as one are best; one may be unlike the others. */
uvec4 sluiceEncodeBc7(vec4 texels[16])
{
    for (int i = 0; i < 16; i++)
        texels[i] = clamp(texels[i], 0, 1);
    SluiceBlockLine line = sluiceFitBlockLine(texels, vec4(1));
    uvec4 best[2] = uvec4[2](uvec4(0), uvec4(0));
    uint bestIndices[16];
    float bestError = 1e9;
    for (int pass = 0; pass < 3; pass++) {
        uvec4 ends[2] = uvec4[2](sluiceQuantizeBc7(line.end[0]), sluiceQuantizeBc7(line.end[1]));
        uint indices[16];
        float w[16];
        float error = sluiceIndexBc7(ends, texels, indices, w);
        if (error < bestError) {
            bestError = error;
            best = ends;
            bestIndices = indices;
        }
        line = sluiceRefitBlockLine(line, texels, w);
    }
    uvec4 block = sluicePackBc7(best, bestIndices);
    if (bestError > 64.0 / (255 * 255)) /* one step of 8 bits per value */
        sluiceTryBc7Split(texels, bestError, block);
    return block;
}

#endif /* SLUICE_ENCODE_BC7_GLSL */
