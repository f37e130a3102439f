/** Image sources whose reads fail, to imitate a broken disk. */
#ifndef SLUICE_VIEW_FAULT_SOURCE_H
#define SLUICE_VIEW_FAULT_SOURCE_H

#include <sluice/image.h>

#include <stdatomic.h>

/**
 * Creates a source that wraps `inner`, which is borrowed. Reads of 1 region in `*one_in` fail with
 * SLUICE_ERROR_IO; 0: none. Each run fails in the same regions. `*one_in` may change at any time,
 * and must outlive the source. Any thread.
 */
SluiceResult fault_source_create(const atomic_uint *one_in, SluiceImageSource *inner,
                                 SluiceImageSource **source);

#endif /* SLUICE_VIEW_FAULT_SOURCE_H */
