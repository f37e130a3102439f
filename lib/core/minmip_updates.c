/* MinMip maps as the application reads them: texels, and rectangles that changed. */
#include "base/checked.h"
#include "core/lookup.h"
#include "core/minmip.h"
#include "core/observer.h"
#include "core/refusal.h"

#include <inttypes.h>
#include <string.h>

static void copy_rect(const struct slc_managed_texture *t, const SluiceMinMipRect *r,
                      size_t row_pitch, uint8_t *out)
{
    if (t->nodes && r->width == t->shape->min_mip_width && row_pitch == r->width) {
        const uint8_t *rows = t->min_mip + (size_t)r->y * r->width;
        memcpy(out, rows, (size_t)r->width * r->height);
        return;
    }
    for (uint32_t y = 0; y < r->height; y++) {
        uint8_t *row = out + y * row_pitch;
        if (t->nodes)
            memcpy(row, t->min_mip + (size_t)(r->y + y) * t->shape->min_mip_width + r->x, r->width);
        else
            memset(row, slc_min_mip_floor(t), r->width);
    }
}

/** Writes a rectangle that is inside the map. Checks the size of the target. */
static SluiceResult write_rect(const struct slc_managed_texture *t, const SluiceMinMipRect *r,
                               size_t row_pitch, size_t size, uint8_t *out)
{
    size_t rows, needed;
    if (row_pitch < r->width || !slc_mul_size(r->height - 1, row_pitch, &rows) ||
        !slc_add_size(rows, r->width, &needed) || size < needed)
        return SLUICE_ERROR_SIZE_MISMATCH;
    copy_rect(t, r, row_pitch, out);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceWriteMinMipRect(const SluiceStreamedTextureManager *manager,
                                   const SluiceMinMipRect *pRect, size_t rowPitch, size_t size,
                                   uint8_t *pMinMip)
{
    if (!manager || !pRect || !pMinMip)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_managed_texture *t;
    SluiceResult result = slc_find_texture(manager, pRect->textureId, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t width = t->shape->min_mip_width, height = t->shape->min_mip_height;
    if (pRect->width == 0 || pRect->height == 0 || pRect->x >= width || pRect->y >= height ||
        pRect->width > width - pRect->x || pRect->height > height - pRect->y)
        return slc_refuse(manager, __func__,
                          "rectangle %" PRIu32 "x%" PRIu32 " at %" PRIu32 ", %" PRIu32
                          " is empty or leaves the map of %" PRIu32 "x%" PRIu32,
                          pRect->width, pRect->height, pRect->x, pRect->y, width, height);
    return write_rect(t, pRect, rowPitch, size, pMinMip);
}

SluiceResult sluiceWriteMinMipData(const SluiceStreamedTextureManager *manager,
                                   SluiceTextureId textureId, size_t rowPitch, size_t size,
                                   uint8_t *pMinMip)
{
    if (!manager || !pMinMip)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_managed_texture *t;
    SluiceResult result = slc_find_texture(manager, textureId, &t);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceMinMipRect whole = {.width = t->shape->min_mip_width, .height = t->shape->min_mip_height};
    return write_rect(t, &whole, rowPitch, size, pMinMip);
}

static SluiceResult get_updates(slc_manager *m, uint32_t *count, SluiceMinMipRect *rects)
{
    uint32_t room = *count, written = 0;
    if (!rects) {
        *count = m->dirty_count;
        return SLUICE_SUCCESS;
    }
    while (m->dirty_first != SLC_NONE && written < room) {
        struct slc_managed_texture *t = slc_texture_at(m, m->dirty_first);
        rects[written++] = (SluiceMinMipRect){slc_texture_id(t), t->dirty_x0, t->dirty_y0,
                                              t->dirty_x1 - t->dirty_x0, t->dirty_y1 - t->dirty_y0};
        slc_min_mip_drop_update(m, t);
    }
    *count = written;
    return m->dirty_count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

SluiceResult sluiceGetMinMipUpdates(SluiceStreamedTextureManager *manager, uint32_t *pRectCount,
                                    SluiceMinMipRect *pRects)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_GET_MINMIP_UPDATES, .query = !pRects, .rects = pRects};
    if (!pRectCount) {
        call.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        call.room = *pRectCount;
        call.result = get_updates(manager, pRectCount, pRects);
        call.count = *pRectCount;
    }
    slc_notify(manager, &call);
    return call.result;
}
