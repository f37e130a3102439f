/** A neural texture set: the description, checked, and where everything lies. */
#ifndef SLC_NEURAL_NEURAL_SET_H
#define SLC_NEURAL_NEURAL_SET_H

#include <sluice/neural.h>

#include "image/input_file.h"
#include "neural/neural_document.h"

#include <stdatomic.h>

#define SLC_NEURAL_MAX_GRIDS 16
#define SLC_NEURAL_MAX_TEXT_SIZE (1u << 20) /* bytes of a description */
#define SLC_NEURAL_MAX_PARTS SLC_NEURAL_MAX_LAYER_VIEWS

/**
 * A grid of codes. Schema 1 has two for each latent image n: 2 n is fine, 2 n + 1 coarse. Schema 3
 * has one for each: n. So a mip uses two grids that follow one another in either schema.
 */
struct slc_neural_grid {
    uint32_t width, height;
    uint32_t features, bits;
    uint32_t part_count;                                ///< schema 3: layers. Schema 1: 1
    struct slc_neural_view parts[SLC_NEURAL_MAX_PARTS]; ///< offsets from the start of the file
};

struct slc_neural_mip {
    uint32_t width, height;
    uint32_t first_grid; ///< of two
    float position_lod, position_scale;
};

/** Sizes of a network. */
struct slc_neural_shape {
    uint32_t inputs[SLUICE_NEURAL_LAYERS];
    uint32_t outputs[SLUICE_NEURAL_LAYERS];
};

struct SluiceNeuralSet {
    SluiceAllocationCallbacks allocator;
    struct slc_input_file file;
    char *text; ///< owned: names point into it
    size_t text_size;
    uint64_t data_offset, data_size; ///< the data chunk
    SluiceNeuralSetInfo info;
    struct slc_neural_document_texture textures[SLUICE_NEURAL_MAX_CHANNELS];
    uint32_t color_spaces[SLUICE_NEURAL_MAX_CHANNELS];
    struct slc_neural_mip mips[SLUICE_NEURAL_MAX_MIPS];
    struct slc_neural_grid grids[SLC_NEURAL_MAX_GRIDS];
    uint32_t grid_count;
    uint8_t *weights[2];           ///< owned, by SluiceNeuralWeightKind; NULL: not in the file
    atomic_bool *verified;         ///< owned, SLC_NEURAL_MAX_GRIDS: the checksums were compared
    struct slc_neural_shape shape; ///< of the network, padded to the sizes of its kind
};

/** Neurons of a network of this kind. */
struct slc_neural_shape slc_neural_shape_of(SluiceNeuralNetwork network);

/**
 * Checks a document and fills everything of `set` but the weights. `set` has file and data chunk.
 * Errors, logged: CORRUPT_DATA; UNSUPPORTED.
 */
SluiceResult slc_neural_check(struct SluiceNeuralSet *set,
                              const struct slc_neural_document *document);

/** Finds a view and makes its offset that of the file. `size`: bytes it must have, uncompressed.
 *  Errors, logged: CORRUPT_DATA. */
SluiceResult slc_neural_find_view(const struct SluiceNeuralSet *set,
                                  const struct slc_neural_document *document, uint32_t index,
                                  uint64_t size, struct slc_neural_view *view);

/** Logs mips that the set does not have. Errors: INVALID_ARGUMENT. */
SluiceResult slc_neural_check_mips(const SluiceNeuralSet *set, uint32_t first, uint32_t count);

#endif /* SLC_NEURAL_NEURAL_SET_H */
