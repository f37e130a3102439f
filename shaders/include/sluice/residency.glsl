/*
 * Checks with residency codes that a sample touches only resident texels. For tests and debug
 * views.
 *
 * Requires the feature shaderResourceResidency and sparse images: a widely used driver crashes for
 * other images. Without them define SLUICE_NO_RESIDENCY_CODES: then paged mode is checked by its
 * page table, and dense mode is not checked.
 *
 * The sampler must filter NEAREST between levels and LINEAR within them: a widely used driver
 * returns wrong codes for other filters.
 */
#ifndef SLUICE_RESIDENCY_GLSL
#define SLUICE_RESIDENCY_GLSL

#include "sample.glsl"

#ifndef SLUICE_NO_RESIDENCY_CODES
#ifndef SLUICE_HLSL
#extension GL_ARB_sparse_texture2 : require
#endif
#endif

/*
 * Clamps a coordinate so that its filter stays inside the image. False if that is impossible (one
 * texel).
 */
bool sluiceStayInside(inout float coordinate, uint size)
{
    coordinate = clamp(coordinate, 0.75 / float(size), 1.0 - 0.75 / float(size));
    return size > 1u;
}

/**
 * Returns 1 if a texel that the LINEAR filter needs at `uv` and `level` is not resident, else 0.
 *
 * Border colors use no memory, and drivers disagree on whether they are resident. So with
 * CLAMP_TO_BORDER the nearest coordinate inside is probed.
 */
uint sluiceProbeNonResident(SLUICE_SAMPLER_2D(nearestMipTex), SluiceTextureEntry entry, vec2 uv, float level)
{
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(entry.shape))
        return sluiceCountUnpaged(entry, uint(level), uv);
#endif
#ifdef SLUICE_NO_RESIDENCY_CODES
    return 0u;
#else
    vec4 texel;
    if ((entry.flags & SLUICE_TEXTURE_FLAG_DENSE) != 0u) /* its image is not sparse */
        return 0u;
    bool inside = true;
    if (entry.addressModeU == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER)
        inside = sluiceStayInside(uv.x, max(entry.width >> uint(level), 1u));
    if (entry.addressModeV == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER)
        inside = sluiceStayInside(uv.y, max(entry.height >> uint(level), 1u)) && inside;
    if (!inside)
        return 0u;
#ifdef SLUICE_HLSL
    uint status;
    texel = nearestMipTex.SampleLevel(nearestMipTexSampler, uv, level, int2(0, 0), status);
    return CheckAccessFullyMapped(status) ? 0u : 1u;
#else
    return sparseTexelsResidentARB(sparseTextureLodARB(nearestMipTex, uv, level, texel)) ? 0u : 1u;
#endif
#endif
}

/**
 * Counts the positions and levels that sluiceSample and sluiceSampleGrad touch with the same
 * arguments and that are not resident. Must be 0.
 */
uint sluiceCountNonResident(SLUICE_SAMPLER_2D(nearestMipTex), uint tableIndex, vec2 uv, vec2 dx, vec2 dy,
                            float lodBias, float maxAnisotropy)
{
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex);
    SluiceSampling s = sluiceResolveSampling(tableIndex, uv, dx, dy, lodBias, maxAnisotropy);
    if (s.level == SLUICE_MIP_UNTOUCHED)
        return 0u;
    float last = float(entry.mipLevelCount - 1u);
    float fine = float(s.level);
    float coarse = ceil(clamp(s.lod, 0.0, last));
    float widest = coarse;
    uint taps = 1u;
    vec2 axis = SLUICE_SPLAT(vec2, 0.0);
    if (maxAnisotropy > 1.0) {
        taps = 9u;
        vec2 size = vec2(entry.width, entry.height);
        axis = length(s.dx * size) >= length(s.dy * size) ? s.dx : s.dy;
        float reach = sluiceOverreachedLod(entry.shape, s.dx * size, s.dy * size, 0.0, maxAnisotropy);
        widest = max(coarse, float(sluiceCoarsestLevel(reach, entry.mipLevelCount)));
    }
    bool spline = SLUICE_CUBIC && (entry.shape & SLUICE_SHAPE_SPLINE) != 0u;
    uint count = 0u;
    for (uint i = 0u; i < taps; i++) {
        vec2 at = s.uv + (taps > 1u ? axis * (float(i) / float(taps - 1u) - 0.5) : SLUICE_SPLAT(vec2, 0.0));
        for (float level = fine; level <= widest; level++) {
            if (!spline) {
                count += sluiceProbeNonResident(SLUICE_PASS_SAMPLER(nearestMipTex), entry, at, level);
                continue;
            }
            vec2 texel = 1.0 / vec2(max(uvec2(entry.width, entry.height) >> uint(level), SLUICE_SPLAT(uvec2, 1u)));
            for (uint corner = 0u; corner < 4u; corner++) { /* corners of 4x4 texels */
                vec2 off = texel * (vec2(corner & 1u, corner >> 1u) * 2.0 - 1.0);
                count += sluiceProbeNonResident(SLUICE_PASS_SAMPLER(nearestMipTex), entry, at + off, level);
            }
        }
    }
    return count;
}

#endif
