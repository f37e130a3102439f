/*
 * The level of detail that a sampler will choose, computed from derivatives.
 *
 * Vulkan lets implementations approximate. Without anisotropy those measured pick a level up to 0.12
 * finer than the formula. With it some take the two derivatives' lengths and others the axes of the
 * ellipse that they span, which differ by a level and more where the derivatives are not at right
 * angles; the ellipse's are used here because they never give the coarser level. Whoever must not
 * miss a level subtracts sluiceLodMargin. C twin: lib/vulkan/shader_twins.h, figures: docs/drivers.md.
 */
#ifndef SLUICE_LOD_GLSL
#define SLUICE_LOD_GLSL

/* Ends of the range in which everything is computed; beyond them there are no levels. */
#define SLUICE_LOD_LIMIT 32.0

/** The anisotropy that counts: 1 to 16, 1 for NaN. */
float sluiceClampAnisotropy(float maxAnisotropy)
{
    return maxAnisotropy > 1.0 ? min(maxAnisotropy, 16.0) : 1.0;
}

/** The LOD bias that counts: -32 to 32, -32 for NaN. */
float sluiceClampLodBias(float lodBias)
{
    return lodBias >= -SLUICE_LOD_LIMIT ? min(lodBias, SLUICE_LOD_LIMIT) : -SLUICE_LOD_LIMIT;
}

/** How far the sampler's level may lie below the computed one. */
float sluiceLodMargin(float maxAnisotropy)
{
    return maxAnisotropy > 1.0 ? 0.1875 : 0.125;
}

/** Squares of the longer and the shorter axis of the ellipse that two derivatives below 2^30 span. */
vec2 sluiceEllipseAxes2(vec2 dx, vec2 dy)
{
    float x2 = dx.x * dx.x + dx.y * dx.y;
    float y2 = dy.x * dy.x + dy.y * dy.y;
    float along = dx.x * dy.x + dx.y * dy.y;
    float across = dx.x * dy.y - dx.y * dy.x;
    float half2 = 0.5 * (x2 - y2);
    float major2 = 0.5 * (x2 + y2) + sqrt(half2 * half2 + along * along);
    return vec2(major2, major2 > 0.0 ? across / major2 * across : 0.0);
}

/**
 * `dx` and `dy` in texels of level 0 per pixel. The result is finite, -32 to 32, whatever the
 * arguments: no derivative gives -32, an infinite one or NaN gives 32.
 */
float sluiceComputeLod(vec2 dx, vec2 dy, float lodBias, float maxAnisotropy)
{
    float x2 = dx.x * dx.x + dx.y * dx.y;
    float y2 = dy.x * dy.x + dy.y * dy.y;
    if (!(x2 >= 0.0 && y2 >= 0.0)) /* NaN */
        return SLUICE_LOD_LIMIT;
    float n = sluiceClampAnisotropy(maxAnisotropy);
    float minor2 = max(x2, y2);
    if (n > 1.0) {
        if (minor2 >= 1.0e18) /* squares of it would overflow, and no texture is so large */
            return SLUICE_LOD_LIMIT;
        vec2 axes2 = sluiceEllipseAxes2(dx, dy);
        minor2 = max(axes2.y, axes2.x / (n * n));
    }
    float lod = 0.5 * log2(clamp(minor2, 5.4e-20, 1.8e19)); /* 2^-64 to 2^64 */
    lod += sluiceClampLodBias(lodBias);
    if (!(lod >= -SLUICE_LOD_LIMIT))
        return -SLUICE_LOD_LIMIT;
    return min(lod, SLUICE_LOD_LIMIT);
}

/** The finest level of `count` that a sampler may touch at this LOD. */
uint sluiceFinestLevel(float lod, float margin, uint count)
{
    return uint(clamp(lod - margin, 0.0, float(count - 1u)));
}

/** The coarsest level of `count` that a sampler may touch at this LOD. */
uint sluiceCoarsestLevel(float lod, uint count)
{
    return min(uint(clamp(lod, 0.0, float(count - 1u))) + 1u, count - 1u);
}

#endif
