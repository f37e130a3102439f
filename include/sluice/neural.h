/**
 * Neural textures: all channels of a material compressed together, decoded by a small network where
 * they are sampled. Reads, decodes and writes .ntc files. Link `sluice-neural`.
 *
 * A file holds latent images, which are grids of small codes, and the weights of a network. A texel
 * of a mip is decoded from the codes around it. Two formats are read and written:
 * - schema 1 (compressors of version 0.5 to 0.7): each mip uses one latent image, which is a fine
 *   and a coarse grid of 1 to 8 bits per code. Texels outside clamp.
 * - schema 3 (version 0.9): each mip uses two latent images of 4 bits per code. Texels outside
 * wrap.
 *
 * Mips that share latent images are fused: one piece of the latents serves all of them.
 * docs/neural.md has the format of what these calls return.
 */
#ifndef SLUICE_NEURAL_H
#define SLUICE_NEURAL_H

#include <sluice/input.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Most mips, latent images, channels and weight layers of a set. */
#define SLUICE_NEURAL_MAX_MIPS 16
#define SLUICE_NEURAL_MAX_LATENT_IMAGES 8
#define SLUICE_NEURAL_MAX_CHANNELS 16
#define SLUICE_NEURAL_LAYERS 4

/** Most texels in width and height of a set. */
#define SLUICE_NEURAL_MAX_SIZE 32768

/** A file of neural textures. Constant after sluiceOpenNeuralSet. */
typedef struct SluiceNeuralSet SluiceNeuralSet;

/** Settings of a set. A field of zero selects its default. */
typedef struct SluiceNeuralSetCreateInfo {
    uint32_t structSize;                         ///< sizeof(SluiceNeuralSetCreateInfo).
    const char *pPath;                           ///< Required without pInput. Copied.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log; ///< Problems of the file. Each is logged once, at most 16.
    /** Reads these bytes instead of the file (input.h). Copied, but not the bytes. pPath is then a
     *  name for messages and may be NULL. Default: NULL, the file. */
    const SluiceInput *pInput;
    /** Pool that opens and closes the file as it is read (input.h). Must outlive the set. Not used
     *  with pInput. Default: NULL, the file stays open. */
    SluiceFilePool *filePool;
} SluiceNeuralSetCreateInfo;

/**
 * Opens a file and reads its description and its weights. `*pSet` belongs to the caller, who
 * destroys it with sluiceDestroyNeuralSet.
 *
 * Every field of the file is checked. Memory: the description, at most 1 MiB, and the weights, at
 * most 34 KiB.
 *
 * Returns SLUICE_NOT_READY if the input says so, or if no file descriptor is free: call again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT; SLUICE_ERROR_FILE_NOT_FOUND;
 *         SLUICE_ERROR_IO; SLUICE_ERROR_CORRUPT_DATA; SLUICE_ERROR_UNSUPPORTED for schema 2, other
 *         containers, and sizes above SLUICE_NEURAL_MAX_SIZE; SLUICE_ERROR_LIMIT_EXCEEDED for a
 *         description above 1 MiB; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceOpenNeuralSet(const SluiceNeuralSetCreateInfo *pInfo,
                                            SluiceNeuralSet **pSet);

/** Destroys a set. NULL is allowed. Thread safety: external on `set`. */
SLUICE_API void sluiceDestroyNeuralSet(SluiceNeuralSet *set);

/** Size of the network. */
typedef enum SluiceNeuralNetwork {
    SLUICE_NEURAL_NETWORK_SMALL = 0,  ///< Schema 1: 48, 64, 64, 64, 16 neurons.
    SLUICE_NEURAL_NETWORK_MEDIUM = 1, ///< Schema 1: 64 inputs.
    SLUICE_NEURAL_NETWORK_LARGE = 2,  ///< Schema 1: 80 inputs.
    SLUICE_NEURAL_NETWORK_XLARGE = 3, ///< Schema 1: 96 inputs.
    SLUICE_NEURAL_NETWORK_SCHEMA3 = 4 ///< Schema 3: 48, 64, 48, 32, 16 neurons.
} SluiceNeuralNetwork;

/** Weights of a network. */
typedef enum SluiceNeuralWeightKind {
    SLUICE_NEURAL_WEIGHTS_INT8 = 0, ///< Results are defined to the bit.
    /** Layers 0 to 2 in 8-bit floating point (E4M3), layer 3 as INT8. */
    SLUICE_NEURAL_WEIGHTS_FP8 = 1,
    /** FP8 weights widened to 16-bit floating point, for shaders that compute in it
     *  (SLUICE_NEURAL_HALF in neural.glsl). Only sluiceGetNeuralWeights takes this kind. */
    SLUICE_NEURAL_WEIGHTS_HALF = 2
} SluiceNeuralWeightKind;

/** Transfer function of a channel's values. */
typedef enum SluiceNeuralColorSpace {
    SLUICE_NEURAL_COLOR_LINEAR = 0,
    SLUICE_NEURAL_COLOR_SRGB = 1,
    SLUICE_NEURAL_COLOR_HLG = 2 ///< Hybrid log-gamma of linear values; linear 1 is code 0.5.
} SluiceNeuralColorSpace;

/** Format of a texture's channels before compression. */
typedef enum SluiceNeuralChannelFormat {
    SLUICE_NEURAL_CHANNEL_UNKNOWN = 0,
    SLUICE_NEURAL_CHANNEL_UNORM8 = 1,
    SLUICE_NEURAL_CHANNEL_UNORM16 = 2,
    SLUICE_NEURAL_CHANNEL_FLOAT16 = 3,
    SLUICE_NEURAL_CHANNEL_FLOAT32 = 4,
    SLUICE_NEURAL_CHANNEL_UINT32 = 5
} SluiceNeuralChannelFormat;

/** Description of a set. */
typedef struct SluiceNeuralSetInfo {
    uint32_t structSize;       ///< sizeof(SluiceNeuralSetInfo).
    uint32_t schema;           ///< 1 or 3.
    uint32_t width, height;    ///< Texels of mip 0.
    uint32_t mipCount;         ///< Each mip has max(1, size >> mip) texels.
    uint32_t channelCount;     ///< Channels of the network's output that the file declares.
    uint32_t validChannels;    ///< Bit c: channel c belongs to a texture. Others are garbage.
    uint32_t textureCount;     ///< See sluiceGetNeuralTexture.
    uint32_t latentImageCount; ///< See sluiceGetNeuralLatentImage.
    SluiceNeuralNetwork network;
    uint32_t inputCount;   ///< Inputs of the network: 48, 64, 80 or 96.
    uint32_t highFeatures; ///< Codes per texel of the fine grid. 4, 8, 12 or 16.
    uint32_t highBits;     ///< Bits per code: 1, 2, 4 or 8. Schema 3: 4.
    uint32_t lowFeatures;  ///< Codes per texel of the coarse grid. Schema 3: highFeatures.
    uint32_t lowBits;      ///< Bits per code. Schema 3: 4.
    uint32_t gridScale;    ///< Texels of mip 0 per texel of the finest grid, rounded.
    bool hasInt8, hasFp8;  ///< Weights in the file.
    uint64_t fileSize;     ///< Bytes.
    uint64_t latentSize;   ///< Bytes of all latents as stored.
} SluiceNeuralSetInfo;

/**
 * Gets the properties of a set.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetNeuralSetInfo(const SluiceNeuralSet *set,
                                               SluiceNeuralSetInfo *pInfo);

/** A texture: a run of channels. */
typedef struct SluiceNeuralTexture {
    uint32_t structSize;   ///< sizeof(SluiceNeuralTexture).
    const char *pName;     ///< UTF-8 as the file has it. Lives as long as the set.
    uint32_t firstChannel; ///< Below the set's channelCount.
    uint32_t channelCount; ///< 1 to 4.
    SluiceNeuralChannelFormat format;
    SluiceNeuralColorSpace rgbColorSpace;   ///< Wanted of the decoded texture.
    SluiceNeuralColorSpace alphaColorSpace; ///< Wanted of channel 3.
    uint32_t bcFormat; ///< Block format the author proposes: 1 to 7 for BC1 to BC7, 0 for none.
} SluiceNeuralTexture;

/**
 * Gets a texture.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize or an
 *         `index` that is not below textureCount.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetNeuralTexture(const SluiceNeuralSet *set, uint32_t index,
                                               SluiceNeuralTexture *pTexture);

/**
 * Gets the color space in which the network returns a channel (sluiceConvertNeuralColor).
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a `channel` that is not
 *         below channelCount.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetNeuralChannel(const SluiceNeuralSet *set, uint32_t channel,
                                               SluiceNeuralColorSpace *pColorSpace);

/** A mip. */
typedef struct SluiceNeuralMip {
    uint32_t structSize;       ///< sizeof(SluiceNeuralMip).
    uint32_t width, height;    ///< Texels.
    uint32_t latentImage;      ///< First latent image that it uses.
    uint32_t latentImageCount; ///< Schema 1: 1. Schema 3: 2.
    float positionLod;         ///< Level between its latent images, -1024 to 1024.
    float positionScale;       ///< Factor of texel coordinates in the network's position input.
    uint32_t firstFusedMip;    ///< First mip that uses the same latent images.
    uint32_t fusedMipCount;    ///< Mips that use them, this one included.
} SluiceNeuralMip;

/**
 * Gets a mip, the latent images that it uses and the mips that are fused with it.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize or a
 *         `mip` that is not below mipCount.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetNeuralMip(const SluiceNeuralSet *set, uint32_t mip,
                                           SluiceNeuralMip *pMip);

/** A latent image. */
typedef struct SluiceNeuralLatentImage {
    uint32_t structSize;          ///< sizeof(SluiceNeuralLatentImage).
    uint32_t width, height;       ///< Texels of the fine grid. Schema 3: of the image.
    uint32_t lowWidth, lowHeight; ///< Texels of the coarse grid. Schema 3: 0.
    uint32_t partCount;           ///< Parts in the file. See SluiceNeuralLatentPart.
    uint32_t firstMip;            ///< First mip that uses it.
    uint32_t mipCount;            ///< Mips that use it. 0: none does.
} SluiceNeuralLatentImage;

/**
 * Gets a latent image and the mips that it serves.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for a wrong structSize or an
 *         `index` that is not below latentImageCount.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetNeuralLatentImage(const SluiceNeuralSet *set, uint32_t index,
                                                   SluiceNeuralLatentImage *pImage);

/** Bytes of a latent image in the file. Never grows. */
typedef struct SluiceNeuralLatentPart {
    uint64_t offset;     ///< From the start of the file.
    uint64_t storedSize; ///< Bytes in the file.
    uint64_t size;       ///< Bytes once decompressed.
    bool isCompressed;   ///< GDeflate.
} SluiceNeuralLatentPart;

/**
 * Gets where a part of a latent image lies in the file.
 *
 * Schema 1: part 0 is the fine grid, part 1 the coarse grid. Code e = (y * width + x) * features +
 * feature is in bits e * bits of the little-endian bit string. Schema 3: part p is a layer of
 * 16-bit texels with the features 4 p to 4 p + 3, the first one in bits 0 to 3; as an image
 * VK_FORMAT_A4R4G4B4_UNORM_PACK16.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if `image` is not below
 *         latentImageCount or `part` not below its partCount.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetNeuralLatentPart(const SluiceNeuralSet *set, uint32_t image,
                                                  uint32_t part, SluiceNeuralLatentPart *pPart);

/**
 * Gets the range of bytes in the file that has all latents of `mipCount` mips from `firstMip` on.
 * Other bytes may lie between them.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT if `mipCount` is 0 or the mips
 *         are not those of the set.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetNeuralLatentRange(const SluiceNeuralSet *set, uint32_t firstMip,
                                                   uint32_t mipCount, uint64_t *pOffset,
                                                   uint64_t *pSize);

/**
 * A rectangle of a grid of codes. 16 bytes. `sliceSize` 0: not resident.
 *
 * Code `feature` of texel (x, y) of the slice is the code e = (y * sliceWidth + x) * features +
 * feature of a string of codes that begins `dataOffset` bytes behind the start of the latents. Its
 * bits are e * bits and up, the lowest first, in little-endian words. Schema 3: texel (x, y) of the
 * slice is texel ((left + x) mod gridWidth, (top + y) mod gridHeight) of the grid.
 */
typedef struct SluiceNeuralSlice {
    uint32_t dataOffset; ///< Bytes, a multiple of 4.
    uint32_t gridSize;   ///< Texels of the whole grid: width in bits 0 to 15, height above.
    uint32_t origin;     ///< Texel of the grid where the slice begins: left, top.
    uint32_t sliceSize;  ///< Texels of the slice: width, height.
} SluiceNeuralSlice;

/** Constants of a mip for decoders. 16 bytes. */
typedef struct SluiceNeuralMipConstants {
    uint32_t firstSlice; ///< Index of the first of its two slices.
    int32_t lodCode;     ///< Level input of the network, -128 to 127.
    float positionLod;   ///< Level input of the network with FP8 weights.
    float positionScale; ///< Factor of texel coordinates in the position inputs.
} SluiceNeuralMipConstants;

/**
 * Constants for decoders, beside latents and weights. 576 bytes of 32-bit scalars and arrays of
 * them: the layout of the GLSL struct of this name in std430 and in scalar blocks. Never grows.
 *
 * Schema 1: latent image n has slice 2 n for its fine grid and 2 n + 1 for its coarse grid. Schema
 * 3: latent image n has slice n.
 */
typedef struct SluiceNeuralConstants {
    uint32_t schema;           ///< 1 or 3.
    uint32_t width, height;    ///< Texels of mip 0.
    uint32_t mipCount;         ///< Mips of the set.
    uint32_t channelCount;     ///< Channels of the set.
    uint32_t validChannels;    ///< Bit c: channel c belongs to a texture.
    uint32_t inputCount;       ///< Inputs of the network: 48, 64, 80 or 96.
    uint32_t networkFeatures;  ///< Inputs per corner (schema 1) or latent image (schema 3).
    uint32_t highFeatures;     ///< Codes per texel of the first slice of a mip.
    uint32_t highBits;         ///< Bits per code there.
    uint32_t lowFeatures;      ///< Codes per texel of the second slice of a mip.
    uint32_t lowBits;          ///< Bits per code there.
    uint32_t firstMip;         ///< First mip whose slices are there.
    uint32_t residentMipCount; ///< Mips whose slices are there.
    uint32_t reserved[2];      ///< 0.
    SluiceNeuralMipConstants mips[SLUICE_NEURAL_MAX_MIPS];
    SluiceNeuralSlice slices[16];
} SluiceNeuralConstants;

/** Stands for a constant in SluiceNeuralOutput::channel. */
#define SLUICE_NEURAL_CONSTANT UINT32_MAX

/** Meaning of an output of the network. Never grows. */
typedef struct SluiceNeuralOutput {
    /** 0 to 15, or SLUICE_NEURAL_CONSTANT. Not in validChannels: garbage. */
    uint32_t channel;
    float constant; ///< The value if `channel` says so, rounded to 1 / 65536. Below 32768.
} SluiceNeuralOutput;

/**
 * Writes the weights of the network as decoders read them.
 *
 * `pOutputs` may be NULL: output c is channel c. Otherwise it has 16 elements, which say what each
 * output of the decoder becomes. So sets with other channels may share one shader; the last layer
 * has its rows in another order, and constants cost nothing.
 *
 * `pBytes` may be NULL: `*pSize` becomes the number of bytes. Otherwise `*pSize` says how many
 * bytes there are at `pBytes`, and becomes how many were written. The bytes, for layers of inputs x
 * outputs neurons (network):
 * - weights of the layers 0 to 3, [output][input], one byte each: INT8, or E4M3 in layers 0 to 2;
 * - INT8: all scales (float), then all biases (int32), layer after layer;
 * - FP8: biases of the layers 0 to 2 (half), then scales (float) and biases (int32) of layer 3.
 * - HALF: as FP8, but weights of the layers 0 to 2 have two bytes each.
 * Smaller networks are padded. Sizes: schema 1 INT8 13952, 14976, 16000, 17024, FP8 512 bytes more
 * than its weights; schema 3 9472 and 8608.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT; SLUICE_ERROR_SIZE_MISMATCH if
 *         `*pSize` is too small (`*pSize` has the size then); SLUICE_ERROR_UNSUPPORTED if the file
 *         has no weights of this kind.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceGetNeuralWeights(const SluiceNeuralSet *set,
                                               SluiceNeuralWeightKind kind,
                                               const SluiceNeuralOutput *pOutputs, uint64_t *pSize,
                                               void *pBytes);

/** Texels to decode: a rectangle of mip `firstMip`, and the texels over it in coarser mips. All
 *  zeros: the whole set. Never grows. */
typedef struct SluiceNeuralRequest {
    uint32_t firstMip;      ///< Finest mip.
    uint32_t mipCount;      ///< Mips from firstMip on. 0: all.
    uint32_t x, y;          ///< Texels of mip firstMip.
    uint32_t width, height; ///< Texels of mip firstMip. 0 and 0: the whole mip; x and y are 0 then.
} SluiceNeuralRequest;

/**
 * Reads the latents that decoding the texels of a request takes, and the constants that go with
 * them. Upload both, or pass them to sluiceDecodeNeuralTexels.
 *
 * Each pair of grids that the mips use becomes two slices. A slice is the rectangle that the
 * coarsest of these mips takes, so that the slices of fused mips are read once. Texels of a request
 * decode to the same bits from its slices as from all latents. Schema 1: slices are those of
 * compressors of version 0.7, byte for byte, if each mip is half of the one before; otherwise they
 * may be larger.
 *
 * `pRequest` may be NULL: the whole set. `pBytes` may be NULL: nothing is read, `*pSize` becomes
 * the number of bytes and `*pConstants` is filled. Otherwise `*pSize` says how many bytes there are
 * at `pBytes`, and becomes how many were written. Checksums are compared at the first
 * read of compressed latents and of whole latent images.
 *
 * Returns SLUICE_NOT_READY if the input says so, or if no file descriptor is free: call again.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for mips or texels that the set
 *         does not have; SLUICE_ERROR_SIZE_MISMATCH if `*pSize` is too small (`*pSize` has the size
 *         then); SLUICE_ERROR_LIMIT_EXCEEDED for more than 2^29 bytes; SLUICE_ERROR_IO;
 *         SLUICE_ERROR_CORRUPT_DATA for latents that do not inflate or fail their checksum;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY. `*pConstants` is unchanged after an error, the bytes are
 *         undefined.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceReadNeuralLatents(const SluiceNeuralSet *set,
                                                const SluiceNeuralRequest *pRequest,
                                                SluiceNeuralConstants *pConstants, uint64_t *pSize,
                                                void *pBytes);

/**
 * Gets a number of bytes that sluiceReadNeuralLatents never exceeds, for requests of this size
 * whose x and y are multiples of `alignment`. x and y of the request are ignored. Slots of this
 * size fit every tile.
 *
 * An `alignment` that is no power of two counts as 1.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for mips or sizes that the set
 *         does not have.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceBoundNeuralLatents(const SluiceNeuralSet *set,
                                                 const SluiceNeuralRequest *pRequest,
                                                 uint32_t alignment, uint64_t *pSize);

/**
 * Reads a part of a latent image as the file has it, inflated (sluiceGetNeuralLatentPart).
 *
 * `pBytes` may be NULL: `*pSize` becomes the number of bytes. Otherwise `*pSize` says how many
 * bytes there are at `pBytes`, and becomes how many were written.
 *
 * Returns and errors: as sluiceReadNeuralLatents.
 * Thread safety: may run beside calls that take a const set.
 */
SLUICE_API SluiceResult sluiceReadNeuralLatentPart(const SluiceNeuralSet *set, uint32_t image,
                                                   uint32_t part, uint64_t *pSize, void *pBytes);

/** Texels to decode on the host. */
typedef struct SluiceNeuralDecodeInfo {
    uint32_t structSize;                     ///< sizeof(SluiceNeuralDecodeInfo).
    const SluiceNeuralConstants *pConstants; ///< Of sluiceReadNeuralLatents.
    const void *pLatents;                    ///< Of the same call.
    uint64_t latentSize;                     ///< Bytes.
    const void *pWeights;                    ///< Of sluiceGetNeuralWeights.
    uint64_t weightSize;                     ///< Bytes.
    SluiceNeuralWeightKind weightKind;
    uint32_t mip;
    uint32_t x, y, width, height; ///< Texels of the mip.
    uint32_t firstChannel;        ///< First output of the network to write.
    uint32_t channelCount;        ///< Outputs to write. 1 to 16.
    /** Required. Row y, column x, channel c are written to [y * rowPitch + x * channelCount + c].
     */
    float *pTexels;
    uint64_t rowPitch;     ///< Floats from a row to the next one. Default: width * channelCount.
    SluiceLogCallback log; ///< Arguments that are refused.
} SluiceNeuralDecodeInfo;

/**
 * Decodes a rectangle of a mip on the calling thread. Takes no memory but 110 KiB of stack. Each
 * call puts the weights into another order, so decode many texels at once.
 *
 * Values are those of the network: in the channel's color space, and perhaps a little outside of 0
 * to 1. With INT8 weights the result is the same bits on every machine. With FP8 weights inputs
 * are rounded to half before they are rounded to E4M3, and sums are in 32-bit floats, in the order
 * of the inputs; other decoders differ by rounding.
 *
 * Returns SLUICE_NOT_READY, with nothing written, if the slices do not have the latents of these
 * texels.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT for texels or channels that do
 *         not exist, for constants that contradict themselves, and for too few bytes of latents or
 *         weights.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceDecodeNeuralTexels(const SluiceNeuralDecodeInfo *pInfo);

/** Latents whose masks are to decode to exactly 0 and 1. */
typedef struct SluiceNeuralMaskInfo {
    uint32_t structSize; ///< sizeof(SluiceNeuralMaskInfo).
    const SluiceNeuralConstants
        *pConstants;           ///< Of whole grids, as sluicePlanNeuralFile makes them.
    void *pLatents;            ///< All codes packed. Some are changed.
    uint64_t latentSize;       ///< Bytes.
    const void *pInt8Weights;  ///< Of sluiceGetNeuralWeights.
    uint64_t weightSize;       ///< Bytes.
    uint32_t channelCount;     ///< Channels of the pictures, outputs of the network. 1 to 16.
    uint32_t maskChannels;     ///< Bit c: channel c is a mask, and clamped.
    uint32_t clampedChannels;  ///< Bit c: decoded values of channel c are clamped to 0..1.
    const float *pLossWeights; ///< Of squared errors, one per channel. NULL: 1.
    /** Target values: per mip of the constants [height][width][channelCount] floats. */
    const float *const *ppMips;
    uint64_t maxWrongCount; ///< Nothing is changed if more texels are wrong. Default: no limit.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log;                       ///< Arguments that are refused.
} SluiceNeuralMaskInfo;

/** Counts of a repair. Texels are of all mips. */
typedef struct SluiceNeuralMaskReport {
    uint32_t structSize;  ///< sizeof(SluiceNeuralMaskReport).
    uint64_t texelCount;  ///< Texels of which a mask should be exactly 0 or 1.
    uint64_t wrongBefore; ///< Wrong texels before: they decoded to another value, clamped to 0..1.
    uint64_t wrongAfter;  ///< Wrong texels after the repair. Usually 0.
} SluiceNeuralMaskReport;

/**
 * Changes latents until masks decode to exactly 0 and 1 with INT8 weights wherever they should.
 *
 * Searches codes around each wrong texel for the change that costs the least squared error in all
 * texels that the code reaches, and changes two codes if one does not suffice. Repairs what trained
 * compressors leave, a few texels in a thousand: a wrong texel takes about 20 ms. Equal arguments
 * give equal bytes.
 *
 * Memory: 8 bytes per texel of all mips, a copy of the latents, 64 bytes per texel of a row of mip
 * 0, and some per row and column of the grids. `pReport` may be NULL.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, also for a mip; SLUICE_ERROR_INVALID_ARGUMENT for slices that
 *         are no whole grids or lie in two groups of mips, for texels and loss weights that are not
 *         finite, and as sluiceDecodeNeuralTexels;
 *         SLUICE_ERROR_OUT_OF_HOST_MEMORY. Latents may have been changed then.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceRepairNeuralMasks(const SluiceNeuralMaskInfo *pInfo,
                                                SluiceNeuralMaskReport *pReport);

/**
 * Converts a value from one color space to another. Negative values of sRGB are on its linear part;
 * HLG is symmetric about 0. Clamp to 0..1 before storing as UNORM.
 * Thread safety: any thread.
 */
SLUICE_API float sluiceConvertNeuralColor(float value, SluiceNeuralColorSpace from,
                                          SluiceNeuralColorSpace to);

/** A file to write. */
typedef struct SluiceNeuralWriteInfo {
    uint32_t structSize; ///< sizeof(SluiceNeuralWriteInfo).
    const char *pPath;   ///< Required without pfnWrite. The file is complete or absent.
    void *pUserData;     ///< Passed to pfnWrite.
    /** Gets the bytes of the file in their order. Takes the place of the file. A result that is not
     *  SLUICE_SUCCESS ends the call and is returned. */
    SluiceResult (*pfnWrite)(void *pUserData, const void *pBytes, size_t size);
    uint32_t schema;        ///< 1 or 3.
    uint32_t width, height; ///< Texels of mip 0. 1 to SLUICE_NEURAL_MAX_SIZE.
    uint32_t mipCount;      ///< Default: all.
    uint32_t channelCount;  ///< 1 to 16. The file has an even number.
    uint32_t textureCount;  ///< At most 16.
    const SluiceNeuralTexture *pTextures;
    const SluiceNeuralColorSpace *pColorSpaces; ///< One per channel. NULL: all linear.
    SluiceNeuralNetwork network;                ///< Of the schema.
    uint32_t highFeatures; ///< Codes per texel of a latent image, in schema 1 of its fine grid.
    uint32_t highBits;     ///< Schema 1.
    uint32_t lowFeatures;  ///< Schema 1.
    uint32_t lowBits;      ///< Schema 1.
    uint32_t gridScale;    ///< Texels of mip 0 per texel of the finest grid. 1 to 6.
    /** At most 8, in schema 3 even. Default: all latent images with more than one texel. */
    uint32_t latentImageCount;
    /** All codes, a byte each: grid after grid, each [y][x][feature]. Grids have the order of the
     *  slices of sluicePlanNeuralFile. Required without pLatents. */
    const uint8_t *pCodes;
    /** All codes packed, as the slices of sluicePlanNeuralFile say. Used if pCodes is NULL. */
    const void *pLatents;
    const void *pInt8Weights; ///< As sluiceGetNeuralWeights writes them. NULL: none.
    const void *pFp8Weights;  ///< As sluiceGetNeuralWeights writes them. NULL: none.
    const SluiceAllocationCallbacks *pAllocator; ///< Default: malloc and free.
    SluiceLogCallback log;
} SluiceNeuralWriteInfo;

/**
 * Gets the constants and the latent layout of a file before it is written, as compressors need
 * them. Latents, weights and the target of `pInfo` are not used.
 *
 * Slices are whole grids, including grids that no mip uses. `*pLatentSize` is the number of
 * bytes of SluiceNeuralWriteInfo::pLatents. Mips use latents by the rules of the format's own
 * compressors.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, also for more than 2^29 bytes
 * of latents. Thread safety: any thread.
 */
SLUICE_API SluiceResult sluicePlanNeuralFile(const SluiceNeuralWriteInfo *pInfo,
                                             SluiceNeuralConstants *pConstants,
                                             uint64_t *pLatentSize);

/**
 * Writes a file. Equal arguments give equal bytes. Latents of schema 3 have checksums.
 *
 * Memory: the latents, at most 2^30 bytes, and a description, at most 1 MiB with the names of
 * textures. The file is written as `pPath` +
 * ".sluice-part", then synced to disk and renamed.
 *
 * Returns SLUICE_NOT_READY, with nothing written, if no file descriptor is free.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER, also without weights; SLUICE_ERROR_INVALID_ARGUMENT, also for
 *         codes that do not fit into their bits, weights that are no numbers, and more memory than
 *         that;
 *         SLUICE_ERROR_FILE_NOT_FOUND if the folder does not exist; SLUICE_ERROR_BUSY if another
 *         writer has the file open; SLUICE_ERROR_IO; SLUICE_ERROR_OUT_OF_HOST_MEMORY; results of
 *         pfnWrite.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceWriteNeuralFile(const SluiceNeuralWriteInfo *pInfo);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_NEURAL_H */
