/** Parts of a traced scene that depend on the device alone. A thread can make them ahead. */
#ifndef SLUICE_VIEW_TRACED_PARTS_H
#define SLUICE_VIEW_TRACED_PARTS_H

#include "traced_show.h"
#include "traced_view.h"

#include "../../samples/demand-pbrt/tracing.h"

#include <stdatomic.h>

/** Zeroed is empty. */
struct traced_parts {
    const struct gpu *gpu; ///< borrowed
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    struct tracing tracing; ///< its programs take about a second to compile
    struct traced_view view;
    struct traced_show show;
    uint32_t threads;         ///< threads of the loader
    atomic_uint failed_reads; ///< reads that failed and are not retried
};

/** Creates a loader, and compiles the programs for rays. Any thread: the queue is not used. NULL,
 *  with a line on stderr, on failure. */
struct traced_parts *traced_parts_create(const struct gpu *gpu, uint32_t threads);
/** Destroys the parts. The device must not use them. Call traced_parts_destroy_loader first if
 *  images of the loader are freed in between. NULL is allowed. */
void traced_parts_destroy(struct traced_parts *parts);
void traced_parts_destroy_loader(struct traced_parts *parts);

/** Creates parts on a thread of its own. */
struct traced_parts_load;

/** NULL without memory or a thread. */
struct traced_parts_load *traced_parts_begin(const struct gpu *gpu, uint32_t threads);
/** Returns true if traced_parts_end would return without a wait. */
bool traced_parts_done(const struct traced_parts_load *load);
/** Waits for the thread, and frees the load. Returns the parts; NULL on error. */
struct traced_parts *traced_parts_end(struct traced_parts_load *load);

#endif /* SLUICE_VIEW_TRACED_PARTS_H */
