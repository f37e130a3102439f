/**
 * Compression of neural texture sets on a Vulkan device: trains latents and network together.
 * Part of `sluice-vulkan`. docs/neural.md says how it is done and what it reaches.
 *
 * Create a compressor from a context, record steps into command buffers of yours until
 * sluiceRecordNeuralTraining records none any more, record a readback, and take the result.
 *
 * The result depends on input, settings, seed and device only: the same device makes the same bits
 * however many steps a command buffer has, and whether or not the work was interrupted.
 */
#ifndef SLUICE_NEURAL_COMPRESS_H
#define SLUICE_NEURAL_COMPRESS_H

#include <sluice/vulkan_context.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceNeuralCompressor SluiceNeuralCompressor;

/** Most channels of a set. */
#define SLUICE_NEURAL_COMPRESS_MAX_CHANNELS 16u

/** Meaning of a channel for training. Never grows. */
typedef struct SluiceNeuralTrainingChannel {
    float weight; ///< Of the squared error. 0: 1. At most 1000.
    /** Decoded values are clamped to 0..1: values beyond count as no error where the channel is 0
     * or 1. */
    bool clamped;
    /** An alpha mask, also clamped: is pushed beyond 0 and 1, so that most texels are exact there.
     */
    bool mask;
} SluiceNeuralTrainingChannel;

/** Settings of a compressor. A field of zero selects its default. */
typedef struct SluiceNeuralCompressorCreateInfo {
    uint32_t structSize;                          ///< sizeof(SluiceNeuralCompressorCreateInfo).
    uint32_t width, height;                       ///< Texels of mip 0: 1 to 16384.
    uint32_t mipCount;                            ///< Mips: 1 to all of the chain. Default: all.
    uint32_t channelCount;                        ///< 1 to SLUICE_NEURAL_COMPRESS_MAX_CHANNELS.
    const SluiceNeuralTrainingChannel *pChannels; ///< channelCount of them. Required.
    /**
     * Per mip [height][width][channelCount] floats, row 0 first, in the color space that the
     * network is to output. Read during creation; kept as half precision. Required.
     */
    const float *const *ppMips;
    /** Texels of mip 0 per texel of the finest latent image, in each direction: 1 to 6. Default: 4.
     */
    uint32_t gridSizeScale;
    uint32_t featureCount; ///< Features of a latent texel: 4, 8, 12 or 16. Default: 16.
    uint32_t stepCount;    ///< Steps for the int8 network. Default: 20000.
    uint32_t batchSize;    ///< Samples of a step: a multiple of 32 up to 2^20. Default: 65536.
    uint32_t seed;         ///< Of initial values, sample positions and noise.
    float networkRate;     ///< Learning rate of the network. Default: 0.02.
    float latentRate;      ///< Learning rate of latents of 0..1. Default: 0.1.
    /** State of sluiceGetNeuralCheckpoint to go on from. All other fields must be as they were.
     *  NULL: from the start. */
    const void *pCheckpoint;
    size_t checkpointSize; ///< Bytes.
} SluiceNeuralCompressorCreateInfo;

/**
 * Creates a compressor. Takes about 28 bytes of device memory per feature of each latent texel, and
 * two bytes per channel of each texel.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, also for a mip; SLUICE_ERROR_INVALID_ARGUMENT, with a log
 *         message, for a field outside its range, more than 2^30 latents, or an input that is not
 *         finite; SLUICE_ERROR_LIMIT_EXCEEDED, with a log message, if a buffer is above the
 *         device's maxStorageBufferRange; SLUICE_ERROR_CORRUPT_DATA, with a log message, for a
 * checkpoint that is damaged or of other settings; SLUICE_ERROR_OUT_OF_HOST_MEMORY,
 * SLUICE_ERROR_OUT_OF_DEVICE_MEMORY, SLUICE_ERROR_VULKAN. Thread safety: external on `context`.
 */
SLUICE_API SluiceResult sluiceCreateNeuralCompressor(SluiceVulkanContext *context,
                                                     const SluiceNeuralCompressorCreateInfo *pInfo,
                                                     SluiceNeuralCompressor **pCompressor);

/** Destroys a compressor. None of its commands may be in progress. NULL is allowed. */
SLUICE_API void sluiceDestroyNeuralCompressor(SluiceNeuralCompressor *compressor);

/**
 * Records up to `maxSteps` steps. Submit the command buffer to a queue of the context's family, and
 * wait until it ended before the next call on the compressor.
 *
 * `*pStepCount` becomes the number of recorded steps; 0 if all steps have been recorded, or if
 * maxSteps is 0. At most 1024 steps are recorded at once.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceRecordNeuralTraining(SluiceNeuralCompressor *compressor,
                                                   VkCommandBuffer commandBuffer, uint32_t maxSteps,
                                                   uint32_t *pStepCount);

/** Progress of a training. */
typedef struct SluiceNeuralProgress {
    uint32_t structSize; ///< sizeof(SluiceNeuralProgress).
    uint32_t step;       ///< Steps that have been recorded, of both networks.
    uint32_t stepCount;  ///< Steps in all. The FP8 network follows the int8 network.
    /** Mean squared error over channels and samples of the last recorded commands, without weights.
     *  Samples are of all mips. 0 before the first. */
    double meanSquaredError;
    /** Mean squared error of each channel. */
    double channelErrors[SLUICE_NEURAL_COMPRESS_MAX_CHANNELS];
} SluiceNeuralProgress;

/**
 * Gets the progress, after the recorded commands ended.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 */
SLUICE_API SluiceResult sluiceGetNeuralProgress(const SluiceNeuralCompressor *compressor,
                                                SluiceNeuralProgress *pProgress);

/**
 * Records copies of latents and network to host memory. Submit and wait as for training.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER.
 */
SLUICE_API SluiceResult sluiceRecordNeuralReadback(SluiceNeuralCompressor *compressor,
                                                   VkCommandBuffer commandBuffer);

/**
 * Writes the state of the last readback, so that another compressor can go on from there. With NULL
 * for `pCheckpoint`, `*pSize` becomes the size in bytes; otherwise it is the size of the memory.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT before any readback;
 *         SLUICE_ERROR_SIZE_MISMATCH if `*pSize` is another.
 */
SLUICE_API SluiceResult sluiceGetNeuralCheckpoint(const SluiceNeuralCompressor *compressor,
                                                  void *pCheckpoint, size_t *pSize);

/** Latent image: 16-bit texels [featureCount / 4][height][width]. Bits 4 i to 4 i + 3 of a texel of
 *  layer l have feature 4 l + i. Never grows. */
typedef struct SluiceNeuralTrainedImage {
    uint32_t width, height; ///< Texels.
    const uint16_t *pTexels;
} SluiceNeuralTrainedImage;

/** Inputs of the network that depend on the mip. Never grows. */
typedef struct SluiceNeuralTrainedMip {
    uint32_t latentImage; ///< The finer of its two latent images; the coarser is the next.
    float positionLod, positionScale;
} SluiceNeuralTrainedMip;

/** Trained set of schema 3. */
typedef struct SluiceNeuralTrainedSet {
    uint32_t structSize; ///< sizeof(SluiceNeuralTrainedSet).
    uint32_t mipCount, featureCount, latentImageCount;
    SluiceNeuralTrainedImage latentImages[8];
    SluiceNeuralTrainedMip mips[16];
    /** Weights of layers 0 to 3 [output][input], scales as float, biases as int32. */
    const void *pInt8Weights;
    size_t int8Size; ///< Bytes: 9472.
    /** Weights of layers 0 to 2 as E4M3 and of layer 3 as int8, biases of layers 0 to 2 as half,
     *  scales and biases of layer 3. */
    const void *pFp8Weights;
    size_t fp8Size; ///< Bytes: 8608.
} SluiceNeuralTrainedSet;

/**
 * Gets the set as of the last readback, at any step. The FP8 network is trained last; before that
 * it is the int8 network, rounded.
 *
 * The memory belongs to the compressor. It lives until the next call, the next readback, or the end
 * of the compressor.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize or before
 *         any readback; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 */
SLUICE_API SluiceResult sluiceGetNeuralTrainedSet(SluiceNeuralCompressor *compressor,
                                                  SluiceNeuralTrainedSet *pSet);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_NEURAL_COMPRESS_H */
