#include "vulkan/packed_units.h"

#include "base/alloc.h"
#include "base/checked.h"

/* Walks over all rectangles in order; with NULL arrays it only counts. */
struct cutter {
    struct slc_packed_units *out;
    uint32_t slot_size, texel_size;
    uint32_t used; ///< bytes of the current slot
};

static void add_rect(struct cutter *c, const SluiceImageRegion *region)
{
    struct slc_packed_units *out = c->out;
    uint32_t size = region->width * region->height * c->texel_size;
    uint32_t offset = (c->used + SLC_STAGING_ALIGNMENT - 1) & ~(SLC_STAGING_ALIGNMENT - 1);
    bool new_unit = out->unit_count == 0 || offset + size > c->slot_size;
    if (new_unit) {
        offset = 0;
        if (out->units)
            out->units[out->unit_count] = (struct slc_packed_unit){out->rect_count, 0};
        out->unit_count++;
    }
    if (out->units)
        out->units[out->unit_count - 1].rect_count++;
    if (out->rects)
        out->rects[out->rect_count] = (struct slc_packed_rect){*region, offset};
    out->rect_count++;
    c->used = offset + size;
}

static void cut_level(struct cutter *c, const SluiceStreamedTextureDesc *desc, uint32_t level)
{
    uint32_t width = slc_mip_size(desc->width, level), height = slc_mip_size(desc->height, level);
    uint32_t piece_width = slc_min_u32(width, c->slot_size / c->texel_size);
    uint32_t piece_height = slc_min_u32(height, c->slot_size / (piece_width * c->texel_size));
    for (uint32_t y = 0; y < height; y += piece_height)
        for (uint32_t x = 0; x < width; x += piece_width) {
            SluiceImageRegion region = {level, x, y, slc_min_u32(piece_width, width - x),
                                        slc_min_u32(piece_height, height - y)};
            add_rect(c, &region);
        }
}

static void cut(struct slc_packed_units *packed, const SluiceStreamedTextureDesc *desc,
                uint32_t texel_size, uint32_t slot_size)
{
    struct cutter c = {.out = packed, .slot_size = slot_size, .texel_size = texel_size};
    packed->rect_count = packed->unit_count = 0;
    for (uint32_t level = desc->regularMipCount; level < desc->mipLevelCount; level++)
        cut_level(&c, desc, level);
}

SluiceResult slc_packed_units_init(struct slc_packed_units *packed,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceStreamedTextureDesc *desc, uint32_t texel_size,
                                   uint32_t slot_size)
{
    *packed = (struct slc_packed_units){0};
    cut(packed, desc, texel_size, slot_size);
    if (packed->unit_count == 0)
        return SLUICE_SUCCESS;
    packed->rects = slc_alloc(cb, packed->rect_count, sizeof *packed->rects);
    packed->units = slc_alloc(cb, packed->unit_count, sizeof *packed->units);
    if (!packed->rects || !packed->units) {
        slc_packed_units_finish(packed, cb);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    cut(packed, desc, texel_size, slot_size);
    return SLUICE_SUCCESS;
}

void slc_packed_units_finish(struct slc_packed_units *packed, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, packed->rects, packed->rect_count, sizeof *packed->rects);
    slc_free(cb, packed->units, packed->unit_count, sizeof *packed->units);
    *packed = (struct slc_packed_units){0};
}
