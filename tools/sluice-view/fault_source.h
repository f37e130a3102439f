/** Image sources whose reads fail, to try what a broken disk does. */
#ifndef SLUICE_VIEW_FAULT_SOURCE_H
#define SLUICE_VIEW_FAULT_SOURCE_H

#include <sluice/image.h>

#include <stdatomic.h>

/**
 * Wraps `inner`, which is borrowed. Reads of one region in `*one_in` fail with SLUICE_ERROR_IO, the
 * same ones in each run; 0: none. It may change at any time, and outlives the source. Any thread.
 */
SluiceResult fault_source_create(const atomic_uint *one_in, SluiceImageSource *inner,
                                 SluiceImageSource **source);

#endif /* SLUICE_VIEW_FAULT_SOURCE_H */
