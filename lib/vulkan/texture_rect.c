#include "vulkan/texture_rect.h"

#include "base/checked.h"
#include "base/log.h"

#include <assert.h>

SluiceResult slc_streamer_find(const SluiceVulkanStreamer *s, SluiceTextureId id,
                               struct slc_texture **texture)
{
    /* The manager validates ids. */
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    SluiceResult result = sluiceGetTextureLayout(s->manager, id, &layout);
    if (result != SLUICE_SUCCESS)
        return result;
    *texture = &s->textures[s->by_manager_index[(uint32_t)id]];
    assert((*texture)->id == id && (*texture)->state == SLC_TEXTURE_LIVE);
    return SLUICE_SUCCESS;
}

SluiceResult slc_streamer_find_primary(const SluiceVulkanStreamer *s, SluiceTextureId id,
                                       struct slc_texture **texture)
{
    SluiceResult result = slc_streamer_find(s, id, texture);
    if (result != SLUICE_SUCCESS || (*texture)->primary_id == SLUICE_NO_TEXTURE)
        return result;
    return slc_log_refusal(&s->vk.log,
                           "%s: follows another texture; call the function for its primary",
                           (*texture)->info.pName ? (*texture)->info.pName : "image");
}

static bool is_inside(uint32_t first, uint32_t count, uint32_t size)
{
    return count > 0 && first < size && count <= size - first;
}

/* Finds the cells of a range of texels. The last cell has the rest if cells do not divide the size.
 */
static void range(uint32_t first, uint32_t count, uint32_t cell, uint32_t cells, uint32_t *begin,
                  uint32_t *end)
{
    *begin = slc_min_u32(first / cell, cells - 1);
    *end = slc_min_u32((first + count - 1) / cell, cells - 1) + 1;
}

SluiceResult slc_texture_rect_cells(const SluiceVulkanStreamer *s,
                                    const struct slc_texture *texture,
                                    const SluiceTextureRect *rect, const struct slc_cells *cells,
                                    struct slc_tile_rect *out)
{
    const SluiceStreamedTextureDesc *desc = &texture->layout.desc;
    SluiceTextureRect r = rect ? *rect : (SluiceTextureRect){0};
    if (!r.x && !r.y && !r.width && !r.height)
        r = (SluiceTextureRect){0, 0, desc->width, desc->height};
    if (!is_inside(r.x, r.width, desc->width) || !is_inside(r.y, r.height, desc->height))
        return slc_log_refusal(
            &s->vk.log, "%s: the rectangle at %u, %u of %u x %u texels is not inside of %u x %u",
            texture->info.pName ? texture->info.pName : "image", r.x, r.y, r.width, r.height,
            desc->width, desc->height);
    range(r.x, r.width, cells->cell_width, cells->columns, &out->x0, &out->x1);
    range(r.y, r.height, cells->cell_height, cells->rows, &out->y0, &out->y1);
    return SLUICE_SUCCESS;
}
