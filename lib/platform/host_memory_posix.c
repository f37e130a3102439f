#include "platform/host_memory.h"

#include <stdint.h>
#include <stdlib.h>

void *slc_host_allocate(size_t size, size_t alignment)
{
    if (alignment <= _Alignof(max_align_t))
        return malloc(size);
    if (size > SIZE_MAX - (alignment - 1))
        return NULL;
    return aligned_alloc(alignment, (size + alignment - 1) & ~(alignment - 1));
}

void slc_host_free(void *memory)
{
    free(memory);
}
