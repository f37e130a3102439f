/*
 * The functions of sample_cube.glsl that take a texture. Only sample_cube.glsl includes this file, once
 * for each form of the texture.
 *
 * SLUICE_CUBE_PARAMETERS and SLUICE_CUBE_ARGUMENTS pass a texture on, SLUICE_CUBE_SAMPLER turns it into
 * a sampler, SLUICE_CUBE_STATE into the SamplerState of HLSL, and SLUICE_CUBE_COORDINATE a direction into
 * the sampler's coordinate. All are undefined at the end.
 */
#ifdef SLUICE_PAGED
/** Returns a bilinear sample of any level. The texture has the packed levels. */
vec4 sluiceSampleCubeLevel(SLUICE_CUBE_PARAMETERS, uint tableIndex, uint face, uint level, vec2 uv)
{
    uint regular = SLUICE_TEXTURE_ENTRY(tableIndex).regularMipCount;
    if (level >= regular)
        return SLUICE_TEXTURE_LOD(SLUICE_CUBE_SAMPLER, SLUICE_CUBE_STATE,
                                  SLUICE_CUBE_COORDINATE(sluiceCubeDirection(face, uv)), float(level - regular));
    return sluiceSampleCubePages(tableIndex, face, level, uv);
}

/** Returns one sample of a row. Beyond an edge it is on the face there. */
vec4 sluiceSampleCubePaged(SLUICE_CUBE_PARAMETERS, uint tableIndex, uint face, vec2 uv, SluicePagedTaps taps)
{
    if (any(notEqual(uv, clamp(uv, 0.0, 1.0)))) {
        vec3 zero = SLUICE_SPLAT(vec3, 0.0);
        SluiceCubePoint at = sluiceFindCubePoint(sluiceCubeDirection(face, uv), zero, zero);
        face = at.face;
        uv = at.uv;
    }
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    SLUICE_DONT_UNROLL for (uint i = 0u; i < 2u; i++) {
        float share = i > 0u ? taps.fraction : 1.0 - taps.fraction;
        if (share > 0.0) /* otherwise the level may be infinite */
            sum += share * sluiceSampleCubeLevel(SLUICE_CUBE_ARGUMENTS, tableIndex, face,
                                                 i > 0u ? taps.coarse : taps.fine, uv);
    }
    return sum;
}
#endif

/**
 * Samples a face at `lod`, as a row of samples along the longer derivative (sluicePlaceTaps). Derivatives
 * are those of uv and include the LOD bias. The sampler sees no derivatives.
 */
vec4 sluiceTextureCube(SLUICE_CUBE_PARAMETERS, uint tableIndex, uint face, vec2 uv, vec2 dx, vec2 dy,
                       float lod, float maxAnisotropy)
{
    SluiceGrid grid = sluiceReadGrid(tableIndex);
    uint count = sluiceMipCount(grid), regular = 0u;
#ifdef SLUICE_PAGED
    if (SLUICE_HAS_PAGES(SLUICE_TEXTURE_ENTRY(tableIndex).shape))
        regular = SLUICE_TEXTURE_ENTRY(tableIndex).regularMipCount;
#endif
    lod = clamp(lod, 0.0, float(count - 1u));
    SluicePagedTaps taps =
        sluicePlaceTaps(grid.size, count, dx, dy, lod, sluiceClampAnisotropy(maxAnisotropy));
    vec4 sum = SLUICE_SPLAT(vec4, 0.0);
    SLUICE_DONT_UNROLL for (uint i = 0u; i < taps.count; i++) {
        vec2 at = uv + taps.axis * ((float(i) + 0.5) / float(taps.count) - 0.5);
#ifdef SLUICE_PAGED
        if (lod < float(regular)) {
            sum += sluiceSampleCubePaged(SLUICE_CUBE_ARGUMENTS, tableIndex, face, at, taps);
            continue;
        }
#endif
        sum += SLUICE_TEXTURE_LOD(SLUICE_CUBE_SAMPLER, SLUICE_CUBE_STATE,
                                  SLUICE_CUBE_COORDINATE(sluiceCubeDirection(face, at)), lod - float(regular));
    }
    return sum / float(taps.count);
}

/**
 * Samples with explicit derivatives of `direction` per pixel. Any stage.
 *
 * `missingLevels` is the number of levels by which the sample is too coarse; SLUICE_MIP_UNTOUCHED if it
 * is SLUICE_FALLBACK_COLOR.
 */
vec4 sluiceSampleCubeGrad(SLUICE_CUBE_PARAMETERS, uint tableIndex, vec3 direction, vec3 dx, vec3 dy,
                          float lodBias, float maxAnisotropy, out uint missingLevels)
{
    SluiceCubePoint p = sluiceFindCubePoint(direction, dx, dy);
    SluiceSampling s;
    missingLevels = 0u;
    if (sluiceIsCubeSurelyThere(tableIndex, p, lodBias, maxAnisotropy)) {
        vec2 size = vec2(SLUICE_TEXTURE_ENTRY(tableIndex).sizeX, SLUICE_TEXTURE_ENTRY(tableIndex).sizeY);
        float scale = exp2(sluiceClampLodBias(lodBias));
        s.uv = p.uv;
        s.dx = p.dx * scale;
        s.dy = p.dy * scale;
        s.lod = sluiceComputeLod(p.dx * size, p.dy * size, lodBias, maxAnisotropy);
    } else {
        s = sluiceResolveCube(tableIndex, p, lodBias, maxAnisotropy);
        missingLevels = sluiceMissingLevels(s);
        if (s.level == SLUICE_MIP_UNTOUCHED)
            return SLUICE_FALLBACK_COLOR;
    }
    return sluiceTextureCube(SLUICE_CUBE_ARGUMENTS, tableIndex, p.face, s.uv, s.dx, s.dy, s.lod,
                             maxAnisotropy);
}

#ifdef SLUICE_FRAGMENT_SHADER
/**
 * Samples like sluiceSampleCubeGrad with the fragment's own derivatives. Call in control flow that is
 * uniform over the quad.
 */
vec4 sluiceSampleCube(SLUICE_CUBE_PARAMETERS, uint tableIndex, vec3 direction, float lodBias,
                      float maxAnisotropy, out uint missingLevels)
{
    return sluiceSampleCubeGrad(SLUICE_CUBE_ARGUMENTS, tableIndex, direction, dFdx(direction),
                                dFdy(direction), lodBias, maxAnisotropy, missingLevels);
}
#endif

#undef SLUICE_CUBE_PARAMETERS
#undef SLUICE_CUBE_ARGUMENTS
#undef SLUICE_CUBE_SAMPLER
#undef SLUICE_CUBE_STATE
#undef SLUICE_CUBE_COORDINATE
