/** Neural texture set: the checked description, and positions in the file. */
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
 * Grid of codes. In schema 1, latent image n has two grids: 2 n (fine) and 2 n + 1 (coarse). In
 * schema 3, latent image n has grid n. In both schemas, a mip uses two consecutive grids.
 */
struct slc_neural_grid {
    uint32_t width, height;
    uint32_t features, bits;
    uint32_t part_count;                                ///< schema 3: layers. Schema 1: 1
    struct slc_neural_view parts[SLC_NEURAL_MAX_PARTS]; ///< offsets from the start of the file
};

struct slc_neural_mip {
    uint32_t width, height;
    uint32_t first_grid; ///< first of two grids
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
    struct slc_neural_shape shape; ///< the network's, padded to the sizes of its kind
};

/** Returns the neurons of a network of this kind. */
struct slc_neural_shape slc_neural_shape_of(SluiceNeuralNetwork network);

/**
 * Checks a document and fills `set` except weights. `set` must have file and data chunk.
 * Errors, logged: CORRUPT_DATA; UNSUPPORTED.
 */
SluiceResult slc_neural_check(struct SluiceNeuralSet *set,
                              const struct slc_neural_document *document);

/** Finds a view and converts its offset to an offset in the file. `size`: required uncompressed
 *  bytes. Errors, logged: CORRUPT_DATA. */
SluiceResult slc_neural_find_view(const struct SluiceNeuralSet *set,
                                  const struct slc_neural_document *document, uint32_t index,
                                  uint64_t size, struct slc_neural_view *view);

/** Checks a range of mips. Errors, logged: INVALID_ARGUMENT. */
SluiceResult slc_neural_check_mips(const SluiceNeuralSet *set, uint32_t first, uint32_t count);

#endif /* SLC_NEURAL_NEURAL_SET_H */
