/* Layout of training buffers, shared by C and GLSL. Scalars have 32 bits. */
#ifndef TRAIN_LAYOUT_H
#define TRAIN_LAYOUT_H

/* The network: 48 -> 64 -> 48 -> 32 -> 16. Weights are [output][input], layer after layer, then
 * the biases of all layers. */
#define TRAIN_INPUTS 48
#define TRAIN_OUTPUTS 16
#define TRAIN_WEIGHTS0 0
#define TRAIN_WEIGHTS1 3072
#define TRAIN_WEIGHTS2 6144
#define TRAIN_WEIGHTS3 7680
#define TRAIN_BIASES 8192
#define TRAIN_BIAS1 8256
#define TRAIN_BIAS2 8304
#define TRAIN_BIAS3 8336
#define TRAIN_ROWS 160
#define TRAIN_PARAMETERS 8352
/* A partial sum: the gradients of all parameters, then the squared errors of the outputs. */
#define TRAIN_PARTIAL 8368

/* The network's buffer, in floats. The forward pass uses `effective` weights, rounded like the
 * decoder's weights. */
#define TRAIN_MASTER 0
#define TRAIN_FIRST_MOMENT 8352
#define TRAIN_SECOND_MOMENT 16704
#define TRAIN_INT8_MASTER 25056 /* kept while the FP8 network is trained */
#define TRAIN_EFFECTIVE 33408
#define TRAIN_TRANSPOSED 41760
#define TRAIN_NETWORK_SIZE 50112

#define TRAIN_TILE 32 /* samples */
#define TRAIN_MIPS 16
#define TRAIN_MIP_WORDS 16
#define TRAIN_CHANNELS 256 /* in the table, behind the mips */
#define TRAIN_CHANNEL_WORDS 4
#define TRAIN_TABLE_WORDS 320

/* Words of a mip in the table. */
#define TRAIN_MIP_FIRST_TEXEL 0
#define TRAIN_MIP_WIDTH 1
#define TRAIN_MIP_HEIGHT 2
#define TRAIN_MIP_FIRST_TILE 3
#define TRAIN_MIP_STRATUM 4 /* texels per sample */
#define TRAIN_MIP_FINE 5    /* finer latent image: first word, width, height */
#define TRAIN_MIP_COARSE 8
#define TRAIN_MIP_POSITION_SCALE 11 /* float */
#define TRAIN_MIP_LOD 12            /* float: the network's input */

/* Words of a channel. */
#define TRAIN_CHANNEL_WEIGHT 0  /* float; 0: the channel is not used */
#define TRAIN_CHANNEL_MARGIN 1  /* float: how far beyond 0 and 1 a mask is pushed */
#define TRAIN_CHANNEL_CLAMPED 2 /* the decoded value is clamped to 0..1 */
#define TRAIN_MASK_ERROR 0.1    /* the least error of a mask that is not exact at 0 or 1 */

#define TRAIN_QUANTIZE_INPUTS 1u
#define TRAIN_QUANTIZE_NETWORK 2u /* hidden values and weights */
#define TRAIN_FP8 4u              /* quantize for the FP8 network, otherwise for int8 */
#define TRAIN_LATENTS 8u          /* latents learn */
#define TRAIN_ROUND_LATENTS 16u   /* round to codes; otherwise add noise of one code */
#define TRAIN_UPDATE 32u          /* update parameters; otherwise only remake effective values */
#define TRAIN_EXACT_LATENTS 64u   /* neither rounding nor noise */

/* clang-format off */
#define TRAIN_PUSH_FIELDS                                                                          \
    uint step; /* step of the sample positions */                                                  \
    uint seed;                                                                                     \
    uint flags;                                                                                    \
    uint nextFlags; /* flags of the next step, for the effective values */                         \
    uint mipCount;                                                                                 \
    uint tileCount;                                                                                \
    uint tilesPerGroup;                                                                            \
    uint groupCount;                                                                               \
    uint latentCount; /* features of all texels of all latent images */                            \
    uint lossSlot;                                                                                 \
    uint channelCount;                                                                             \
    float networkRate; /* includes the correction for moments that start at 0 */                   \
    float latentRate;                                                                              \
    float latentUnit; /* unit of a latent's gradient in fixed point */                             \
    float decay1;                                                                                  \
    float decay2;
/* clang-format on */

#endif
