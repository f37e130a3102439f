/** Reader of views: inflates and checks bytes. */
#ifndef SLC_NEURAL_VIEW_READER_H
#define SLC_NEURAL_VIEW_READER_H

#include "neural/neural_set.h"

/**
 * Reads all bytes of a view, view->size of them, and compares its checksum.
 * Errors, logged: CORRUPT_DATA; IO; not logged: OUT_OF_HOST_MEMORY. NOT_READY: from the input.
 * Thread safety: any thread.
 */
SluiceResult slc_neural_read_view(const SluiceNeuralSet *set, const struct slc_neural_view *view,
                                  void *bytes);

/** Reader of parts of a view. Takes at most 192 KiB of memory for any size of view, for the last
 * inflated tile. */
struct slc_neural_view_reader {
    const SluiceNeuralSet *set;
    const struct slc_neural_view *view;
    uint8_t *stored, *tile;      ///< one block of memory; NULL: the view is not compressed
    uint32_t tile_count, number; ///< number: the tile in `tile`; UINT32_MAX: none
};

/** Opens a view. Errors: slc_neural_read_view's. */
SluiceResult slc_neural_open_view(const SluiceNeuralSet *set, const struct slc_neural_view *view,
                                  struct slc_neural_view_reader *reader);
/** Closes a view. Call it also after an error of slc_neural_open_view. */
void slc_neural_close_view(struct slc_neural_view_reader *reader);

/** Reads a part, without checksum. Parts in rising order inflate each tile once. */
SluiceResult slc_neural_read_view_part(struct slc_neural_view_reader *reader, uint64_t offset,
                                       size_t size, void *bytes);

/** Verifies the checksum of a view, if present, with at most 256 KiB of memory. */
SluiceResult slc_neural_verify_view(const SluiceNeuralSet *set, const struct slc_neural_view *view);

#endif /* SLC_NEURAL_VIEW_READER_H */
