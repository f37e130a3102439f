/** Memory of the C library. */
#ifndef SLC_PLATFORM_HOST_MEMORY_H
#define SLC_PLATFORM_HOST_MEMORY_H

#include <stddef.h>

/** `alignment` is a power of two. NULL: there is none. */
void *slc_host_allocate(size_t size, size_t alignment);
/** Frees memory of slc_host_allocate, whatever its alignment is. */
void slc_host_free(void *memory);

#endif /* SLC_PLATFORM_HOST_MEMORY_H */
