#include "gpu.h"

#include <stdio.h>
#include <stdlib.h>

void check(bool good, const char *what)
{
    if (!good) {
        fprintf(stderr, "%s failed\n", what);
        exit(1);
    }
}

static void print_message(void *pUserData, SluiceLogSeverity severity, const char *pMessage)
{
    (void)pUserData, (void)severity;
    fprintf(stderr, "%s\n", pMessage);
}
const SluiceLogCallback log_callback = {NULL, print_message};

static bool choose_family(struct gpu *gpu, VkQueueFlags queue_flags)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(gpu->physical_device, &count, families);
    for (gpu->family = 0; gpu->family < count; gpu->family++)
        if ((families[gpu->family].queueFlags & queue_flags) == queue_flags)
            return true;
    return false;
}

static bool choose_device(struct gpu *gpu, VkQueueFlags queue_flags, device_test *test,
                          VkPhysicalDeviceFeatures *features,
                          VkPhysicalDeviceVulkan12Features *vulkan12)
{
    VkPhysicalDevice devices[16];
    uint32_t count = 16;
    if (vkEnumeratePhysicalDevices(gpu->instance, &count, devices) < 0)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        gpu->physical_device = devices[i];
        if (choose_family(gpu, queue_flags) && test(gpu->instance, devices[i], features, vulkan12))
            return true;
    }
    return false;
}

static void create_commands(struct gpu *gpu)
{
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                    .queueFamilyIndex = gpu->family};
    VK(vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->command_pool));
    VkCommandBufferAllocateInfo buffers = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = gpu->command_pool,
                                           .commandBufferCount = 1};
    VK(vkAllocateCommandBuffers(gpu->device, &buffers, &gpu->commands));
}

void create_gpu(struct gpu *gpu, VkQueueFlags queue_flags, device_test *test)
{
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                     .pApplicationInfo = &application};
    VK(vkCreateInstance(&instance, NULL, &gpu->instance));

    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &vulkan12};
    if (!choose_device(gpu, queue_flags, test, &features.features, &vulkan12))
        exit(77);
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                     .queueFamilyIndex = gpu->family,
                                     .queueCount = 1,
                                     .pQueuePriorities = &priority};
    VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                 .pNext = &features,
                                 .queueCreateInfoCount = 1,
                                 .pQueueCreateInfos = &queue};
    VK(vkCreateDevice(gpu->physical_device, &device, NULL, &gpu->device));
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    create_commands(gpu);
}

void destroy_gpu(const struct gpu *gpu)
{
    vkDestroyPipeline(gpu->device, gpu->pipeline, NULL);
    vkDestroyPipelineLayout(gpu->device, gpu->pipeline_layout, NULL);
    vkDestroyDescriptorPool(gpu->device, gpu->set_pool, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, gpu->set_layout, NULL);
    vkDestroyBuffer(gpu->device, gpu->answer_buffer, NULL);
    vkFreeMemory(gpu->device, gpu->answer_memory, NULL);
    vkDestroyCommandPool(gpu->device, gpu->command_pool, NULL);
    vkDestroyDevice(gpu->device, NULL);
    vkDestroyInstance(gpu->instance, NULL);
}

static uint32_t find_host_memory(const struct gpu *gpu, uint32_t type_bits)
{
    const VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(gpu->physical_device, &memory);
    for (uint32_t i = 0; i < memory.memoryTypeCount; i++)
        if ((type_bits >> i & 1) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted)
            return i;
    check(false, "finding host memory");
    return 0;
}

static void create_set(struct gpu *gpu)
{
    const VkDescriptorSetLayoutBinding binding = {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                                  VK_SHADER_STAGE_COMPUTE_BIT, NULL};
    VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings = &binding};
    VK(vkCreateDescriptorSetLayout(gpu->device, &layout, NULL, &gpu->set_layout));
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1,
                                       .poolSizeCount = 1,
                                       .pPoolSizes = &size};
    VK(vkCreateDescriptorPool(gpu->device, &pool, NULL, &gpu->set_pool));
    VkDescriptorSetAllocateInfo set = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                       .descriptorPool = gpu->set_pool,
                                       .descriptorSetCount = 1,
                                       .pSetLayouts = &gpu->set_layout};
    VK(vkAllocateDescriptorSets(gpu->device, &set, &gpu->set));
    const VkDescriptorBufferInfo buffer = {gpu->answer_buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = gpu->set,
                                        .descriptorCount = 1,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = &buffer};
    vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
}

void *create_answer(struct gpu *gpu, size_t size)
{
    VkBufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                 .size = size,
                                 .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    VK(vkCreateBuffer(gpu->device, &buffer, NULL, &gpu->answer_buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(gpu->device, gpu->answer_buffer, &needs);
    VkMemoryAllocateInfo memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                   .allocationSize = needs.size,
                                   .memoryTypeIndex = find_host_memory(gpu, needs.memoryTypeBits)};
    VK(vkAllocateMemory(gpu->device, &memory, NULL, &gpu->answer_memory));
    VK(vkBindBufferMemory(gpu->device, gpu->answer_buffer, gpu->answer_memory, 0));
    void *answer;
    VK(vkMapMemory(gpu->device, gpu->answer_memory, 0, VK_WHOLE_SIZE, 0, &answer));
    create_set(gpu);
    return answer;
}

void create_pipeline(struct gpu *gpu, const uint32_t *code, size_t code_size,
                     VkDescriptorSetLayout set_0, uint32_t constants_size)
{
    const VkDescriptorSetLayout sets[] = {set_0, gpu->set_layout};
    const VkPushConstantRange constants = {VK_SHADER_STAGE_COMPUTE_BIT, 0, constants_size};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 2,
                                         .pSetLayouts = sets,
                                         .pushConstantRangeCount = constants_size > 0,
                                         .pPushConstantRanges = &constants};
    VK(vkCreatePipelineLayout(gpu->device, &layout, NULL, &gpu->pipeline_layout));
    VkShaderModuleCreateInfo shader = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = code_size, .pCode = code};
    VkShaderModule module;
    VK(vkCreateShaderModule(gpu->device, &shader, NULL, &module));
    VkComputePipelineCreateInfo pipeline = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main"},
        .layout = gpu->pipeline_layout};
    VK(vkCreateComputePipelines(gpu->device, VK_NULL_HANDLE, 1, &pipeline, NULL, &gpu->pipeline));
    vkDestroyShaderModule(gpu->device, module, NULL);
}

void begin_commands(const struct gpu *gpu)
{
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK(vkBeginCommandBuffer(gpu->commands, &begin));
}

void bind_shader(const struct gpu *gpu, VkDescriptorSet set_0)
{
    const VkDescriptorSet sets[] = {set_0, gpu->set};
    vkCmdBindPipeline(gpu->commands, VK_PIPELINE_BIND_POINT_COMPUTE, gpu->pipeline);
    vkCmdBindDescriptorSets(gpu->commands, VK_PIPELINE_BIND_POINT_COMPUTE, gpu->pipeline_layout, 0,
                            2, sets, 0, NULL);
}

void submit(const struct gpu *gpu, VkSemaphore semaphore, uint64_t value)
{
    VkMemoryBarrier to_host = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(gpu->commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                         VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, NULL, 0, NULL);
    VK(vkEndCommandBuffer(gpu->commands));

    VkTimelineSemaphoreSubmitInfo values = {.sType =
                                                VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                            .signalSemaphoreValueCount = 1,
                                            .pSignalSemaphoreValues = &value};
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .pNext = &values,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &gpu->commands,
                         .signalSemaphoreCount = 1,
                         .pSignalSemaphores = &semaphore};
    VK(vkQueueSubmit(gpu->queue, 1, &info, VK_NULL_HANDLE));
}
