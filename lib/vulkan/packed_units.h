/**
 * Packed levels of a texture, cut into rectangles that fit into staging slots.
 *
 * A unit fits into one staging slot and is filled by one read. It has several small levels, or a
 * part of a large one.
 */
#ifndef SLC_VULKAN_PACKED_UNITS_H
#define SLC_VULKAN_PACKED_UNITS_H

#include <sluice/loader.h>
#include <sluice/manager.h>

/** Alignment of rectangles in their slot, in bytes: a multiple of every block size and of 4. */
#define SLC_STAGING_ALIGNMENT 16u

struct slc_packed_rect {
    SluiceImageRegion region;
    uint32_t offset; ///< bytes from the start of the slot
};

struct slc_packed_unit {
    uint32_t first_rect, rect_count;
};

struct slc_packed_units {
    struct slc_packed_rect *rects; ///< owned
    struct slc_packed_unit *units; ///< owned
    uint32_t rect_count, unit_count;
    uint32_t unit_room; ///< units that were allocated
};

/** Cuts the levels [regularMipCount, mipLevelCount). Rectangles are whole blocks of `format`. */
SluiceResult slc_packed_units_init(struct slc_packed_units *packed,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceStreamedTextureDesc *desc,
                                   const SluiceFormatInfo *format, uint32_t slot_size);
/** Merges all units into one. For producers, which read nothing into staging slots. */
void slc_packed_units_join(struct slc_packed_units *packed);
void slc_packed_units_finish(struct slc_packed_units *packed, const SluiceAllocationCallbacks *cb);

#endif /* SLC_VULKAN_PACKED_UNITS_H */
