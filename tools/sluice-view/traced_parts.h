/** What a traced scene needs of the device and does not depend on the scene: a thread can make it.
 */
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
    uint32_t threads;         ///< of the loader
    atomic_uint failed_reads; ///< reads that are not tried again
};

/** Creates a loader, and compiles the programs for rays. Any thread: the queue is not used. NULL on
 *  error, which stderr says. */
struct traced_parts *traced_parts_create(const struct gpu *gpu, uint32_t threads);
/** Nothing of it is in use on the device. Call traced_parts_destroy_loader first if images of the
 *  loader are freed in between. NULL is allowed. */
void traced_parts_destroy(struct traced_parts *parts);
void traced_parts_destroy_loader(struct traced_parts *parts);

#endif /* SLUICE_VIEW_TRACED_PARTS_H */
