/**
 * Streamed textures whose tiles the GPU decodes from a neural set (neural.h) when feedback or rays
 * ask for them: inference on feedback. Part of `sluice-vulkan`.
 *
 * Latents and weights of the set are in GPU memory: 2 to 10 bits per texel for all channels.
 * Textures of the set are ordinary textures with a producer. They are drawn, filtered, budgeted and
 * evicted like others. Only requested tiles are decoded.
 */
#ifndef SLUICE_VULKAN_NEURAL_H
#define SLUICE_VULKAN_NEURAL_H

#include <sluice/neural.h>
#include <sluice/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A neural set in GPU memory, and the pipelines that decode it. */
typedef struct SluiceVulkanNeuralDecoder SluiceVulkanNeuralDecoder;

/** Settings of a decoder. A field of zero selects its default. */
typedef struct SluiceVulkanNeuralDecoderCreateInfo {
    uint32_t structSize;          ///< sizeof(SluiceVulkanNeuralDecoderCreateInfo).
    SluiceVulkanContext *context; ///< Required. Must outlive the decoder.
    /** Required, of all mips. Copied, as all that follows. */
    const SluiceNeuralConstants *pConstants;
    const void *pLatents; ///< Required. The latents that the constants describe.
    uint64_t latentSize;  ///< Bytes, a multiple of 4, above 0 and below 2^32.
    const void *pWeights; ///< Required. Weights of SLUICE_NEURAL_WEIGHTS_INT8.
    uint64_t weightSize;  ///< Bytes.
    uint64_t scratchSize; ///< Bytes of a buffer for tiles: 64 KiB to 256 MiB. Default: 4 MiB.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
} SluiceVulkanNeuralDecoderCreateInfo;

/**
 * Creates a decoder. `*pDecoder` belongs to the caller, who destroys it with
 * sluiceDestroyVulkanNeuralDecoder. Its buffers count as memory of the context.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for
 *         constants that do not fit latents and weights, a size out of range, or mips that are
 *         missing; SLUICE_ERROR_LIMIT_EXCEEDED, with a log message, if latents or scratch are above
 *         the device's maxStorageBufferRange;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY, SLUICE_ERROR_OUT_OF_DEVICE_MEMORY, SLUICE_ERROR_VULKAN.
 * Thread safety: external on the context.
 */
SLUICE_API SluiceResult sluiceCreateVulkanNeuralDecoder(
    const SluiceVulkanNeuralDecoderCreateInfo *pInfo, SluiceVulkanNeuralDecoder **pDecoder);

/**
 * Destroys a decoder. NULL is allowed. Remove its textures before, and wait until all commands that
 * were recorded for them are complete.
 * Thread safety: external on `decoder`.
 */
SLUICE_API void sluiceDestroyVulkanNeuralDecoder(SluiceVulkanNeuralDecoder *decoder);

/** A texture of a set, and how its texels are stored. */
typedef struct SluiceVulkanNeuralOutput {
    uint32_t structSize; ///< sizeof(SluiceVulkanNeuralOutput).
    const char *pName;   ///< For messages. May be NULL. Must outlive the decoder.
    /** R8G8B8A8, BC1_RGB, BC4, BC5 or BC7, UNORM or SRGB, or R16G16B16A16_SFLOAT. BC1 has three
     *  channels, BC4 one, BC5 two. Blocks are those of encode_blocks.glsl. Values are clamped to
     *  0..1; floats to the largest 16-bit float, 65504. */
    SluiceFormat format;
    uint32_t firstChannel; ///< First channel of the set to store.
    uint32_t channelCount; ///< 1 to 4. Channels that the format has beside them are 0, alpha 1.
    SluiceNeuralColorSpace from[4]; ///< Of the network's channels: sluiceGetNeuralChannel.
    /** Color spaces of the stored values. SRGB formats need SLUICE_NEURAL_COLOR_SRGB for channels
     *  0 to 2. */
    SluiceNeuralColorSpace to[4];
} SluiceVulkanNeuralOutput;

/**
 * Adds a texture. `*ppProducer` is for SluiceVulkanTextureCreateInfo.pProducer or
 * SluiceDemandTextureCreateInfo.pProducer, for any number of textures of one queue. It belongs to
 * the decoder and lives as long.
 *
 * All levels have the set's sizes; there are as many as the set has mips. A tile fails only
 * if it is larger than scratchSize. Nothing is read.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for
 *         channels or color spaces that do not exist, or a wrong structSize;
 *         SLUICE_ERROR_UNSUPPORTED for other formats; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: external on `decoder`. Textures of one decoder must be on one queue.
 */
SLUICE_API SluiceResult sluiceAddVulkanNeuralOutput(SluiceVulkanNeuralDecoder *decoder,
                                                    const SluiceVulkanNeuralOutput *pOutput,
                                                    const SluiceTileProducer **ppProducer);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VULKAN_NEURAL_H */
