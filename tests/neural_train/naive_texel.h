/** A texel of a trained set by the rules of the format, in integers: the oracle of training. */
#ifndef TESTS_NEURAL_TRAIN_NAIVE_TEXEL_H
#define TESTS_NEURAL_TRAIN_NAIVE_TEXEL_H

#include <sluice/neural_compress.h>

/** Inputs of the int8 network for a texel of a mip of width x height texels. */
void naive_inputs(const SluiceNeuralTrainedSet *set, uint32_t mip, uint32_t width, uint32_t height,
                  uint32_t x, uint32_t y, int8_t inputs[48]);

/** Evaluates the int8 network. `int8` is a blob of 9472 bytes. */
void naive_network(const void *int8, const int8_t inputs[48], float outputs[16]);

/** Evaluates the FP8 network for inputs of -1..1, rounding them. `fp8` is a blob of 8608 bytes. */
void naive_fp8_network(const void *fp8, const double inputs[48], double outputs[16]);

/** The number that an E4M3 code stands for. */
double naive_e4m3(uint8_t code);

#endif /* TESTS_NEURAL_TRAIN_NAIVE_TEXEL_H */
