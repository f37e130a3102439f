/* Place that each pixel samples, in a texture of params.textureSize texels. */
#include "bench.glsl"

vec2 textureSizeInTexels()
{
    return vec2(params.textureSize[0], params.textureSize[1]);
}

struct Place {
    vec2 uv, dx, dy; /* derivatives per pixel */
};

/* Seen from as high as half the screen is wide: level 0 in front, the last one at the horizon. */
Place floorPlace(vec2 pixel)
{
    float distance = 0.5 * float(params.height) / pixel.y; /* 1 in the middle of the screen */
    float side = pixel.x - 0.5 * float(params.width);
    float focal = 0.5 * float(params.width);
    Place p;
    p.uv = vec2(side, focal) * distance;
    p.dx = vec2(distance, 0.0);
    p.dy = -vec2(side, focal) * distance / pixel.y;
    return p;
}

/* Magnified: 710 texels, less than 6 regions of 128, fill the screen. */
Place closePlace(vec2 pixel)
{
    vec2 texels = 710.0 / vec2(params.width, params.height);
    return Place(60.0 + pixel * texels, vec2(texels.x, 0.0), vec2(0.0, texels.y));
}

Place noisePlace(vec2 pixel)
{
    uvec2 at = uvec2(pixel);
    uint h = sluiceHash(uvec3(at >> 2u, 7u));
    vec2 corner = vec2(h & 0xFFFFu, h >> 16u) / 65536.0;
    return Place(floor(corner * textureSizeInTexels()) + vec2(at & 3u) + 0.25, vec2(1.0, 0.0),
                 vec2(0.0, 1.0));
}

Place scenePlace(vec2 pixel)
{
    vec2 size = textureSizeInTexels();
    Place p = scene == BENCH_SCENE_FLOOR      ? floorPlace(pixel)
              : scene == BENCH_SCENE_CLOSE_UP ? closePlace(pixel)
                                              : noisePlace(pixel);
    p.uv /= size;
    p.dx /= size;
    p.dy /= size;
    return p;
}

bool isSelected(uvec2 pixel)
{
    if (feedbackKind == BENCH_FEEDBACK_ALL)
        return true;
    if (feedbackKind == BENCH_FEEDBACK_BLOCKS)
        return sluiceSelectBlock(pixel, params.seed);
#ifdef GL_FRAGMENT_SHADER
    return feedbackKind == BENCH_FEEDBACK_LATTICE
               ? sluiceSelectFragmentLattice(gl_FragCoord.xy, params.seed)
               : sluiceSelectRandomFragmentQuad(gl_FragCoord.xy, params.seed, params.probability);
#else
    return feedbackKind == BENCH_FEEDBACK_LATTICE
               ? sluiceSelectLattice(pixel, params.seed)
               : sluiceSelectRandomQuad(pixel, params.seed, params.probability);
#endif
}

/* `pixel`: bits 0 to 22 count */
void writeSceneFeedback(uvec2 pixel, Place p)
{
    if (feedbackKind == BENCH_FEEDBACK_NONE)
        return;
#ifdef GL_FRAGMENT_SHADER
    bool lattice = feedbackKind == BENCH_FEEDBACK_LATTICE;
    if (lattice) { /* pixels of a quad do not decide alike */
        p.dx = dFdx(p.uv);
        p.dy = dFdy(p.uv);
    }
#endif
    if (!isSelected(pixel))
        return;
#ifdef GL_FRAGMENT_SHADER
    if (!lattice) {
        p.dx = dFdx(p.uv);
        p.dy = dFdy(p.uv);
    }
#endif
    bool blocks = feedbackKind == BENCH_FEEDBACK_BLOCKS;
    if (blocks || feedbackKind == BENCH_FEEDBACK_QUADS)
        sluiceWriteQuadFeedback(params.tableIndex, p.uv, p.dx, p.dy, 0.0, anisotropy, pixel,
                                blocks ? params.seed >> 4u : params.seed);
    else
        sluiceWriteFeedback(params.tableIndex, p.uv, p.dx, p.dy, 0.0, anisotropy);
}
