/** Decodes ASTC with astcenc. */
#ifndef TESTS_ASTC_BACK_H
#define TESTS_ASTC_BACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Blocks of `extent` x `extent` texels, LDR, not sRGB, to [height][width] RGBA bytes. */
bool astc_back(uint32_t extent, const uint8_t *blocks, size_t size, uint32_t width, uint32_t height,
               uint8_t *rgba);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif
