#include "vulkan/packed_units.h"

#include "base/alloc.h"
#include "image/format_size.h"

/* Walks over all rectangles in order; with NULL arrays it only counts. */
struct cutter {
    struct slc_packed_units *out;
    const SluiceFormatInfo *format;
    uint32_t slot_size;
    uint32_t used; ///< bytes of the current slot
};

static void add_rect(struct cutter *c, const SluiceImageRegion *region)
{
    struct slc_packed_units *out = c->out;
    uint32_t size = (uint32_t)slc_format_row_size(c->format, region->width) *
                    slc_format_row_count(c->format, region->height);
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
    const SluiceFormatInfo *format = c->format;
    uint32_t row_blocks =
        slc_min_u32(slc_div_up_u32(width, format->blockWidth), c->slot_size / format->blockSize);
    uint32_t piece_width = row_blocks * format->blockWidth;
    uint32_t piece_height = c->slot_size / (row_blocks * format->blockSize) * format->blockHeight;
    for (uint32_t y = 0; y < height; y += piece_height)
        for (uint32_t x = 0; x < width; x += piece_width) {
            SluiceImageRegion region = {level, x, y, slc_min_u32(piece_width, width - x),
                                        slc_min_u32(piece_height, height - y)};
            add_rect(c, &region);
        }
}

static void cut(struct slc_packed_units *packed, const SluiceStreamedTextureDesc *desc,
                const SluiceFormatInfo *format, uint32_t slot_size)
{
    struct cutter c = {.out = packed, .slot_size = slot_size, .format = format};
    packed->rect_count = packed->unit_count = 0;
    for (uint32_t level = desc->regularMipCount; level < desc->mipLevelCount; level++)
        cut_level(&c, desc, level);
}

SluiceResult slc_packed_units_init(struct slc_packed_units *packed,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceStreamedTextureDesc *desc,
                                   const SluiceFormatInfo *format, uint32_t slot_size)
{
    *packed = (struct slc_packed_units){0};
    cut(packed, desc, format, slot_size);
    if (packed->unit_count == 0)
        return SLUICE_SUCCESS;
    packed->rects = slc_alloc(cb, packed->rect_count, sizeof *packed->rects);
    packed->units = slc_alloc(cb, packed->unit_count, sizeof *packed->units);
    packed->unit_room = packed->unit_count;
    if (!packed->rects || !packed->units) {
        slc_packed_units_finish(packed, cb);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    cut(packed, desc, format, slot_size);
    return SLUICE_SUCCESS;
}

void slc_packed_units_join(struct slc_packed_units *packed)
{
    if (packed->unit_count == 0)
        return;
    packed->units[0] = (struct slc_packed_unit){0, packed->rect_count};
    packed->unit_count = 1;
}

void slc_packed_units_finish(struct slc_packed_units *packed, const SluiceAllocationCallbacks *cb)
{
    slc_free(cb, packed->rects, packed->rect_count, sizeof *packed->rects);
    slc_free(cb, packed->units, packed->unit_room, sizeof *packed->units);
    *packed = (struct slc_packed_units){0};
}
