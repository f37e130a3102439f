/** Tiles of a texture, level by level. */
#ifndef SLC_CORE_LAYOUT_H
#define SLC_CORE_LAYOUT_H

#include "core/state.h"

SluiceResult slc_layout_texture(const SluiceStreamedTextureDesc *desc, struct slc_shape *s);
/** Errors, logged: SLUICE_ERROR_INVALID_ARGUMENT for the structSize of `out`. `log` may be NULL. */
SluiceResult slc_write_layout(const struct slc_shape *s, const SluiceLogCallback *log,
                              SluiceStreamedTextureLayout *out);
/** Returns the place of a tile. Its level is regularMipCount for packed tiles. */
struct slc_place slc_tile_place(const struct slc_managed_texture *t, uint32_t tile);

#endif /* SLC_CORE_LAYOUT_H */
