/** Pictures of equal size whose channels are compressed together, and their mips. */
#ifndef TOOLS_COMMON_TRAINING_SET_H
#define TOOLS_COMMON_TRAINING_SET_H

#include <sluice/neural.h>
#include <sluice/neural_compress.h>

#define TRAINING_SET_NAME 64

struct training_set {
    uint32_t width, height, mip_count, channel_count, texture_count;
    float *level0; ///< owned; [y][x][SLUICE_NEURAL_MAX_CHANNELS], in each channel's space
    float *mips[SLUICE_NEURAL_MAX_MIPS]; ///< owned; [y][x][channel_count]
    SluiceNeuralTrainingChannel meaning[SLUICE_NEURAL_MAX_CHANNELS];
    SluiceNeuralColorSpace spaces[SLUICE_NEURAL_MAX_CHANNELS];
    SluiceNeuralTexture textures[SLUICE_NEURAL_MAX_CHANNELS];
    char names[SLUICE_NEURAL_MAX_CHANNELS][TRAINING_SET_NAME];
};

/** A picture with texels [y][x][channel_count]. */
struct training_picture {
    const char *name; ///< copied
    uint32_t width, height, channel_count;
    const float *texels; ///< values in `space`; for HLG linear values, which are converted
    SluiceNeuralChannelFormat format;
    SluiceNeuralColorSpace space; ///< color space of channels 0 to 2; channel 3 is linear
    bool mask;                    ///< true: the last channel is a mask
};

/** Adds the channels of a picture. Returns false for a different size, for too many channels, or
 * when out of memory, and reports it on stderr. */
bool training_set_add(struct training_set *set, const struct training_picture *picture);

/** Sets the weight of squared errors in a picture's channels: above 0, at most 1000. Default: 1.
 * Returns false if no picture has the name. */
bool training_set_weigh(struct training_set *set, const char *name, float weight);

/** Computes the mips: each texel is the mean, in linear light, of the texels of mip 0 that it
 * covers. Returns false when out of memory. */
bool training_set_finish_mips(struct training_set *set);

/** Accepts a zeroed set. */
void training_set_free(struct training_set *set);

#endif /* TOOLS_COMMON_TRAINING_SET_H */
