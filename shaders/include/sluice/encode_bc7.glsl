/*
 * Compresses 4 x 4 texels to a block of BC7 by modes 1, 4, 5 and 6. Only encode_blocks.glsl includes this file.
 *
 * A way to encode a block is a candidate. Invocations of a workgroup may share the candidates of a block: each
 * tries its own, and the block with the least error is taken (sluiceTryBc7).
 */
#ifndef SLUICE_ENCODE_BC7_GLSL
#define SLUICE_ENCODE_BC7_GLSL

/** Candidates of a block: mode 6, mode 5 by rotation, mode 4 by rotation and indices, mode 1. */
#define SLUICE_BC7_CANDIDATES 14u

struct SluiceBc7Candidate {
    uvec4 block;
    float error; /* sum of squares over texels and channels */
};

void sluicePutBits(inout uvec4 block, inout int at, uint value, int bits)
{
    block[at >> 5] |= value << (at & 31);
    if ((at & 31) + bits > 32)
        block[(at >> 5) + 1] |= value >> 32 - (at & 31);
    at += bits;
}

/** Returns the weight of an index of 0 to `last`: 3, 7 or 15. */
float sluiceBc7Weight(uint index, uint last)
{
    return float((index * 64u + last / 2u) / last) / 64;
}

/** Returns codes of 5 to 8 bits as 8 bits. */
uvec4 sluiceWidenBc7(uvec4 codes, uint bits)
{
    return codes << 8u - bits | codes >> 2u * bits - 8u;
}

/* --- Mode 6: one line, ends of 7 bits and a shared lowest bit, 16 weights --- */

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
        float t = sluicePlaceOnLine(line, texels[i], vec4(1));
        uint index = uint(round(t * 15));
        float off = t - sluiceBc7Weight(index, 15u);
        if (index > 0u && abs(t - sluiceBc7Weight(index - 1u, 15u)) < abs(off))
            index--;
        else if (index < 15u && abs(t - sluiceBc7Weight(index + 1u, 15u)) < abs(off))
            index++;
        indices[i] = index;
        w[i] = sluiceBc7Weight(index, 15u);
        vec4 d = mix(line.end[0], line.end[1], w[i]) - texels[i];
        error += dot(d, d);
    }
    return error;
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

SluiceBc7Candidate sluiceTryBc7Mode6(vec4 texels[16])
{
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
    return SluiceBc7Candidate(sluicePackBc7(best, bestIndices), bestError);
}

/* --- Modes 4 and 5: one channel apart, with weights of its own --- */

/* Alpha changes places with channel `rotation - 1`; 0: stays. */
vec4 sluiceRotateBc7(vec4 texel, uint rotation)
{
    return rotation == 1u   ? texel.agbr
           : rotation == 2u ? texel.rabg
           : rotation == 3u ? texel.rgab
                            : texel;
}

/*
 * Bits and indices of color (x) and alpha (y). Mode 5: 7 and 8 bits, 4 weights each. Mode 4: 5 and 6 bits; color
 * or alpha has 8 weights, the other 4.
 */
struct SluiceBc7Layout {
    uint mode, rotation;
    uvec2 bits;
    uvec2 last; /* last index: 3 or 7 */
};

struct SluiceBc7Split {
    uvec4 ends[2];
    uint indices[16]; /* index of color in 8 bits, then index of alpha */
};

/* Picks indices for two ends; `line` becomes their fit. Returns the squared error. */
float sluiceIndexBc7Split(SluiceBc7Layout kind, inout SluiceBlockLine line, vec4 texels[16],
                          out SluiceBc7Split split)
{
    const vec4 color = vec4(1, 1, 1, 0), alpha = vec4(0, 0, 0, 1);
    vec4 most = vec4(vec3((1u << kind.bits.x) - 1u), (1u << kind.bits.y) - 1u);
    SluiceBlockLine stored;
    for (int e = 0; e < 2; e++) {
        split.ends[e] = uvec4(floor(line.end[e] * most + 0.5));
        stored.end[e].rgb = vec3(sluiceWidenBc7(split.ends[e], kind.bits.x).rgb) / 255;
        stored.end[e].a = float(sluiceWidenBc7(split.ends[e], kind.bits.y).a) / 255;
    }
    float w[16], v[16], error = 0;
    for (int i = 0; i < 16; i++) {
        uint c = uint(round(sluicePlaceOnLine(stored, texels[i], color) * float(kind.last.x)));
        uint a = uint(round(sluicePlaceOnLine(stored, texels[i], alpha) * float(kind.last.y)));
        w[i] = sluiceBc7Weight(c, kind.last.x);
        v[i] = sluiceBc7Weight(a, kind.last.y);
        split.indices[i] = c | a << 8;
        vec4 d = mix(stored.end[0], stored.end[1], vec4(vec3(w[i]), v[i])) - texels[i];
        error += dot(d, d);
    }
    SluiceBlockLine colors = sluiceRefitBlockLine(stored, texels, w);
    SluiceBlockLine alphas = sluiceRefitBlockLine(stored, texels, v);
    for (int e = 0; e < 2; e++)
        line.end[e] = vec4(colors.end[e].rgb, alphas.end[e].a);
    return error;
}

uvec4 sluicePackBc7Split(SluiceBc7Layout kind, SluiceBc7Split split)
{
    /* The first indices lack their highest bit, which is 0. */
    uvec2 first = uvec2(split.indices[0] & 0xFFu, split.indices[0] >> 8);
    bvec2 turn = greaterThan(first, kind.last / 2u);
    uvec4 block = uvec4(0);
    int at = 0;
    sluicePutBits(block, at, 1u << kind.mode, int(kind.mode) + 1);
    sluicePutBits(block, at, kind.rotation, 2);
    bool swaps = kind.last.x > kind.last.y; /* the shorter indices come first */
    if (kind.mode == 4u)
        sluicePutBits(block, at, swaps ? 1u : 0u, 1);
    for (int c = 0; c < 4; c++) {
        bool swap = c < 3 ? turn.x : turn.y;
        int bits = int(c < 3 ? kind.bits.x : kind.bits.y);
        sluicePutBits(block, at, swap ? split.ends[1][c] : split.ends[0][c], bits);
        sluicePutBits(block, at, swap ? split.ends[0][c] : split.ends[1][c], bits);
    }
    for (uint k = 0u; k < 2u; k++) {
        uint s = swaps ? 1u - k : k, last = kind.last[s];
        int bits = last > 3u ? 3 : 2;
        for (int i = 0; i < 16; i++) {
            uint index = split.indices[i] >> 8u * s & 0xFFu;
            sluicePutBits(block, at, turn[s] ? last - index : index, i == 0 ? bits - 1 : bits);
        }
    }
    return block;
}

SluiceBc7Candidate sluiceTryBc7Split(vec4 texels[16], SluiceBc7Layout kind)
{
    SluiceBc7Split best;
    float low = 1, high = 0, bestError = 1e9;
    for (int i = 0; i < 16; i++) {
        texels[i] = sluiceRotateBc7(texels[i], kind.rotation);
        low = min(low, texels[i].a);
        high = max(high, texels[i].a);
    }
    SluiceBlockLine line = sluiceFitBlockLine(texels, vec4(1, 1, 1, 0));
    line.end[0].a = low;
    line.end[1].a = high;
    for (int pass = 0; pass < 2; pass++) {
        SluiceBc7Split split;
        float error = sluiceIndexBc7Split(kind, line, texels, split);
        if (error < bestError) {
            bestError = error;
            best = split;
        }
    }
    return SluiceBc7Candidate(sluicePackBc7Split(kind, best), bestError);
}

/* --- Mode 1: opaque texels in two regions, a line of 8 weights each. Ends of 6 bits and a lowest bit per region --- */

/* Bit 4 y + x: the texel is in region 1. Of the format's 64 partitions the first 16, whose region 1 has texel 15. */
const uint sluiceBc7Partitions[16] =
    uint[16](0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80, 0xe800, 0xffe8,
             0xff00, 0xfff0, 0xf000);

/* The squared distance of texels to their best line, by sums of colors and of their products. */
float sluiceBc7RegionError(float count, vec3 sum, vec3 squares, vec3 products)
{
    vec3 mean = sum / max(count, 1.0), s = squares - sum * mean;
    vec3 p = products - sum * mean.yzx; /* xy, yz, zx */
    mat3 covariance = mat3(s.x, p.x, p.z, p.x, s.y, p.y, p.z, p.y, s.z);
    vec3 axis = s.x >= s.y && s.x >= s.z ? covariance[0] : s.y >= s.z ? covariance[1] : covariance[2];
    axis = covariance * (axis / max(length(axis), 1e-10));
    axis /= max(length(axis), 1e-10);
    return s.x + s.y + s.z - dot(axis, covariance * axis);
}

uint sluicePickBc7Partition(vec4 texels[16])
{
    vec3 allSum = vec3(0), allSquares = vec3(0), allProducts = vec3(0);
    for (int i = 0; i < 16; i++) {
        allSum += texels[i].rgb;
        allSquares += texels[i].rgb * texels[i].rgb;
        allProducts += texels[i].rgb * texels[i].gbr;
    }
    uint best = 0u;
    float bestError = 1e9;
    for (uint p = 0u; p < 16u; p++) {
        float count = 0;
        vec3 sum = vec3(0), squares = vec3(0), products = vec3(0);
        for (int i = 0; i < 16; i++) {
            float member = float(sluiceBc7Partitions[p] >> i & 1u);
            count += member;
            sum += member * texels[i].rgb;
            squares += member * texels[i].rgb * texels[i].rgb;
            products += member * texels[i].rgb * texels[i].gbr;
        }
        float error = sluiceBc7RegionError(count, sum, squares, products) +
                      sluiceBc7RegionError(16 - count, allSum - sum, allSquares - squares, allProducts - products);
        if (error < bestError) {
            bestError = error;
            best = p;
        }
    }
    return best;
}

/* Codes of 7 bits, whose lowest bits are all equal: of the two ways, the nearer one. */
void sluiceQuantizeBc7Region(SluiceBlockLine line, out uvec4 ends[2])
{
    float leastError = 1e9;
    for (uint p = 0u; p < 2u; p++) {
        uvec4 codes[2];
        float error = 0;
        for (int e = 0; e < 2; e++) {
            vec4 c = line.end[e] * 127;
            codes[e] = uvec4(clamp(floor((c - float(p)) / 2 + 0.5), 0, 63)) * 2u + p;
            vec3 d = vec3(codes[e].rgb) - c.rgb;
            error += dot(d, d);
        }
        if (error < leastError) {
            leastError = error;
            ends = codes;
        }
    }
}

/* Fits the texels of `members`; their indices are written. Returns the squared error. */
float sluiceFitBc7Region(vec4 texels[16], uint members, out uvec4 bestEnds[2], inout uint bestIndices[16])
{
    const vec4 color = vec4(1, 1, 1, 0);
    SluiceBlockLine line = sluiceFitPartOfBlock(texels, members, color);
    float bestError = 1e9;
    for (int pass = 0; pass < 2; pass++) {
        uvec4 ends[2];
        uint indices[16];
        float w[16], error = 0;
        sluiceQuantizeBc7Region(line, ends);
        SluiceBlockLine stored = SluiceBlockLine(
            vec4[2](vec4(sluiceWidenBc7(ends[0], 7u)) / 255, vec4(sluiceWidenBc7(ends[1], 7u)) / 255));
        for (int i = 0; i < 16; i++) {
            indices[i] = uint(round(sluicePlaceOnLine(stored, texels[i], color) * 7));
            w[i] = sluiceBc7Weight(indices[i], 7u);
            vec3 d = mix(stored.end[0], stored.end[1], w[i]).rgb - texels[i].rgb;
            error += (members >> i & 1u) != 0u ? dot(d, d) : 0;
        }
        if (error < bestError) {
            bestError = error;
            bestEnds = ends;
            for (int i = 0; i < 16; i++)
                bestIndices[i] = (members >> i & 1u) != 0u ? indices[i] : bestIndices[i];
        }
        line = sluiceRefitPartOfBlock(line, texels, members, w);
    }
    return bestError;
}

SluiceBc7Candidate sluiceTryBc7Mode1(vec4 texels[16])
{
    float least = 1;
    for (int i = 0; i < 16; i++)
        least = min(least, texels[i].a);
    if (least < 1)
        return SluiceBc7Candidate(uvec4(0), 1e9);
    uint number = sluicePickBc7Partition(texels), members = sluiceBc7Partitions[number];
    uvec4 ends[4], one[2];
    uint indices[16];
    float error = 0;
    for (int i = 0; i < 16; i++)
        indices[i] = 0u;
    for (uint r = 0u; r < 2u; r++) {
        uint region = r == 0u ? ~members & 0xFFFFu : members;
        error += sluiceFitBc7Region(texels, region, one, indices);
        /* The indices of texels 0 and 15 lack their highest bit, which is 0. */
        bool turn = indices[r * 15u] > 3u;
        ends[2u * r] = turn ? one[1] : one[0];
        ends[2u * r + 1u] = turn ? one[0] : one[1];
        for (int i = 0; i < 16; i++)
            indices[i] = turn && (region >> i & 1u) != 0u ? 7u - indices[i] : indices[i];
    }
    uvec4 block = uvec4(0);
    int at = 0;
    sluicePutBits(block, at, 2u, 2);
    sluicePutBits(block, at, number, 6);
    for (int c = 0; c < 3; c++)
        for (int e = 0; e < 4; e++)
            sluicePutBits(block, at, ends[e][c] >> 1, 6);
    sluicePutBits(block, at, ends[0].x & 1u, 1);
    sluicePutBits(block, at, ends[2].x & 1u, 1);
    for (int i = 0; i < 16; i++)
        sluicePutBits(block, at, indices[i], i == 0 || i == 15 ? 2 : 3);
    return SluiceBc7Candidate(block, error);
}

/** Encodes by one candidate, 0 to SLUICE_BC7_CANDIDATES - 1. Values of texels are 0 to 1. */
SluiceBc7Candidate sluiceTryBc7(vec4 texels[16], uint candidate)
{
    if (candidate == 0u)
        return sluiceTryBc7Mode6(texels);
    if (candidate == 13u)
        return sluiceTryBc7Mode1(texels);
    uint mode = candidate < 5u ? 5u : 4u;
    bool swaps = candidate > 8u;
    return sluiceTryBc7Split(texels, SluiceBc7Layout(mode, candidate - 1u & 3u, mode == 5u ? uvec2(7, 8) : uvec2(5, 6),
                                                     mode == 5u ? uvec2(3) : swaps ? uvec2(7, 3) : uvec2(3, 7)));
}

/** BC7 of RGBA, by the best candidate. Blocks with an error of one step of 8 bits per value stay in mode 6. */
uvec4 sluiceEncodeBc7(vec4 texels[16])
{
    for (int i = 0; i < 16; i++)
        texels[i] = clamp(texels[i], 0, 1);
    SluiceBc7Candidate best = sluiceTryBc7(texels, 0u);
    for (uint c = 1u; c < SLUICE_BC7_CANDIDATES && best.error > 64.0 / (255 * 255); c++) {
        SluiceBc7Candidate candidate = sluiceTryBc7(texels, c);
        if (candidate.error < best.error)
            best = candidate;
    }
    return best.block;
}

#endif /* SLUICE_ENCODE_BC7_GLSL */
