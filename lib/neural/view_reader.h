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

/** Reads a part of a view. Compares no checksum. */
SluiceResult slc_neural_read_view_part(const SluiceNeuralSet *set,
                                       const struct slc_neural_view *view, uint64_t offset,
                                       size_t size, void *bytes);

/** Compares the checksum of a view, if it has one, in 64 KiB of memory. */
SluiceResult slc_neural_verify_view(const SluiceNeuralSet *set, const struct slc_neural_view *view);

#endif /* SLC_NEURAL_VIEW_READER_H */
