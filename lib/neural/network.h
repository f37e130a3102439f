/** The weights of a network, as one blob that shaders read. */
#ifndef SLC_NEURAL_NETWORK_H
#define SLC_NEURAL_NETWORK_H

#include "neural/neural_set.h"

/** Byte offsets in a blob. */
struct slc_neural_blob {
    uint32_t weights[SLUICE_NEURAL_LAYERS]; ///< [output][input], a byte each, some of HALF two
    uint32_t scales[SLUICE_NEURAL_LAYERS];  ///< float; FP8: of layer 3 alone
    uint32_t biases[SLUICE_NEURAL_LAYERS];  ///< int32; FP8: half in layers 0 to 2
    uint32_t size;
};

struct slc_neural_blob slc_neural_blob_of(const struct slc_neural_shape *shape,
                                          SluiceNeuralWeightKind kind);

/**
 * Finds the networks of a document, reads their weights and pads them to the sizes of their kind.
 * Errors: as slc_neural_read_view; CORRUPT_DATA, logged, also if there is no network.
 */
SluiceResult slc_neural_read_networks(struct SluiceNeuralSet *set,
                                      const struct slc_neural_document *document);

/** Whether no number of a blob is NaN or so large that a sum could become infinite. */
bool slc_neural_blob_is_sound(const struct slc_neural_shape *shape, SluiceNeuralWeightKind kind,
                              const uint8_t *blob);

#endif /* SLC_NEURAL_NETWORK_H */
