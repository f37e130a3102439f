/** Description of a new file, as JSON text. */
#ifndef SLC_NEURAL_FILE_TEXT_H
#define SLC_NEURAL_FILE_TEXT_H

#include "neural/neural_set.h"

/** Bytes of a future view. */
struct slc_neural_piece {
    const uint8_t *bytes; ///< borrowed
    uint64_t size;
    bool has_checksum;
};

/** Networks have 21 pieces, latents at most 32. */
#define SLC_NEURAL_MAX_PIECES 64

/** Pieces in the order of their views: INT8 network, FP8 network, latents. */
struct slc_neural_pieces {
    struct slc_neural_piece pieces[SLC_NEURAL_MAX_PIECES];
    uint32_t count;
    uint32_t first_latent;
    bool has[2]; ///< networks, by SluiceNeuralWeightKind
};

/** Growing text. Out of memory: `failed` is set. */
struct slc_neural_text {
    SluiceAllocationCallbacks allocator;
    char *text; ///< owned
    size_t size, capacity;
    bool failed;
};

void slc_neural_text_finish(struct slc_neural_text *text);

/** Writes the description and its NUL. `set` comes from slc_neural_plan. */
void slc_neural_describe(struct slc_neural_text *text, const SluiceNeuralSet *set,
                         const struct slc_neural_pieces *pieces);

#endif /* SLC_NEURAL_FILE_TEXT_H */
