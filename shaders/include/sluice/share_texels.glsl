/*
 * Shares decoded texels among the invocations of a subgroup, where textures are magnified and neighbors
 * need the same texels. For textures that are costly to decode:
 *
 *     SluiceSharing s = sluiceBeginSharing(tableIndex, uv, lod, size, levelCount, modes, SLUICE_PICK_LINEAR, random);
 *     vec4 own = vec4(0.0);
 *     if (s.decode)
 *         own = decode(s.pick.texel, s.pick.level);  // or the border color, if s.pick.border
 *     vec4 color = sluiceFinishSharing(s, own);
 *
 * If the texels of all samples of the subgroup fit into a box of as many texels as there are
 * invocations, each decodes one texel of the box, and every sample is filtered exactly: s.exact. No
 * noise, and less than one decode per sample. Otherwise each decodes one random texel. Where `lod` is below
 * SLUICE_SHARE_QUAD_LOD, the four invocations of a quad use each other's: less noise, one decode per sample.
 * With more than four channels call sluiceFinishSharing for each four.
 *
 * Call both functions in uniform control flow. Invocations 4 k to 4 k + 3 of a subgroup are a quad: in
 * compute shaders arrange pixels so. The random numbers of a quad must be independent.
 *
 * Requires the subgroup operations BASIC, VOTE, ARITHMETIC, BALLOT, SHUFFLE and QUAD in the stage. Without
 * them define SLUICE_NO_SUBGROUPS: then each sample is its own random texel.
 *
 * For POINT, LINEAR and CUBIC. The mean of many samples is the filter in all cases.
 *
 * Sources: Wronski, Pharr and Akenine-Moeller, "Improved Stochastic Texture Filtering Through Sample
 * Reuse", 2025; Akenine-Moeller et al., "Collaborative Texture Filtering", 2025. Weights of a quad:
 * balance heuristic, Veach and Guibas, "Optimally Combining Sampling Techniques", SIGGRAPH 1995.
 */
#ifndef SLUICE_SHARE_TEXELS_GLSL
#define SLUICE_SHARE_TEXELS_GLSL

#ifndef SLUICE_NO_SUBGROUPS
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_quad : require
#endif

#include "stochastic_filter.glsl"

/* LOD from which on texels of the quad count. Near 0, neighbors draw texels that seldom are a pixel's own:
 * their weights then vary more than one texel does. */
#define SLUICE_SHARE_QUAD_LOD (-0.75)

/** A sample of a subgroup. Use `pick`, `decode` and `exact`; the rest is for sluiceFinishSharing. */
struct SluiceSharing {
    SluicePick pick; /* the texel that this invocation decodes */
    bool decode;     /* false: it decodes none */
    bool exact;      /* the result is exact within pick.level */
    bool quad;       /* if it is not, texels of the quad count */
    uint key, kernel;
    vec2 at;     /* sample position in texels of the level, relative to a corner that the subgroup shares */
    ivec2 texel; /* random texel relative to the same corner, not wrapped */
    ivec2 low, size; /* corner and size of the box */
};

/** Returns how many texels of a kernel lie side by side. */
int sluiceKernelWidth(uint kernel)
{
    return kernel == SLUICE_PICK_CUBIC ? 4 : kernel == SLUICE_PICK_LINEAR ? 2 : 1;
}

/** Returns the first texel, along each axis, of a kernel around a position in texels. */
ivec2 sluiceKernelLow(uint kernel, vec2 at)
{
    if (kernel == SLUICE_PICK_POINT)
        return ivec2(floor(at));
    return ivec2(floor(at - 0.5)) - (kernel == SLUICE_PICK_CUBIC ? 1 : 0);
}

/** Returns the weights of texels low to low + 3 along an axis. */
vec4 sluiceKernelWeights(uint kernel, float at)
{
    float t = at - 0.5 - floor(at - 0.5);
    if (kernel == SLUICE_PICK_CUBIC)
        return sluiceSplineWeights(t);
    return kernel == SLUICE_PICK_LINEAR ? vec4(1.0 - t, t, 0.0, 0.0) : vec4(1.0, 0.0, 0.0, 0.0);
}

/** Returns the weight of a texel in a sample. */
float sluiceTexelWeight(uint kernel, vec2 at, ivec2 texel)
{
    ivec2 place = texel - sluiceKernelLow(kernel, at);
    if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, ivec2(sluiceKernelWidth(kernel)))))
        return 0.0;
    return sluiceKernelWeights(kernel, at.x)[place.x] * sluiceKernelWeights(kernel, at.y)[place.y];
}

/** Returns the corner of the repetition that a coordinate is in. */
float sluiceRepetition(float coordinate, uint addressMode)
{
    if (addressMode == SLUICE_ADDRESS_MODE_REPEAT)
        return floor(coordinate);
    return addressMode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT ? 2.0 * floor(coordinate * 0.5) : 0.0;
}

#ifndef SLUICE_NO_SUBGROUPS
/** Returns whether a box fits the active invocations, which must be the first of the subgroup. */
bool sluiceFitsSubgroup(ivec2 box)
{
    uvec4 lanes = subgroupBallot(true);
    int count = int(subgroupBallotBitCount(lanes));
    bool first = int(subgroupBallotFindMSB(lanes)) + 1 == count;
    return first && max(box.x, box.y) <= count && box.x * box.y <= count;
}

/** Gives each invocation a texel of the box, if all samples have their texels in it. */
void sluiceShareBox(inout SluiceSharing s, ivec2 n, uvec2 addressModes)
{
    ivec2 low = sluiceKernelLow(s.kernel, s.at);
    s.low = subgroupMin(low);
    s.size = subgroupMax(low) + sluiceKernelWidth(s.kernel) - s.low;
    bool alike = subgroupAllEqual(s.key) && subgroupAllEqual(s.pick.level) && subgroupAllEqual(s.kernel);
    s.exact = alike && sluiceFitsSubgroup(s.size);
    if (!s.exact)
        return;
    int i = int(gl_SubgroupInvocationID);
    s.decode = i < s.size.x * s.size.y;
    s.pick = sluiceAddressPick(s.low + ivec2(i % s.size.x, i / s.size.x), s.pick.level, n, addressModes);
}

/** Returns the filtered color, of texels that other invocations decoded. */
vec4 sluiceGatherBox(SluiceSharing s, vec4 own)
{
    ivec2 place = sluiceKernelLow(s.kernel, s.at) - s.low;
    vec4 x = sluiceKernelWeights(s.kernel, s.at.x), y = sluiceKernelWeights(s.kernel, s.at.y), sum = vec4(0.0);
    int width = sluiceKernelWidth(s.kernel);
    for (int i = 0; i < width * width; i++) {
        ivec2 tap = ivec2(i % width, i / width);
        int from = (place.y + tap.y) * s.size.x + place.x + tap.x;
        sum += x[tap.x] * y[tap.y] * subgroupShuffle(own, uint(from));
    }
    return sum;
}

#define SLUICE_ADD_FROM_QUAD(i)                                                                    \
    {                                                                                              \
        bool alike = subgroupQuadBroadcast(s.key, i) == s.key &&                                   \
                     subgroupQuadBroadcast(s.pick.level, i) == s.pick.level;                       \
        ivec2 texel = subgroupQuadBroadcast(s.texel, i);                                           \
        vec4 color = subgroupQuadBroadcast(own, i);                                                \
        float weight = alike ? sluiceTexelWeight(s.kernel, s.at, texel) : 0.0;                     \
        float total = weight + subgroupQuadSwapHorizontal(weight);                                 \
        total += subgroupQuadSwapVertical(total);                                                  \
        if (weight > 0.0)                                                                          \
            sum += weight / total * color;                                                        \
    }

/** Returns the mean of the quad's texels by their weights: each counts for all that might draw it. */
vec4 sluiceGatherQuad(SluiceSharing s, vec4 own)
{
    vec4 sum = vec4(0.0);
    SLUICE_ADD_FROM_QUAD(0u)
    SLUICE_ADD_FROM_QUAD(1u)
    SLUICE_ADD_FROM_QUAD(2u)
    SLUICE_ADD_FROM_QUAD(3u)
    return sum;
}
#endif

/**
 * Chooses the texel that this invocation decodes. Arguments are those of sluicePickTexel; `kernel` is POINT,
 * LINEAR or CUBIC. `key` tells textures apart: samples of different textures are not shared.
 */
SluiceSharing sluiceBeginSharing(uint key, vec2 uv, float lod, uvec2 size, uint levelCount, uvec2 addressModes,
                                 uint kernel, inout vec2 random)
{
    random = clamp(random, 0.0, SLUICE_RANDOM_LAST);
    uint level = sluicePickLevel(lod, levelCount, random.x);
    ivec2 n = sluicePickSize(size, level);
    if (!sluiceIsFinite(uv))
        uv = vec2(0.0);
    vec2 corner = vec2(sluiceRepetition(uv.x, addressModes.x), sluiceRepetition(uv.y, addressModes.y));
#ifndef SLUICE_NO_SUBGROUPS
    corner = subgroupBroadcastFirst(corner);
#endif
    SluiceSharing s;
    s.decode = true;
    s.exact = false;
    s.quad = lod <= SLUICE_SHARE_QUAD_LOD;
    s.key = key;
    s.kernel = kernel;
    s.at = clamp((uv - corner) * vec2(n), -SLUICE_PICK_MAX_TEXEL, SLUICE_PICK_MAX_TEXEL);
    s.texel = ivec2(sluicePickAlong(s.at.x, kernel, random.x), sluicePickAlong(s.at.y, kernel, random.y));
    s.pick = sluiceAddressPick(s.texel, level, n, addressModes);
    s.low = s.size = ivec2(0);
#ifndef SLUICE_NO_SUBGROUPS
    sluiceShareBox(s, n, addressModes);
#endif
    return s;
}

/** Returns the color of a sample. `own` is the texel that this invocation decoded. */
vec4 sluiceFinishSharing(SluiceSharing s, vec4 own)
{
#ifdef SLUICE_NO_SUBGROUPS
    return own;
#else
    if (s.exact) /* for all of the subgroup or none */
        return sluiceGatherBox(s, own);
    vec4 color = sluiceGatherQuad(s, own);
    return s.quad ? color : own;
#endif
}

#endif
