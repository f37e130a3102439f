/**
 * Latents of a neural set in pages, for shaders that decode where they sample and load what they
 * miss: a page is a rectangle of the mips that share latent images. Link `sluice-neural`.
 *
 * Pages are byte pages of a demand loader (docs/byte-pages.md). neural_pages.glsl samples them.
 */
#ifndef SLUICE_NEURAL_PAGES_H
#define SLUICE_NEURAL_PAGES_H

#include <sluice/neural.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Mips that share latent images, cut into pages. 32 bytes. */
typedef struct SluiceNeuralPageGroup {
    uint32_t firstMip;
    uint32_t mipCount;
    uint32_t firstPage;             ///< Of the set's pages.
    uint32_t columns, rows;         ///< Pages.
    uint32_t pageWidth, pageHeight; ///< Texels of firstMip. Multiples of 2^(mipCount - 1), or all.
    uint32_t reserved;              ///< 0.
} SluiceNeuralPageGroup;

/**
 * Where texels lie in pages. 288 bytes of 32-bit scalars and arrays of them: the layout of the GLSL
 * struct of this name in std430 and in scalar blocks. Never grows.
 */
typedef struct SluiceNeuralPages {
    uint32_t width, height; ///< Texels of mip 0.
    uint32_t mipCount;
    uint32_t channelCount;
    uint32_t groupCount; ///< 1 to 8. The last group is the coarsest.
    uint32_t pageCount;
    uint32_t pageSize; ///< Bytes of each page: constants (SluiceNeuralConstants), then latents.
    uint32_t reserved; ///< 0.
    SluiceNeuralPageGroup groups[SLUICE_NEURAL_MAX_LATENT_IMAGES];
} SluiceNeuralPages;

/**
 * Cuts a set into pages of at most `maxPageSize` bytes, about as large as that. The mips that share
 * latent images share pages.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_LIMIT_EXCEEDED if pages of `maxPageSize` bytes
 *         hold less than 8 x 8 texels of the first mip of a group, or a group has more than 2^20
 *         pages.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceLayOutNeuralPages(const SluiceNeuralSet *set, uint32_t maxPageSize,
                                                SluiceNeuralPages *pPages);

/**
 * Reads a page: pageSize bytes, each written once and in order. Bytes behind the latents are 0.
 *
 * Returns and errors: as sluiceReadNeuralLatents; SLUICE_ERROR_INVALID_ARGUMENT if `page` is not
 * below pageCount, or `pPages` is not of this set.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceReadNeuralPage(const SluiceNeuralSet *set,
                                             const SluiceNeuralPages *pPages, uint32_t page,
                                             void *pBytes);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_NEURAL_PAGES_H */
