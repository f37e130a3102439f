#include "platform/host_memory.h"

#include <malloc.h>

/* Allocates with _aligned_malloc for every alignment, because free() cannot free such memory. */
void *slc_host_allocate(size_t size, size_t alignment)
{
    size_t least = _Alignof(max_align_t);
    return _aligned_malloc(size, alignment > least ? alignment : least);
}

void slc_host_free(void *memory)
{
    _aligned_free(memory);
}
