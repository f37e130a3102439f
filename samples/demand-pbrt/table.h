/** A growing array that the host writes and shaders read. */
#ifndef DEMAND_PBRT_TABLE_H
#define DEMAND_PBRT_TABLE_H

#include "../../tools/common/gpu.h"

/** Zeroed, except `element`, is empty. */
struct table {
    uint32_t element; ///< bytes
    uint32_t count, capacity;
    uint32_t generation; ///< changes with the buffer
    struct gpu_buffer buffer;
};

/** Makes room for `count` elements in all. New ones are zero. Call only while no launch is running.
 * Reports errors on stderr. */
bool table_grow(const struct gpu *gpu, struct table *table, uint32_t count);
void table_finish(const struct gpu *gpu, struct table *table);

static inline void *table_at(const struct table *table, uint32_t index)
{
    return (char *)table->buffer.mapped + (size_t)index * table->element;
}

#endif /* DEMAND_PBRT_TABLE_H */
