/** Blocks back to texels, by libsquish. */
#ifndef TESTS_BAKE_SQUISH_BACK_H
#define TESTS_BAKE_SQUISH_BACK_H

#ifdef __cplusplus
extern "C" {
#endif

/** `kind`: 0 to 3 for BC1, BC3, BC4 and BC5. Writes 16 texels of RGBA bytes. */
void squish_back(int kind, const void *block, unsigned char rgba[64]);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* TESTS_BAKE_SQUISH_BACK_H */
