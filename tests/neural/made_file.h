/** Files with random codes and weights, written by the library. */
#ifndef TESTS_NEURAL_MADE_FILE_H
#define TESTS_NEURAL_MADE_FILE_H

#include <sluice/neural.h>

/** Bytes of a file; starts zeroed. `fail_at`: the write that fails, 0 for none. */
struct made_file {
    uint8_t *bytes; ///< free() it
    size_t size;
    uint32_t writes, fail_at;
};

/** Everything that a file is made of. Free the arrays with free_made_parts. */
struct made_parts {
    SluiceNeuralWriteInfo info;
    SluiceNeuralTexture textures[2];
    SluiceNeuralColorSpace spaces[16];
    SluiceNeuralConstants constants; ///< as planned
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

/** Fills with numbers from a seed. */
void make_parts(struct made_parts *parts, const struct made_shape *shape, uint32_t seed);
void free_made_parts(struct made_parts *parts);

/** Writes to memory. Free `file->bytes`. */
SluiceResult write_made_file(const struct made_parts *parts, struct made_file *file);

/** Writes and opens. `file` must stay until the set is destroyed. */
SluiceNeuralSet *open_made_file(const struct made_shape *shape, uint32_t seed,
                                struct made_file *file);

/** Shapes of both schemas: powers of two and others, all bits, odd nibbles, narrow ones. */
#define MADE_SHAPE_COUNT 10
extern const struct made_shape made_shapes[MADE_SHAPE_COUNT];

#endif /* TESTS_NEURAL_MADE_FILE_H */
