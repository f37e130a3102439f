/** Allocation. All allocations of the library use these functions, which check counts of elements.
 */
#ifndef SLC_BASE_ALLOC_H
#define SLC_BASE_ALLOC_H

#include <sluice/base.h>

/** Returns the callbacks of `given`, or malloc and free for NULL. */
SluiceAllocationCallbacks slc_allocator(const SluiceAllocationCallbacks *given);

/** True if callbacks are NULL, or have both functions. */
bool slc_allocator_is_valid(const SluiceAllocationCallbacks *given);

/** Allocates `count` elements of `size` bytes at `alignment`, uninitialized. NULL if the size is 0
 * or overflows, or without memory. */
void *slc_alloc_aligned(const SluiceAllocationCallbacks *cb, size_t count, size_t size,
                        size_t alignment);

/** Allocates like slc_alloc_aligned, at the alignment of malloc. */
void *slc_alloc(const SluiceAllocationCallbacks *cb, size_t count, size_t size);

/** Allocates like slc_alloc, with all bytes 0. */
void *slc_calloc(const SluiceAllocationCallbacks *cb, size_t count, size_t size);

/** Frees memory. `count` and `size` as allocated. NULL is allowed. */
void slc_free(const SluiceAllocationCallbacks *cb, void *memory, size_t count, size_t size);

/**
 * Moves `old_count` elements to new memory for `new_count` >= old_count, and frees the old memory.
 * Returns NULL, with the old memory unchanged, on failure.
 */
void *slc_regrow(const SluiceAllocationCallbacks *cb, void *memory, size_t old_count,
                 size_t new_count, size_t size);

/** Copies a string. Free the copy with slc_free(cb, s, strlen(s) + 1, 1). */
char *slc_strdup(const SluiceAllocationCallbacks *cb, const char *string);

#endif /* SLC_BASE_ALLOC_H */
