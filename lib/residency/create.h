/** Creation and destruction of a residency machine. */
#ifndef SLC_RESIDENCY_CREATE_H
#define SLC_RESIDENCY_CREATE_H

#include "residency/machine.h"

/**
 * Makes a machine from a zeroed struct. The caller sets the limits. Call slc_machine_finish after
 * an error, too. Errors: OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_machine_init(struct slc_machine *r, const SluiceAllocationCallbacks *cb,
                              const struct slc_machine_user *user, const SluiceHeapAllocator *heaps,
                              uint32_t heap_capacity, uint32_t tile_size);
/** Releases every heap. A zeroed struct is fine. */
void slc_machine_finish(struct slc_machine *r);

#endif /* SLC_RESIDENCY_CREATE_H */
