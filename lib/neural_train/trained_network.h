/** The trained network's parameters: initial values, and the int8 and FP8 networks made of them. */
#ifndef SLC_NEURAL_TRAIN_NETWORK_H
#define SLC_NEURAL_TRAIN_NETWORK_H

#include <sluice/base.h>

#include <train_layout.h>

/** As the format stores it: weights [output][input], layer after layer. */
struct slc_int8_network {
    int8_t weights[TRAIN_BIASES];
    float scales[TRAIN_ROWS];
    int32_t biases[TRAIN_ROWS];
};

/** Layers 0 to 2 are E4M3 with biases of half precision, layer 3 is int8. */
struct slc_fp8_network {
    uint8_t weights[TRAIN_BIASES];
    uint16_t biases[TRAIN_ROWS - TRAIN_OUTPUTS];
    float scales[TRAIN_OUTPUTS];
    int32_t last_biases[TRAIN_OUTPUTS];
};

/** Random weights for inputs of -1..1, biases 0. TRAIN_PARAMETERS floats. */
void slc_network_init(float *parameters, uint32_t seed);

/** Folds the codes' scales and offsets into scales and biases. Parameters are finite. */
void slc_network_to_int8(const float *parameters, struct slc_int8_network *network);
void slc_network_to_fp8(const float *parameters, struct slc_fp8_network *network);

/** Nearest E4M3 code, ties to even; at most 448. */
uint8_t slc_train_e4m3(float value);

/** The hash of the shaders, and a float of 0 to 1 made of it. */
uint32_t slc_train_hash(uint32_t x);
float slc_train_unit_float(uint32_t bits);

#endif /* SLC_NEURAL_TRAIN_NETWORK_H */
