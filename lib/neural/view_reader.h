/** Reads the bytes of views, inflated and checked. */
#ifndef SLC_NEURAL_VIEW_READER_H
#define SLC_NEURAL_VIEW_READER_H

#include "neural/neural_set.h"

/**
 * Reads all bytes of a view, view->size of them, and compares its checksum.
 * Errors, logged: CORRUPT_DATA; IO; not logged: OUT_OF_HOST_MEMORY. NOT_READY as inputs have it.
 * Thread safety: any thread.
 */
SluiceResult slc_neural_read_view(const SluiceNeuralSet *set, const struct slc_neural_view *view,
                                  void *bytes);

/** Reads parts of a view one after the other. Has memory of at most 192 KiB, whatever the view's
 * size: the last tile that was inflated. */
struct slc_neural_view_reader {
    const SluiceNeuralSet *set;
    const struct slc_neural_view *view;
    uint8_t *stored, *tile;      ///< one block of memory; NULL: the view is not compressed
    uint32_t tile_count, number; ///< of the tile that `tile` holds; UINT32_MAX: none
};

/** Errors: as above. */
SluiceResult slc_neural_open_view(const SluiceNeuralSet *set, const struct slc_neural_view *view,
                                  struct slc_neural_view_reader *reader);
/** Also after an error of slc_neural_open_view. */
void slc_neural_close_view(struct slc_neural_view_reader *reader);

/** Reads a part. Compares no checksum. Parts in rising order inflate each tile once. */
SluiceResult slc_neural_read_view_part(struct slc_neural_view_reader *reader, uint64_t offset,
                                       size_t size, void *bytes);

/** Compares the checksum of a view, if it has one, in at most 256 KiB of memory. */
SluiceResult slc_neural_verify_view(const SluiceNeuralSet *set, const struct slc_neural_view *view);

#endif /* SLC_NEURAL_VIEW_READER_H */
