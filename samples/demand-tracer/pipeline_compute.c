#include "pipeline_compute.h"

#include "trace_comp.h"

bool compute_pipeline_create(const struct gpu *gpu, VkPipelineLayout layout, bool preview,
                             bool needs, uint32_t scene_root, VkPipeline *pipeline)
{
    const uint32_t values[3] = {preview, needs, scene_root};
    const VkSpecializationMapEntry entries[3] = {
        {TRACER_CONSTANT_PREVIEW, 0, sizeof values[0]},
        {TRACER_CONSTANT_NEEDS, sizeof values[0], sizeof values[1]},
        {TRACER_CONSTANT_SCENE_ROOT, 2 * sizeof values[0], sizeof values[2]}};
    const VkSpecializationInfo constants = {3, entries, sizeof values, values};
    return gpu_create_compute_pipeline(gpu, layout, trace_comp, sizeof trace_comp, &constants,
                                       pipeline);
}

void compute_pipeline_record(VkPipeline pipeline, VkCommandBuffer commands, uint32_t pixel_count)
{
    const uint32_t row = TRACER_ROW_WIDTH / TRACER_GROUP_SIZE;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdDispatch(commands, row, (pixel_count + TRACER_ROW_WIDTH - 1) / TRACER_ROW_WIDTH, 1);
}
