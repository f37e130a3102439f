/** A pass after the rays that writes resident and wanted level of each pixel of a traced scene. */
#ifndef SLUICE_VIEW_TRACED_VIEW_H
#define SLUICE_VIEW_TRACED_VIEW_H

#include "../../samples/common/film.h"

#include <sluice/demand.h>

#include "traced_shared.h"

/** Zeroed is empty. */
struct traced_view {
    const struct gpu *gpu; ///< borrowed
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    struct gpu_buffer probes; ///< PbrtProbe of each pixel, which rays write
    struct gpu_buffer views;  ///< TracedView of each pixel, mapped
    uint32_t count;           ///< pixels
};

/** False, with a line on stderr, on failure. */
bool traced_view_create(const struct gpu *gpu, const SluiceDemandLoader *loader,
                        struct traced_view *view);
void traced_view_destroy(struct traced_view *view);
/** Creates buffers as large as a film. No launch may be in flight. */
bool traced_view_fit(struct traced_view *view, const struct film *film);
/** Records the pass into a launch, after its rays. The host sees `views` when the launch ends. */
void traced_view_record(const struct traced_view *view, VkCommandBuffer commands,
                        VkDescriptorSet demand_set);

#endif /* SLUICE_VIEW_TRACED_VIEW_H */
