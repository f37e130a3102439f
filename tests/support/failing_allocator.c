#include "support/failing_allocator.h"

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

/* Precedes every block, to detect a wrong size in free. */
struct header {
    size_t size;
    void *base;
};

static void *allocate(void *user, size_t size, size_t alignment)
{
    struct failing_allocator *a = user;
    assert_true(size > 0 && alignment > 0 && (alignment & (alignment - 1)) == 0);
    uint64_t call = a->calls++;
    if (call >= a->refuse_from && (!a->refuse_count || call - a->refuse_from < a->refuse_count))
        return NULL;
    char *base = malloc(size + alignment + sizeof(struct header));
    if (!base)
        return NULL;
    uintptr_t place = (uintptr_t)(base + sizeof(struct header));
    place = (place + alignment - 1) & ~(uintptr_t)(alignment - 1);
    struct header header = {size, base};
    memcpy((char *)place - sizeof header, &header, sizeof header);
    memset((void *)place, 0xA5, size); /* nobody may count on zeros */
    a->live_bytes += size;
    a->live_count++;
    return (void *)place;
}

static void release(void *user, void *memory, size_t size)
{
    struct failing_allocator *a = user;
    struct header header;
    memcpy(&header, (char *)memory - sizeof header, sizeof header);
    assert_int_equal(size, header.size);
    a->live_bytes -= size;
    a->live_count--;
    free(header.base);
}

void failing_allocator_init(struct failing_allocator *allocator, uint64_t refuse_from)
{
    *allocator = (struct failing_allocator){.refuse_from = refuse_from};
    allocator->callbacks = (SluiceAllocationCallbacks){allocator, allocate, release};
}
