#include "vulkan/texture_state.h"

#include "base/struct_size.h"
#include "vulkan/load_reloads.h"

/* Coarsest texels of a rectangle. */
struct coarsest {
    uint8_t level;
    uint16_t texel;
};

static struct coarsest find_coarsest(const SluiceVulkanStreamer *s,
                                     const struct slc_texture *texture,
                                     const struct slc_tile_rect *rect)
{
    struct coarsest c = {0};
    for (uint32_t y = rect->y0; y < rect->y1; y++)
        for (uint32_t x = rect->x0; x < rect->x1; x++) {
            uint32_t at = texture->region_first + y * texture->layout.minMipWidth + x;
            c.level = s->min_mip_levels[at] > c.level ? s->min_mip_levels[at] : c.level;
            c.texel = s->min_mip_texels[at] > c.texel ? s->min_mip_texels[at] : c.texel;
        }
    return c;
}

static float shown_level(uint16_t texel)
{
    float steps = texel > SLUICE_SHOWN_MARGIN ? (float)(texel - SLUICE_SHOWN_MARGIN) : 0.0f;
    return steps / SLUICE_SHOWN_STEPS;
}

SluiceVulkanTextureState slc_texture_state(const SluiceVulkanStreamer *s,
                                           const struct slc_texture *texture,
                                           const struct slc_tile_rect *rect)
{
    struct coarsest c = {.level = SLUICE_MIP_UNTOUCHED};
    if (texture->shown_frame && texture->presence == SLC_PRESENT)
        c = find_coarsest(s, texture, rect);
    bool drawable = c.level != SLUICE_MIP_UNTOUCHED;
    return (SluiceVulkanTextureState){
        .structSize = sizeof(SluiceVulkanTextureState),
        .drawable = drawable,
        .residentLevel = c.level,
        .reloadingTileCount = slc_reload_count(s, (uint32_t)(texture - s->textures)),
        .shownLevel = drawable ? shown_level(c.texel) : (float)SLUICE_MIP_UNTOUCHED};
}

SluiceResult sluiceGetVulkanTextureState(const SluiceVulkanStreamer *streamer,
                                         SluiceTextureId textureId, const SluiceTextureRect *pRect,
                                         SluiceVulkanTextureState *pState)
{
    const SluiceVulkanStreamer *s = streamer;
    if (!s || !pState)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_texture *texture;
    struct slc_tile_rect rect;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluiceVulkanTextureState), pState, &s->vk.log);
    if (result == SLUICE_SUCCESS)
        result = slc_streamer_find(s, textureId, &texture);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_cells cells = slc_min_mip_cells(&texture->layout);
    result = slc_texture_rect_cells(s, texture, pRect, &cells, &rect);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceVulkanTextureState state = slc_texture_state(s, texture, &rect);
    slc_struct_write(SLC_STRUCT(SluiceVulkanTextureState), pState, &state);
    return SLUICE_SUCCESS;
}
