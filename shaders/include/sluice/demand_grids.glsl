/*
 * Samples grids of textures that are loaded on demand (sluiceAddDemandGrid): the layers of an array.
 *
 *     bool resident;
 *     vec4 color = sluiceDemandLayerGrad(index, layer, uv, dx, dy, resident);
 *
 * `index` is that of a grid of layerCount x 1 textures; add one texture per layer
 * (SluiceDemandImage.arrayLayer). The layer may differ between invocations. Layers beyond the last
 * are the last one, as in Vulkan. Samplers and special cases are those of the layer's texture
 * (demand.glsl). An empty cell returns the grid's missingColor, resident. A texture that is no grid is
 * an array of one layer.
 *
 * Include it after the definitions of demand.glsl, which it includes.
 */
#ifndef SLUICE_DEMAND_GRIDS_GLSL
#define SLUICE_DEMAND_GRIDS_GLSL

#include "demand.glsl"

/** Replaces the index of a grid by that of a layer's texture. False if there is none. */
bool sluiceFindDemandLayer(inout uint index, uint layer)
{
    if (SLUICE_DEMAND_TEXTURE(index).state != SLUICE_DEMAND_TEXTURE_GRID)
        return true;
    uint count = SLUICE_DEMAND_TEXTURE(index).width * SLUICE_DEMAND_TEXTURE(index).height;
    uint member =
        SLUICE_DEMAND_LEVEL_WORD(SLUICE_DEMAND_TEXTURE(index).levels + min(layer, count - 1u));
    if (member == SLUICE_DEMAND_NO_TEXTURE)
        return false;
    index = member;
    return true;
}

/** Samples a layer with derivatives of `uv` per pixel, like sluiceDemandGrad. */
vec4 sluiceDemandLayerGrad(uint index, uint layer, vec2 uv, vec2 dx, vec2 dy, out bool resident)
{
    resident = true;
    if (!sluiceFindDemandLayer(index, layer))
        return sluiceDemandBaseColor(index);
    return sluiceDemandGrad(index, uv, dx, dy, resident);
}

/** Samples a layer at `lod` plus both LOD biases, like sluiceDemandLod. */
vec4 sluiceDemandLayerLod(uint index, uint layer, vec2 uv, float lod, out bool resident)
{
    resident = true;
    if (!sluiceFindDemandLayer(index, layer))
        return sluiceDemandBaseColor(index);
    return sluiceDemandLod(index, uv, lod, resident);
}

#endif
