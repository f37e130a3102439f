/** Network with weights in the order of use by strips: four outputs at a time. */
#ifndef SLC_NEURAL_FAST_NETWORK_H
#define SLC_NEURAL_FAST_NETWORK_H

#include "neural/decoder.h"

enum { SLC_NEURAL_MAX_WEIGHTS = 96 * 64 + 2 * 64 * 64 + 64 * 16 };

struct slc_neural_fast {
    struct slc_neural_shape shape;
    SluiceNeuralWeightKind kind;
    uint32_t first_weight[SLUICE_NEURAL_LAYERS];
    uint32_t first_output[SLUICE_NEURAL_LAYERS];
    /** INT8 layers: [output / 4][input / 2][output % 4][input % 2]. */
    _Alignas(16) int16_t weights[SLC_NEURAL_MAX_WEIGHTS];
    /** FP8 layers: [input][output]. */
    _Alignas(16) float floats[SLC_NEURAL_MAX_WEIGHTS];
    _Alignas(16) float scales[4 * SLC_NEURAL_MAX_NEURONS];
    _Alignas(16) int32_t biases[4 * SLC_NEURAL_MAX_NEURONS];
    _Alignas(16) float float_biases[4 * SLC_NEURAL_MAX_NEURONS];
};

/** Fills `fast` from the weights. The struct has about 100 KiB: too large for small stacks. */
void slc_neural_fast_init(struct slc_neural_fast *fast, const struct slc_neural_shape *shape,
                          SluiceNeuralWeightKind kind, const uint8_t *blob);

#endif /* SLC_NEURAL_FAST_NETWORK_H */
