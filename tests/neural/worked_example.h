/** The smallest file of schema 3: 4 x 4 texels, one mip, a hidden layer of 4 neurons. Its texel
 *  (1, 2) was decoded by hand; test_neural_decode.c has the numbers. */
#ifndef TESTS_NEURAL_WORKED_EXAMPLE_H
#define TESTS_NEURAL_WORKED_EXAMPLE_H

#include <stddef.h>
#include <stdint.h>

#define WORKED_EXAMPLE_MAX_SIZE 4096

/** Writes the file. Returns its size. */
size_t write_worked_example(uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE]);

#endif /* TESTS_NEURAL_WORKED_EXAMPLE_H */
