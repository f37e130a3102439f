#include "traced_show.h"

#include "../../samples/common/one_time.h"

#include "traced_show_comp.h"

#define GROUP 8u

struct push {
    uint32_t width, height;
    float scale, tint;
    uint32_t marks;
};

static bool create_layouts(struct traced_show *s)
{
    VkDescriptorSetLayoutBinding bindings[3];
    for (uint32_t i = 0; i < 3; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){.binding = i,
                                                     .descriptorType =
                                                         i < 2 ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                               : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                                     .descriptorCount = 1,
                                                     .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    const VkDescriptorSetLayoutCreateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 3,
        .pBindings = bindings};
    if (!gpu_check(vkCreateDescriptorSetLayout(s->gpu->device, &set, NULL, &s->set_layout),
                   "vkCreateDescriptorSetLayout"))
        return false;
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct push)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &s->set_layout,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &push};
    return gpu_check(vkCreatePipelineLayout(s->gpu->device, &layout, NULL, &s->layout),
                     "vkCreatePipelineLayout");
}

static bool create_set(struct traced_show *s)
{
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    if (!gpu_check(vkCreateDescriptorPool(s->gpu->device, &pool, NULL, &s->pool),
                   "vkCreateDescriptorPool"))
        return false;
    const VkDescriptorSetAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = s->pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &s->set_layout};
    return gpu_check(vkAllocateDescriptorSets(s->gpu->device, &info, &s->set),
                     "vkAllocateDescriptorSets");
}

bool traced_show_create(const struct gpu *gpu, struct traced_show *s)
{
    *s = (struct traced_show){.gpu = gpu};
    return create_layouts(s) && create_set(s) &&
           gpu_create_compute_pipeline(gpu, s->layout, traced_show_comp, sizeof traced_show_comp,
                                       NULL, &s->pipeline);
}

void traced_show_destroy(struct traced_show *s)
{
    if (!s->gpu)
        return;
    gpu_destroy_image(s->gpu, &s->image);
    vkDestroyPipeline(s->gpu->device, s->pipeline, NULL);
    vkDestroyDescriptorPool(s->gpu->device, s->pool, NULL);
    vkDestroyPipelineLayout(s->gpu->device, s->layout, NULL);
    vkDestroyDescriptorSetLayout(s->gpu->device, s->set_layout, NULL);
    *s = (struct traced_show){0};
}

static void write_set(const struct traced_show *s, const struct film *film)
{
    const VkDescriptorBufferInfo buffers[2] = {{film->sums.buffer, 0, VK_WHOLE_SIZE},
                                               {film->latest.buffer, 0, VK_WHOLE_SIZE}};
    const VkDescriptorImageInfo image = {.imageView = s->image.view,
                                         .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    const VkWriteDescriptorSet writes[2] = {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                             .dstSet = s->set,
                                             .descriptorCount = 2,
                                             .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                             .pBufferInfo = buffers},
                                            {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                             .dstSet = s->set,
                                             .dstBinding = 2,
                                             .descriptorCount = 1,
                                             .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                             .pImageInfo = &image}};
    vkUpdateDescriptorSets(s->gpu->device, 2, writes, 0, NULL);
}

bool traced_show_fit(struct traced_show *s, const struct film *film)
{
    gpu_destroy_image(s->gpu, &s->image);
    s->image = (struct gpu_image){0};
    s->drawn = false;
    s->width = film->width;
    s->height = film->height;
    if (!gpu_create_image(s->gpu, VK_FORMAT_R8G8B8A8_UNORM, s->width, s->height,
                          VK_SAMPLE_COUNT_1_BIT,
                          VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                          VK_IMAGE_ASPECT_COLOR_BIT, &s->image))
        return false;
    write_set(s, film);
    return true;
}

static void move_image(const struct traced_show *s, VkCommandBuffer commands, bool to_shader)
{
    const VkImageLayout before =
        s->drawn ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED;
    const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    const VkPipelineStageFlags fragment = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = to_shader ? VK_ACCESS_SHADER_WRITE_BIT : 0,
        .dstAccessMask = to_shader ? VK_ACCESS_SHADER_READ_BIT : VK_ACCESS_SHADER_WRITE_BIT,
        .oldLayout = to_shader ? VK_IMAGE_LAYOUT_GENERAL : before,
        .newLayout = to_shader ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_GENERAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = s->image.image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands, to_shader ? compute : fragment, to_shader ? fragment : compute,
                         0, 0, NULL, 0, NULL, 1, &barrier);
}

static void record(void *user_data, VkCommandBuffer commands)
{
    struct traced_show *s = user_data;
    const struct push push = {s->width, s->height, s->scale, s->tint, s->marks};
    move_image(s, commands, false);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, s->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, s->layout, 0, 1, &s->set, 0,
                            NULL);
    vkCmdPushConstants(commands, s->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
    vkCmdDispatch(commands, (s->width + GROUP - 1) / GROUP, (s->height + GROUP - 1) / GROUP, 1);
    move_image(s, commands, true);
}

bool traced_show_draw(struct traced_show *s, float scale, float tint)
{
    s->scale = scale;
    s->tint = tint;
    s->marks = tint > 0;
    if (!one_time_run(s->gpu, record, s))
        return false;
    s->drawn = true;
    return true;
}
