/*
 * Samples streamed textures by one texel that is chosen at random (stochastic_filter.glsl). The mean of
 * many samples is the filtered texture. The chosen texel is also the feedback: one mark of one tile,
 * without derivatives or margins.
 *
 *     vec2 random = sluiceRandomPair(uvec3(pixel, frame));
 *     vec4 color = sluiceSampleStochastic(tex, tableIndex, uv, lod, SLUICE_PICK_CUBIC, 0.0, mark, random,
 *                                         missing);
 *
 * Any mode, stage, filter and number of textures: the sampler's own filter is not used.
 *
 * For a texture set choose once, then fetch each of its textures:
 *
 *     SluicePick pick = sluicePickStreamed(primary, uv, lod, kernel, 0.0, mark, random, missing);
 *     vec4 color = sluiceFetchPick(tex, tableIndex, pick, missing);
 *
 * Include it after the definitions of buffers.glsl and feedback.glsl.
 */
#ifndef SLUICE_SAMPLE_STOCHASTIC_GLSL
#define SLUICE_SAMPLE_STOCHASTIC_GLSL

#include "feedback.glsl"
#include "sample.glsl"
#include "stochastic_filter.glsl"

/* Choices, each at a coarser LOD than the one before, until one is resident. */
#define SLUICE_PICK_TRIES 8u

/** Returns the index of the region whose tile of the pick's level has the texel. */
uint sluicePickRegion(SluiceGrid grid, SluicePick pick)
{
    /* Along odd sizes the region of a tile of level l begins at its own index << l. */
    uvec2 tile = uvec2(pick.texel) >> sluiceRegionShift(grid);
    uvec2 region = min(tile << pick.level, grid.last);
    return region.y * (grid.last.x + 1u) + region.x;
}

/** Marks the tile of a pick. Border colors mark nothing. */
void sluiceMarkPick(uint tableIndex, SluicePick pick)
{
    if (!pick.border && sluiceTakesPart(tableIndex))
        sluiceMarkRegionAt(SLUICE_TEXTURE_ENTRY(tableIndex).feedbackOffset +
                               sluicePickRegion(sluiceReadGrid(tableIndex), pick),
                           pick.level);
}

/**
 * Chooses a texel that is resident, and with `mark` marks the one that is wanted.
 *
 * Where the wanted texel is missing, the choice is repeated with the same numbers at the LOD that is
 * shown there. `lod`, `kernel`, `sigma` and `random` are those of sluicePickTexel. `missingLevels` is
 * the number of levels by which the texel is too coarse; SLUICE_MIP_UNTOUCHED if nothing is resident:
 * then the texel must not be fetched.
 */
SluicePick sluicePickStreamed(uint tableIndex, vec2 uv, float lod, uint kernel, float sigma, bool mark,
                              inout vec2 random, out uint missingLevels)
{
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    uint first = SLUICE_TEXTURE_ENTRY(tableIndex).minMipOffset, count = sluiceMipCount(grid);
    uvec2 size = uvec2(grid.size), modes = sluiceAddressModes(grid);
    vec2 numbers = random;
    lod = clamp(sluiceClampLod(lod), 0.0, float(count - 1u));
    SluicePick pick = sluicePickTexel(uv, lod, size, count, modes, kernel, sigma, random);
    if (mark)
        sluiceMarkPick(tableIndex, pick);
    uint wanted = uint(lod);
    missingLevels = 0u;
    for (uint i = 0u; !pick.border; i++) {
        uint shown = SLUICE_MIN_MIP_WORD(first + sluicePickRegion(grid, pick)) & 0xFFFFu;
        if (shown >= SLUICE_SHOWN_NOTHING) {
            missingLevels = SLUICE_MIP_UNTOUCHED;
            return pick;
        }
        float limit = max(sluiceLodLimit(shown, 0.0), 0.0);
        if (!(limit > max(lod, float(pick.level))))
            return pick;
        if (i >= SLUICE_PICK_TRIES) {
            missingLevels = SLUICE_MIP_UNTOUCHED;
            return pick;
        }
        if (i + 1u == SLUICE_PICK_TRIES) /* packed levels are resident for all regions alike */
            limit = max(limit, float(SLUICE_TEXTURE_ENTRY(tableIndex).regularMipCount));
        lod = min(limit, float(count - 1u));
        missingLevels = max(uint(ceil(lod)) - wanted, 1u);
        random = numbers;
        pick = sluicePickTexel(uv, lod, size, count, modes, kernel, sigma, random);
    }
    return pick;
}

/* The functions that take a texture, in both forms of sample.glsl. */
#define SLUICE_STOCHASTIC_FORM(form, passed)                                                       \
    /** Fetches a pick of sluicePickStreamed. `missingLevels` is what that returned. */            \
    vec4 sluiceFetchPick(form(tex), uint tableIndex, SluicePick pick, uint missingLevels)          \
    {                                                                                              \
        if (pick.border)                                                                           \
            return sluiceBorder(SLUICE_TEXTURE_ENTRY(tableIndex));                                 \
        if (missingLevels == SLUICE_MIP_UNTOUCHED)                                                 \
            return SLUICE_FALLBACK_COLOR;                                                          \
        return sluiceTexelFetch(passed(tex), tableIndex, pick.texel, pick.level);                  \
    }                                                                                              \
    /** Chooses a texel, marks the wanted one with `mark`, and returns the resident one. */        \
    vec4 sluiceSampleStochastic(form(tex), uint tableIndex, vec2 uv, float lod, uint kernel,       \
                                float sigma, bool mark, inout vec2 random, out uint missingLevels) \
    {                                                                                              \
        SluicePick pick = sluicePickStreamed(tableIndex, uv, lod, kernel, sigma, mark, random,     \
                                             missingLevels);                                       \
        return sluiceFetchPick(passed(tex), tableIndex, pick, missingLevels);                      \
    }

SLUICE_STOCHASTIC_FORM(SLUICE_SAMPLER_2D, SLUICE_PASS_SAMPLER)
#ifdef SLUICE_TEXTURE
#define SLUICE_NUMBER(tex) uint tex
#define SLUICE_PASS_NUMBER(tex) tex
SLUICE_STOCHASTIC_FORM(SLUICE_NUMBER, SLUICE_PASS_NUMBER)
#endif

#endif
