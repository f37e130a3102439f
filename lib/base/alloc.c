#include "base/alloc.h"

#include "base/checked.h"
#include "platform/host_memory.h"

#include <string.h>

static void *default_allocate(void *user, size_t size, size_t alignment)
{
    (void)user;
    return slc_host_allocate(size, alignment);
}

static void default_free(void *user, void *memory, size_t size)
{
    (void)user;
    (void)size;
    slc_host_free(memory);
}

SluiceAllocationCallbacks slc_allocator(const SluiceAllocationCallbacks *given)
{
    if (given)
        return *given;
    return (SluiceAllocationCallbacks){NULL, default_allocate, default_free};
}

bool slc_allocator_is_valid(const SluiceAllocationCallbacks *given)
{
    return !given || (given->pfnAllocate && given->pfnFree);
}

void *slc_alloc_aligned(const SluiceAllocationCallbacks *cb, size_t count, size_t size,
                        size_t alignment)
{
    size_t bytes;
    if (!slc_mul_size(count, size, &bytes) || bytes == 0)
        return NULL;
    return cb->pfnAllocate(cb->pUserData, bytes, alignment);
}

void *slc_alloc(const SluiceAllocationCallbacks *cb, size_t count, size_t size)
{
    return slc_alloc_aligned(cb, count, size, _Alignof(max_align_t));
}

void *slc_calloc(const SluiceAllocationCallbacks *cb, size_t count, size_t size)
{
    void *memory = slc_alloc(cb, count, size);
    if (memory)
        memset(memory, 0, count * size);
    return memory;
}

void slc_free(const SluiceAllocationCallbacks *cb, void *memory, size_t count, size_t size)
{
    if (memory)
        cb->pfnFree(cb->pUserData, memory, count * size);
}

void *slc_regrow(const SluiceAllocationCallbacks *cb, void *memory, size_t old_count,
                 size_t new_count, size_t size)
{
    void *bigger = slc_alloc(cb, new_count, size);
    if (!bigger)
        return NULL;
    if (memory) {
        memcpy(bigger, memory, old_count * size);
        slc_free(cb, memory, old_count, size);
    }
    return bigger;
}

char *slc_strdup(const SluiceAllocationCallbacks *cb, const char *string)
{
    size_t size = strlen(string) + 1;
    char *copy = slc_alloc(cb, size, 1);
    if (copy)
        memcpy(copy, string, size);
    return copy;
}
