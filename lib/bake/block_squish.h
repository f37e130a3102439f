/** The part of libsquish, a C++ library, that the baker uses. */
#ifndef SLC_BAKE_BLOCK_SQUISH_H
#define SLC_BAKE_BLOCK_SQUISH_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum slc_block_kind { SLC_BLOCK_BC1, SLC_BLOCK_BC3, SLC_BLOCK_BC4, SLC_BLOCK_BC5 };

/** 16 texels of RGBA bytes to one block; texels whose bit is 0 in `mask` do not count. */
void slc_squish_block(enum slc_block_kind kind, const uint8_t rgba[64], uint32_t mask, void *block);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLC_BAKE_BLOCK_SQUISH_H */
