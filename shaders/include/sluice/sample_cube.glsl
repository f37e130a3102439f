/*
 * Samples streamed cube maps (SluiceVulkanTextureCreateInfo.cube) where they are resident. Samples near
 * an edge are filtered with the texels of the faces beyond, and one level is chosen for all faces that
 * a sample touches, so edges do not show.
 *
 * Every function takes the texture first, in one of three forms:
 *
 *     samplerCube tex                   SluiceVulkanTexture.cubeView
 *     samplerCubeArray tex, uint cube   SluiceVulkanTexture.cubeArrayView, and the number of the cube
 *     uint number                       SLUICE_CUBE_TEXTURE(number) is a samplerCube; need not be uniform
 *
 * The third form exists if SLUICE_CUBE_TEXTURE is defined. bindings.glsl defines it for the array of
 * textures of a streamer; the number is then `tableIndex`. For an array of cube views of your own:
 *
 *     #define SLUICE_CUBE_TEXTURE(i) cubes[nonuniformEXT(i)]
 *     vec4 color = sluiceSampleCube(number, tableIndex, direction, 0.0, 1.0, missing);
 *
 * `tableIndex` is SluiceVulkanTexture.tableIndex of the first face of the cube. Directions need not have
 * length 1. The sampler must have no LOD bias, minLod 0 and maxLod VK_LOD_CLAMP_NONE. Its address modes
 * and its anisotropy do not matter. Write feedback by feedback_cube.glsl.
 *
 * Samplers are given levels, never derivatives: near edges some devices derive finer levels than
 * the formula, which may not be resident (docs/drivers.md). Anisotropic samples are rows of samples, in
 * all modes. In paged mode the sampler sees only the packed levels.
 *
 * The functions are long, and compiled where they are called: call one function, in one place. Include
 * the file after the definitions of buffers.glsl. Requires GL_EXT_control_flow_attributes, an extension of
 * the compiler only.
 */
#ifndef SLUICE_SAMPLE_CUBE_GLSL
#define SLUICE_SAMPLE_CUBE_GLSL

#include "language.glsl"
#ifndef SLUICE_HLSL
#extension GL_EXT_control_flow_attributes : require
#endif

#include "cube.glsl"
#include "page_filter.glsl"
#include "sample.glsl"

/* Readings of the MinMip buffers of a sample that gets coarser, before packed levels are used. */
#define SLUICE_CUBE_READINGS 8u

/**
 * Returns the largest halves of the MinMip words of all faces under a sample of `finest` to `coarsest`
 * (sluiceMaxMinMip).
 */
uint sluiceMaxCubeMinMip(uint tableIndex, SluiceGrid grid, SluiceCubePoint p, vec2 halfBox, uint finest,
                         uint coarsest)
{
    uint words = sluiceMaxMinMip(SLUICE_TEXTURE_ENTRY(tableIndex + p.face).minMipOffset, grid,
                                 sluiceComputeFootprint(grid, p.uv, halfBox, coarsest), finest);
    vec2 reach = sluiceCubeReach(grid, halfBox, coarsest);
    SLUICE_DONT_UNROLL for (uint edge = 0u; edge < 4u; edge++) {
        if (!sluiceCrossesEdge(p.uv, reach, edge))
            continue;
        SluiceCubePart part = sluiceUnfoldEdge(grid, p.face, p.uv, halfBox, reach, edge);
        SluiceFootprint footprint = sluiceComputeFootprint(grid, part.uv, part.halfBox, coarsest);
        words = sluiceMaxHalves(
            words, sluiceMaxMinMip(SLUICE_TEXTURE_ENTRY(tableIndex + part.face).minMipOffset, grid,
                                   footprint, finest));
    }
    return words;
}

/** Returns true if a sample certainly touches only resident texels, all on one face. */
bool sluiceIsCubeSurelyThere(uint tableIndex, SluiceCubePoint p, float lodBias, float maxAnisotropy)
{
    vec2 size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
    vec2 tx = p.dx * size, ty = p.dy * size;
    float squares = (dot(tx, tx) + dot(ty, ty)) * sluiceBiasScale2(lodBias);
    vec2 reach = SLUICE_REACH * sqrt(max(squares, 1.0)) / size;
    return p.finite && all(lessThanEqual(abs(p.uv - 0.5) + reach, SLUICE_SPLAT(vec2, 0.5))) && /* false for NaN */
           sluiceIsSurelyThere(tableIndex + p.face, p.uv, p.dx, p.dy, lodBias, maxAnisotropy);
}

/**
 * Determines what a sample may touch, like sluiceResolveSampling. The result is in uv of face p.face.
 *
 * The level is coarsened until all regions that the sample touches at that level, on all faces, have
 * it. It touches more of them as it gets coarser.
 */
SluiceSampling sluiceResolveCube(uint tableIndex, SluiceCubePoint p, float lodBias, float maxAnisotropy)
{
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    uint count = sluiceMipCount(grid);
    float margin = sluiceLodMargin(maxAnisotropy);
    float biasScale = exp2(sluiceClampLodBias(lodBias));
    vec2 largest = SLUICE_SPLAT(vec2, SLUICE_MAX_TEXELS) / (grid.size * max(biasScale, 1.0));
    bool finite = p.finite && all(lessThanEqual(abs(p.dx), largest)) && all(lessThanEqual(abs(p.dy), largest));
    vec2 zero = SLUICE_SPLAT(vec2, 0.0);
    vec2 tx = finite ? p.dx * grid.size : zero, ty = finite ? p.dy * grid.size : zero;
    vec2 lods = finite ? sluiceComputeLods(tx, ty, lodBias, maxAnisotropy) : SLUICE_SPLAT(vec2, SLUICE_LOD_LIMIT);
    vec2 halfBox = sluiceHalfBox(tx, ty, lodBias, maxAnisotropy);
    float packed = float(SLUICE_TEXTURE_ENTRY(tableIndex).regularMipCount) + margin;

    SluiceSampling s;
    s.uv = p.uv;
    s.dx = finite ? p.dx * biasScale : zero;
    s.dy = finite ? p.dy * biasScale : zero;
    s.lod = lods.x;
    s.wantedLevel = sluiceFinestLevel(s.lod, margin, count);
    s.minLod = 0.0;
    s.plain = false;
    uint coarsest = sluiceCoarsestLevel(lods.y, count);
    SLUICE_DONT_UNROLL for (uint reading = 0u;; reading++) {
        uint finest = sluiceFinestLevel(s.lod, margin, count);
        uint shown = sluiceMaxCubeMinMip(tableIndex, grid, p, halfBox, finest, coarsest) & 0xFFFFu;
        if (shown >= SLUICE_SHOWN_NOTHING) {
            s.level = s.missing = SLUICE_MIP_UNTOUCHED;
            return s;
        }
        float limit = sluiceLodLimit(shown, margin);
        if (!(limit > s.lod))
            break;
        s.lod = max(reading < SLUICE_CUBE_READINGS ? min(limit, packed) : packed, s.lod);
        if (maxAnisotropy > 1.0)
            halfBox = max(halfBox, SLUICE_SPLAT(vec2, exp2(s.lod - margin)));
        coarsest = max(coarsest, sluiceCoarsestLevel(s.lod + margin, count));
        if (reading > SLUICE_CUBE_READINGS) /* packed levels */
            break;
    }
    bool clamped = s.lod > lods.x;
    s.level = sluiceFinestLevel(s.lod, margin, count);
    s.missing = clamped ? max(uint(ceil(max(s.lod - margin, 0.0))) - s.wantedLevel, 1u) : 0u;
    if (!finite)
        s.lod = min(s.lod, float(s.level) + margin);
    return s;
}

#ifdef SLUICE_PAGED
/** Fetches a texel of a regular level. Texels beyond one edge are those of the face there. */
vec4 sluiceFetchCubePaged(uint tableIndex, uint face, uint level, ivec2 texel, int size)
{
    if (any(notEqual(texel, clamp(texel, SLUICE_SPLAT(ivec2, 0), SLUICE_SPLAT(ivec2, size - 1))))) {
        vec2 uv = sluiceFoldOverEdge(face, (vec2(texel) + 0.5) / float(size));
        texel = clamp(ivec2(uv * float(size)), SLUICE_SPLAT(ivec2, 0), SLUICE_SPLAT(ivec2, size - 1));
    }
    return sluiceFetchPaged(SLUICE_TEXTURE_ENTRY(tableIndex + face), level, texel);
}

/**
 * Returns a bilinear sample of a regular level. Where three faces meet there is no fourth texel: it is
 * the mean of the others, as Vulkan recommends.
 */
vec4 sluiceSampleCubePages(uint tableIndex, uint face, uint level, vec2 uv)
{
    SluiceTextureEntry entry = SLUICE_TEXTURE_ENTRY(tableIndex + face);
    int size = sluiceLevelSize(entry, level).x;
    vec2 at = floor(uv * float(size) * SLUICE_FILTER_STEPS - (0.5 * SLUICE_FILTER_STEPS - 0.5)) /
              SLUICE_FILTER_STEPS;
    ivec2 low = ivec2(floor(at)), shift = sluiceTileShift(entry), tile = low >> shift;
    vec2 weight = at - floor(at);
    vec4 sum = SLUICE_SPLAT(vec4, 0.0), known = SLUICE_SPLAT(vec4, 0.0);
    if (min(low.x, low.y) >= 0 && max(low.x, low.y) < size - 1 && all(equal(low + 1 >> shift, tile))) {
        uint page = sluiceReadPage(entry, level, tile);
        vec3 local = vec3((vec2(low - (tile << shift)) + weight + 0.5) / vec2(SLUICE_SPLAT(ivec2, 1) << shift),
                          float(page & 0xFFFFu));
        if (page != SLUICE_PAGE_NONE)
            SLUICE_WITH_PAGE(page, sum = SLUICE_ARRAY_SAMPLE(SLUICE_PAGE_TEXTURE(chunk), SLUICE_PAGE_SAMPLER(chunk), local))
        return sum;
    }
    float corner = 0.0;
    SLUICE_DONT_UNROLL for (int i = 0; i < 4; i++) {
        ivec2 side = ivec2(i & 1, i >> 1), texel = low + side;
        vec2 shares = mix(1.0 - weight, weight, vec2(side));
        float share = shares.x * shares.y;
        bvec2 outside = notEqual(texel, clamp(texel, SLUICE_SPLAT(ivec2, 0), SLUICE_SPLAT(ivec2, size - 1)));
        if (all(outside))
            corner = share;
        if (all(outside) || !(share > 0.0)) /* texels of weight 0 may be infinite */
            continue;
        vec4 color = sluiceFetchCubePaged(tableIndex, face, level, texel, size);
        sum += share * color;
        known += color;
    }
    return sum + corner * known / 3.0;
}
#endif

#ifdef SLUICE_HLSL
#define SLUICE_SAMPLER_CUBE(tex) TextureCube tex, SamplerState tex##Sampler
#define SLUICE_SAMPLER_CUBE_ARRAY(tex) TextureCubeArray tex, SamplerState tex##Sampler
#else
#define SLUICE_SAMPLER_CUBE(tex) samplerCube tex
#define SLUICE_SAMPLER_CUBE_ARRAY(tex) samplerCubeArray tex
#endif

/* The functions that take a texture, in all forms. */
#define SLUICE_CUBE_PARAMETERS SLUICE_SAMPLER_CUBE(tex)
#define SLUICE_CUBE_ARGUMENTS SLUICE_PASS_SAMPLER(tex)
#define SLUICE_CUBE_SAMPLER tex
#define SLUICE_CUBE_STATE SLUICE_SAMPLER_OF(tex)
#define SLUICE_CUBE_COORDINATE(direction) direction
#include "sample_cube_textures.glsl"
#define SLUICE_CUBE_PARAMETERS SLUICE_SAMPLER_CUBE_ARRAY(tex), uint cube
#define SLUICE_CUBE_ARGUMENTS SLUICE_PASS_SAMPLER(tex), cube
#define SLUICE_CUBE_SAMPLER tex
#define SLUICE_CUBE_STATE SLUICE_SAMPLER_OF(tex)
#define SLUICE_CUBE_COORDINATE(direction) vec4(direction, float(cube))
#include "sample_cube_textures.glsl"
#ifdef SLUICE_CUBE_TEXTURE
#define SLUICE_CUBE_PARAMETERS uint number
#define SLUICE_CUBE_ARGUMENTS number
#define SLUICE_CUBE_SAMPLER SLUICE_CUBE_TEXTURE(number)
#define SLUICE_CUBE_STATE SLUICE_CUBE_TEXTURE_SAMPLER(number)
#define SLUICE_CUBE_COORDINATE(direction) direction
#include "sample_cube_textures.glsl"
#endif

#endif
