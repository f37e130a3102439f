#include "refused_memory.h"

#include <stddef.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);

static uint64_t calls_left = UINT64_MAX, calls_made;

uint64_t refuse_memory_after(uint64_t calls)
{
    uint64_t made = calls_made;
    calls_left = calls;
    calls_made = 0;
    return made;
}

static int is_refused(void)
{
    calls_made++;
    if (calls_left == 0)
        return 1;
    calls_left -= calls_left != UINT64_MAX;
    return 0;
}

void *__wrap_malloc(size_t size)
{
    return is_refused() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return is_refused() ? NULL : __real_calloc(count, size);
}
