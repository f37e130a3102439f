/** Every allocation of the library goes through here: counts of elements, checked in one place. */
#ifndef SLC_BASE_ALLOC_H
#define SLC_BASE_ALLOC_H

#include <sluice/base.h>

/** The callbacks of `given`, or malloc and free for NULL. */
SluiceAllocationCallbacks slc_allocator(const SluiceAllocationCallbacks *given);

/** NULL is fine; otherwise both functions must be there. */
bool slc_allocator_is_valid(const SluiceAllocationCallbacks *given);

/** `count` elements of `size` bytes at `alignment`, uninitialized; NULL if that is 0 bytes,
 *  overflows or there is no memory. */
void *slc_alloc_aligned(const SluiceAllocationCallbacks *cb, size_t count, size_t size,
                        size_t alignment);

/** The same at the alignment of malloc. */
void *slc_alloc(const SluiceAllocationCallbacks *cb, size_t count, size_t size);

/** The same, all bytes 0. */
void *slc_calloc(const SluiceAllocationCallbacks *cb, size_t count, size_t size);

/** `count` and `size` as they were allocated. NULL is allowed. */
void slc_free(const SluiceAllocationCallbacks *cb, void *memory, size_t count, size_t size);

/**
 * Moves `old_count` elements into room for `new_count` >= old_count and frees the old room. On
 * failure returns NULL and the old memory stays as it was.
 */
void *slc_regrow(const SluiceAllocationCallbacks *cb, void *memory, size_t old_count,
                 size_t new_count, size_t size);

/** A copy of the string, to be freed with slc_free(cb, s, strlen(s) + 1, 1). */
char *slc_strdup(const SluiceAllocationCallbacks *cb, const char *string);

#endif /* SLC_BASE_ALLOC_H */
