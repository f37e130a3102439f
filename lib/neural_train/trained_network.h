/** Parameters of a trained network: initial values, and conversion to int8 and FP8 networks. */
#ifndef SLC_NEURAL_TRAIN_NETWORK_H
#define SLC_NEURAL_TRAIN_NETWORK_H

#include <sluice/base.h>

#include <train_layout.h>

/** Int8 network in the layout of the format: weights [output][input], layer after layer. */
struct slc_int8_network {
    int8_t weights[TRAIN_BIASES];
    float scales[TRAIN_ROWS];
    int32_t biases[TRAIN_ROWS];
};

/** FP8 network. Layers 0 to 2: E4M3 with half biases. Layer 3: int8. */
struct slc_fp8_network {
    uint8_t weights[TRAIN_BIASES];
    uint16_t biases[TRAIN_ROWS - TRAIN_OUTPUTS];
    float scales[TRAIN_OUTPUTS];
    int32_t last_biases[TRAIN_OUTPUTS];
};

/** Fills TRAIN_PARAMETERS floats: random weights for inputs in -1..1, biases 0. */
void slc_network_init(float *parameters, uint32_t seed);

/** Converts to int8; folds codes' scales and offsets into scales and biases. Input: finite. */
void slc_network_to_int8(const float *parameters, struct slc_int8_network *network);
void slc_network_to_fp8(const float *parameters, struct slc_fp8_network *network);

/** Returns the nearest E4M3 code, ties to even, at most 448. */
uint8_t slc_train_e4m3(float value);

/** Returns the shaders' hash, or a float in 0..1 from the hash. */
uint32_t slc_train_hash(uint32_t x);
float slc_train_unit_float(uint32_t bits);

#endif /* SLC_NEURAL_TRAIN_NETWORK_H */
