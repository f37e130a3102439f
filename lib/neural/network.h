/** Weights of a network in one blob for shaders. */
#ifndef SLC_NEURAL_NETWORK_H
#define SLC_NEURAL_NETWORK_H

#include "neural/neural_set.h"

/** Byte offsets in a blob. */
struct slc_neural_blob {
    uint32_t weights[SLUICE_NEURAL_LAYERS]; ///< [output][input], 1 byte each; HALF: some 2 bytes
    uint32_t scales[SLUICE_NEURAL_LAYERS];  ///< float; FP8: only in layer 3
    uint32_t biases[SLUICE_NEURAL_LAYERS];  ///< int32; FP8: half in layers 0 to 2
    uint32_t size;
};

struct slc_neural_blob slc_neural_blob_of(const struct slc_neural_shape *shape,
                                          SluiceNeuralWeightKind kind);

/**
 * Finds the networks of a document, reads their weights and pads them to the sizes of their kind.
 * Errors: slc_neural_read_view's; CORRUPT_DATA, logged, also for a document without network.
 */
SluiceResult slc_neural_read_networks(struct SluiceNeuralSet *set,
                                      const struct slc_neural_document *document);

/** Tells whether all numbers of a blob are not NaN and small enough for finite sums. */
bool slc_neural_blob_is_sound(const struct slc_neural_shape *shape, SluiceNeuralWeightKind kind,
                              const uint8_t *blob);

#endif /* SLC_NEURAL_NETWORK_H */
