/** Memory of the C library. */
#ifndef SLC_PLATFORM_HOST_MEMORY_H
#define SLC_PLATFORM_HOST_MEMORY_H

#include <stddef.h>

/** Allocates memory. `alignment`: a power of two. NULL: out of memory. */
void *slc_host_allocate(size_t size, size_t alignment);
/** Frees memory of slc_host_allocate with any alignment. */
void slc_host_free(void *memory);

#endif /* SLC_PLATFORM_HOST_MEMORY_H */
