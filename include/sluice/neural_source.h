/**
 * A texture of a neural set as an image source: tiles are decoded on the host when they are read.
 * So neural sets stream like files of texels, to every front end and format of images. Link
 * `sluice-neural`.
 *
 * vulkan_neural.h decodes on the GPU, and neural_pages.h where a shader samples.
 */
#ifndef SLUICE_NEURAL_SOURCE_H
#define SLUICE_NEURAL_SOURCE_H

#include <sluice/image.h>
#include <sluice/neural.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Settings of a source. A field of zero selects its default. */
typedef struct SluiceNeuralImageSourceCreateInfo {
    uint32_t structSize;        ///< sizeof(SluiceNeuralImageSourceCreateInfo).
    const SluiceNeuralSet *set; ///< Required, unless ownedSet. Must outlive the source.
    /** A set that the source destroys with itself. Also destroyed if creation fails, unless pInfo
     * is NULL or its structSize is wrong. Excludes `set`. */
    SluiceNeuralSet *ownedSet;
    uint32_t textureIndex; ///< Below the set's textureCount.
    /** SLUICE_NEURAL_WEIGHTS_INT8 gives the same texels on every machine. */
    SluiceNeuralWeightKind weights;
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log;
} SluiceNeuralImageSourceCreateInfo;

/**
 * Creates a source. Destroy it with sluiceDestroyImageSource.
 *
 * Texels are in the texture's color spaces. The format follows from the file:
 * - channels of 16-bit or 32-bit floats, or HLG colors: R16, R16G16 or R16G16B16A16 SFLOAT, linear;
 * - UNORM16: R16, R16G16 or R16G16B16A16 UNORM;
 * - else R8, R8G8 or R8G8B8A8 UNORM; sRGB colors are R8G8B8A8_SRGB.
 * Three channels get an alpha of 1.
 *
 * A read takes the latents of its region from the file, and memory for them and for a row of
 * floats. It takes about 8 000 multiplications per texel.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a
 *         texture that does not exist, both sets or a wrong structSize; SLUICE_ERROR_UNSUPPORTED if
 *         the file lacks weights of this kind; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Reads return what sluiceReadNeuralLatents does.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceCreateNeuralImageSource(
    const SluiceNeuralImageSourceCreateInfo *pInfo, SluiceImageSource **pSource);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_NEURAL_SOURCE_H */
