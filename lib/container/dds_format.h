/** Formats of DDS headers. */
#ifndef SLC_CONTAINER_DDS_FORMAT_H
#define SLC_CONTAINER_DDS_FORMAT_H

#include "container/container_layout.h"

/** DDS_PIXELFORMAT without its size. */
struct slc_dds_pixel_format {
    uint32_t flags, four_cc, bit_count, masks[4]; ///< R, G, B, A
};

/** Returns the format, or UNDEFINED if unsupported. `*changes`: flags of enum slc_texel_change. */
SluiceFormat slc_dds_format(const struct slc_dds_pixel_format *format, unsigned *changes);

/** Returns the format of a DXGI_FORMAT number, or UNDEFINED. `*changes`: see slc_dds_format. */
SluiceFormat slc_dxgi_format(uint32_t number, unsigned *changes);

#endif /* SLC_CONTAINER_DDS_FORMAT_H */
