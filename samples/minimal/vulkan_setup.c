#include "vulkan_setup.h"

#include <stdio.h>
#include <stdlib.h>

#include "room_frag.h" /* SPIR-V */
#include "room_vert.h"

#define PICTURE_FORMAT VK_FORMAT_R8G8B8A8_SRGB

void check(bool good, const char *what, const char *why)
{
    if (good)
        return;
    fprintf(stderr, "%s failed: %s\n", what, why);
    exit(1);
}

uint32_t find_devices(struct gpu *gpu, VkPhysicalDevice devices[16])
{
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application};
    VkResult result = vkCreateInstance(&info, NULL, &gpu->instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        fprintf(stderr, "there is no Vulkan driver\n");
        exit(77);
    }
    check(result == VK_SUCCESS, "vkCreateInstance", "is there a layer that cannot be loaded?");
    uint32_t count = 16;
    check(vkEnumeratePhysicalDevices(gpu->instance, &count, devices) >= 0, "looking for devices",
          "the driver does not say why");
    return count;
}

uint32_t find_queue_family(VkPhysicalDevice physical_device, VkQueueFlags flags)
{
    VkQueueFamilyProperties families[32];
    uint32_t count = 32;
    vkGetPhysicalDeviceQueueFamilyProperties(physical_device, &count, families);
    for (uint32_t i = 0; i < count; i++)
        if ((families[i].queueFlags & flags) == flags)
            return i;
    return UINT32_MAX;
}

void open_device(struct gpu *gpu, const VkPhysicalDeviceFeatures2 *features)
{
    const float priority = 1.0f;
    const uint32_t families[] = {gpu->family, gpu->sparse_family};
    VkDeviceQueueCreateInfo queues[2];
    for (int i = 0; i < 2; i++)
        queues[i] = (VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                              .queueFamilyIndex = families[i],
                                              .queueCount = 1,
                                              .pQueuePriorities = &priority};
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = features,
                               .queueCreateInfoCount = gpu->family == gpu->sparse_family ? 1 : 2,
                               .pQueueCreateInfos = queues};
    VK(vkCreateDevice(gpu->physical_device, &info, NULL, &gpu->device));
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    vkGetDeviceQueue(gpu->device, gpu->sparse_family, 0, &gpu->sparse_queue);
}

void close_device(const struct gpu *gpu)
{
    vkDestroyDevice(gpu->device, NULL);
    vkDestroyInstance(gpu->instance, NULL);
}

static VkDeviceMemory allocate(const struct gpu *gpu, VkMemoryRequirements needs,
                               VkMemoryPropertyFlags wanted)
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(gpu->physical_device, &memory);
    uint32_t type = 0;
    while (type < memory.memoryTypeCount &&
           (!(needs.memoryTypeBits >> type & 1) ||
            (memory.memoryTypes[type].propertyFlags & wanted) != wanted))
        type++;
    check(type < memory.memoryTypeCount, "allocating memory", "no type is right");
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                 .allocationSize = needs.size,
                                 .memoryTypeIndex = type};
    VkDeviceMemory allocated;
    VK(vkAllocateMemory(gpu->device, &info, NULL, &allocated));
    return allocated;
}

static void create_image(const struct gpu *gpu, struct picture *picture)
{
    VkImageCreateInfo image = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = PICTURE_FORMAT,
                               .extent = {picture->width, picture->height, 1},
                               .mipLevels = 1,
                               .arrayLayers = 1,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                        VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    VK(vkCreateImage(gpu->device, &image, NULL, &picture->image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(gpu->device, picture->image, &needs);
    picture->image_memory = allocate(gpu, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VK(vkBindImageMemory(gpu->device, picture->image, picture->image_memory, 0));
    VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = picture->image,
                                  .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                  .format = PICTURE_FORMAT,
                                  .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VK(vkCreateImageView(gpu->device, &view, NULL, &picture->view));
}

static void create_render_pass(const struct gpu *gpu, struct picture *picture)
{
    VkAttachmentDescription attachment = {.format = PICTURE_FORMAT,
                                          .samples = VK_SAMPLE_COUNT_1_BIT,
                                          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                          .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    VkAttachmentReference reference = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &reference};
    const VkPipelineStageFlags draw = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkPipelineStageFlags copy = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkAccessFlags written = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    const VkSubpassDependency dependencies[] = {
        {VK_SUBPASS_EXTERNAL, 0, draw | copy, draw, written, written, 0},
        {0, VK_SUBPASS_EXTERNAL, draw, copy, written, VK_ACCESS_TRANSFER_READ_BIT, 0}};
    VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                   .attachmentCount = 1,
                                   .pAttachments = &attachment,
                                   .subpassCount = 1,
                                   .pSubpasses = &subpass,
                                   .dependencyCount = 2,
                                   .pDependencies = dependencies};
    VK(vkCreateRenderPass(gpu->device, &info, NULL, &picture->render_pass));
    VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                           .renderPass = picture->render_pass,
                                           .attachmentCount = 1,
                                           .pAttachments = &picture->view,
                                           .width = picture->width,
                                           .height = picture->height,
                                           .layers = 1};
    VK(vkCreateFramebuffer(gpu->device, &framebuffer, NULL, &picture->framebuffer));
}

void create_picture(const struct gpu *gpu, uint32_t width, uint32_t height, struct picture *picture)
{
    *picture = (struct picture){.width = width, .height = height};
    create_image(gpu, picture);
    create_render_pass(gpu, picture);
    VkBufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                 .size = (VkDeviceSize)width * height * 4,
                                 .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VK(vkCreateBuffer(gpu->device, &buffer, NULL, &picture->buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(gpu->device, picture->buffer, &needs);
    picture->buffer_memory = allocate(
        gpu, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK(vkBindBufferMemory(gpu->device, picture->buffer, picture->buffer_memory, 0));
    VK(vkMapMemory(gpu->device, picture->buffer_memory, 0, VK_WHOLE_SIZE, 0,
                   (void **)&picture->texels));
}

void destroy_picture(const struct gpu *gpu, const struct picture *picture)
{
    vkDestroyFramebuffer(gpu->device, picture->framebuffer, NULL);
    vkDestroyRenderPass(gpu->device, picture->render_pass, NULL);
    vkDestroyImageView(gpu->device, picture->view, NULL);
    vkDestroyImage(gpu->device, picture->image, NULL);
    vkFreeMemory(gpu->device, picture->image_memory, NULL);
    vkDestroyBuffer(gpu->device, picture->buffer, NULL);
    vkFreeMemory(gpu->device, picture->buffer_memory, NULL);
}

void copy_picture(VkCommandBuffer commands, const struct picture *picture)
{
    VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                              .imageExtent = {picture->width, picture->height, 1}};
    vkCmdCopyImageToBuffer(commands, picture->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           picture->buffer, 1, &copy);
    VkMemoryBarrier to_host = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &to_host, 0, NULL, 0, NULL);
}

static VkDescriptorSetLayout create_set_layout(const struct gpu *gpu, uint32_t binding_count,
                                               const VkDescriptorSetLayoutBinding *bindings)
{
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = binding_count,
                                            .pBindings = bindings};
    VkDescriptorSetLayout layout;
    VK(vkCreateDescriptorSetLayout(gpu->device, &info, NULL, &layout));
    return layout;
}

static VkPipelineShaderStageCreateInfo
create_stage(const struct gpu *gpu, VkShaderStageFlagBits flags, const uint32_t *words, size_t size)
{
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = words};
    VkPipelineShaderStageCreateInfo stage = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = flags,
        .pName = "main"};
    VK(vkCreateShaderModule(gpu->device, &info, NULL, &stage.module));
    return stage;
}

static VkPipeline create_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                                  const struct picture *target, VkBool32 paged)
{
    VkPipelineShaderStageCreateInfo stages[2] = {
        create_stage(gpu, VK_SHADER_STAGE_VERTEX_BIT, room_vert, sizeof room_vert),
        create_stage(gpu, VK_SHADER_STAGE_FRAGMENT_BIT, room_frag, sizeof room_frag)};
    const VkSpecializationMapEntry constant = {0, 0, sizeof paged};
    const VkSpecializationInfo constants = {1, &constant, sizeof paged, &paged};
    stages[1].pSpecializationInfo = &constants;
    VkPipelineVertexInputStateCreateInfo vertices = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkViewport viewport = {0, 0, (float)target->width, (float)target->height, 0, 1};
    VkRect2D scissor = {.extent = {target->width, target->height}};
    VkPipelineViewportStateCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor};
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1.0f};
    VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineColorBlendAttachmentState attachment = {.colorWriteMask = 0xf};
    VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .stageCount = 2,
                                         .pStages = stages,
                                         .pVertexInputState = &vertices,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &view,
                                         .pRasterizationState = &raster,
                                         .pMultisampleState = &samples,
                                         .pColorBlendState = &blend,
                                         .layout = layout,
                                         .renderPass = target->render_pass};
    VkPipeline pipeline;
    VK(vkCreateGraphicsPipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline));
    for (int i = 0; i < 2; i++)
        vkDestroyShaderModule(gpu->device, stages[i].module, NULL);
    return pipeline;
}

static void create_set_layouts(const struct gpu *gpu, VkDescriptorSetLayout layouts[2])
{
    VkDescriptorSetLayoutBinding bindings[5]; /* as room.frag has them */
    for (uint32_t i = 0; i < 4; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                                     VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    bindings[4] = (VkDescriptorSetLayoutBinding){4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                                 PAGE_CHUNKS, VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    layouts[0] = create_set_layout(gpu, 5, bindings);
    const VkDescriptorSetLayoutBinding albedo = {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                                 VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    layouts[1] = create_set_layout(gpu, 1, &albedo);
}

/* What sample.glsl asks of a sampler: no bias of its own, all levels, the texture's address modes.
 */
static VkSampler create_sampler(const struct gpu *gpu)
{
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = VK_FILTER_LINEAR,
                                .minFilter = VK_FILTER_LINEAR,
                                .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                .maxLod = VK_LOD_CLAMP_NONE};
    VkSampler sampler;
    VK(vkCreateSampler(gpu->device, &info, NULL, &sampler));
    return sampler;
}

void create_drawing(const struct gpu *gpu, const struct picture *target, bool paged,
                    uint32_t constant_size, struct drawing *drawing)
{
    create_set_layouts(gpu, drawing->set_layouts);
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 64},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 64}};
    VkDescriptorPoolCreateInfo set_pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                           .maxSets = 16,
                                           .poolSizeCount = 2,
                                           .pPoolSizes = sizes};
    VK(vkCreateDescriptorPool(gpu->device, &set_pool, NULL, &drawing->set_pool));
    drawing->sampler = create_sampler(gpu);
    const VkPushConstantRange constants = {
        VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, constant_size};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 2,
                                         .pSetLayouts = drawing->set_layouts,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &constants};
    VK(vkCreatePipelineLayout(gpu->device, &layout, NULL, &drawing->layout));
    drawing->pipeline = create_pipeline(gpu, drawing->layout, target, paged);
    VkCommandPoolCreateInfo command_pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .flags =
                                                VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                            .queueFamilyIndex = gpu->family};
    VK(vkCreateCommandPool(gpu->device, &command_pool, NULL, &drawing->command_pool));
}

void destroy_drawing(const struct gpu *gpu, const struct drawing *drawing)
{
    vkDestroyCommandPool(gpu->device, drawing->command_pool, NULL);
    vkDestroyPipeline(gpu->device, drawing->pipeline, NULL);
    vkDestroyPipelineLayout(gpu->device, drawing->layout, NULL);
    vkDestroySampler(gpu->device, drawing->sampler, NULL);
    vkDestroyDescriptorPool(gpu->device, drawing->set_pool, NULL);
    for (int i = 0; i < 2; i++)
        vkDestroyDescriptorSetLayout(gpu->device, drawing->set_layouts[i], NULL);
}

VkDescriptorSet allocate_set(const struct gpu *gpu, const struct drawing *drawing, uint32_t index)
{
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = drawing->set_pool,
                                        .descriptorSetCount = 1,
                                        .pSetLayouts = &drawing->set_layouts[index]};
    VkDescriptorSet set;
    VK(vkAllocateDescriptorSets(gpu->device, &info, &set));
    return set;
}

VkCommandBuffer allocate_commands(const struct gpu *gpu, const struct drawing *drawing)
{
    VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                        .commandPool = drawing->command_pool,
                                        .commandBufferCount = 1};
    VkCommandBuffer commands;
    VK(vkAllocateCommandBuffers(gpu->device, &info, &commands));
    return commands;
}

void write_buffers(const struct gpu *gpu, VkDescriptorSet set, uint32_t count,
                   const VkBuffer *buffers)
{
    for (uint32_t i = 0; i < count; i++) {
        const VkDescriptorBufferInfo buffer = {buffers[i], 0, VK_WHOLE_SIZE};
        const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = set,
                                            .dstBinding = i,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                            .pBufferInfo = &buffer};
        vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
    }
}

void write_images(const struct gpu *gpu, VkDescriptorSet set, uint32_t binding, uint32_t count,
                  const VkImageView *views, VkSampler sampler)
{
    for (uint32_t i = 0; i < count; i++) {
        const VkDescriptorImageInfo image = {sampler, views[i], VK_IMAGE_LAYOUT_GENERAL};
        const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = set,
                                            .dstBinding = binding,
                                            .dstArrayElement = i,
                                            .descriptorCount = 1,
                                            .descriptorType =
                                                VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                            .pImageInfo = &image};
        vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
    }
}

void begin_drawing(VkCommandBuffer commands, const struct drawing *drawing,
                   const struct picture *target)
{
    const VkClearValue sky = {.color = {.float32 = {0.30f, 0.45f, 0.65f, 1.0f}}};
    VkRenderPassBeginInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                  .renderPass = target->render_pass,
                                  .framebuffer = target->framebuffer,
                                  .renderArea = {.extent = {target->width, target->height}},
                                  .clearValueCount = 1,
                                  .pClearValues = &sky};
    vkCmdBeginRenderPass(commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing->pipeline);
}
