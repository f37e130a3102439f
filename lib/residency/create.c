#include "residency/create.h"

#include "residency/nodes.h"

SluiceResult slc_machine_init(struct slc_machine *r, const SluiceAllocationCallbacks *cb,
                              const struct slc_machine_user *user, const SluiceHeapAllocator *heaps,
                              uint32_t heap_capacity, uint32_t tile_size)
{
    r->cb = cb;
    r->user = *user;
    SluiceResult result = slc_tile_heaps_init(&r->heaps, cb, heaps, heap_capacity, tile_size);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_reserve_nodes(r, 1))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    r->node_end = 1; /* index 0 stands for none */
    return SLUICE_SUCCESS;
}

void slc_machine_finish(struct slc_machine *r)
{
    slc_tile_heaps_finish(&r->heaps);
    slc_nodes_finish(r);
}
