/** Files with random codes and weights, written by the library. */
#ifndef TESTS_NEURAL_MADE_FILE_H
#define TESTS_NEURAL_MADE_FILE_H

#include <sluice/neural.h>

/** Bytes of a file; zeroed before. `fail_at`: number of the write to fail; 0: none. */
struct made_file {
    uint8_t *bytes; ///< free() it
    size_t size;
    uint32_t writes, fail_at;
};

/** Parts of a file. Free the arrays with free_made_parts. */
struct made_parts {
    SluiceNeuralWriteInfo info;
    SluiceNeuralTexture textures[2];
    SluiceNeuralColorSpace spaces[16];
    SluiceNeuralConstants constants; ///< constants of the plan
    uint64_t latent_size;
    uint8_t *codes, *int8_weights, *fp8_weights;
    size_t code_count;
};

/** Shape of a file. */
struct made_shape {
    uint32_t schema, width, height, grid_scale;
    uint32_t high_features, high_bits, low_features, low_bits;
    SluiceNeuralNetwork network;
};

/** Fills the parts with random numbers from a seed. */
void make_parts(struct made_parts *parts, const struct made_shape *shape, uint32_t seed);
void free_made_parts(struct made_parts *parts);

/** Writes to memory. The caller frees `file->bytes`. */
SluiceResult write_made_file(const struct made_parts *parts, struct made_file *file);

/** Writes and opens a file. `file` must outlive the set. */
SluiceNeuralSet *open_made_file(const struct made_shape *shape, uint32_t seed,
                                struct made_file *file);

/** Shapes of both schemas: powers of two and others, all bit counts, odd nibbles, narrow ones. */
#define MADE_SHAPE_COUNT 10
extern const struct made_shape made_shapes[MADE_SHAPE_COUNT];

#endif /* TESTS_NEURAL_MADE_FILE_H */
