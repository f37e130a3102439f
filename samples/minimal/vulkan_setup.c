#include "vulkan_setup.h"

#include "../../tools/common/no_vulkan.h"

#include <stdio.h>
#include <stdlib.h>

#define PICTURE_FORMAT VK_FORMAT_R8G8B8A8_SRGB
#define MAX_DEVICES 16

void check(bool good, const char *what, const char *why)
{
    if (good)
        return;
    fprintf(stderr, "%s failed: %s\n", what, why);
    exit(1);
}

void check_vulkan(VkResult result, const char *call)
{
    char why[32];
    snprintf(why, sizeof why, "VkResult %d", result);
    check(result == VK_SUCCESS, call, why);
}

static void create_instance(struct gpu *gpu)
{
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .apiVersion = VK_API_VERSION_1_2};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pApplicationInfo = &application};
    const VkResult result = vkCreateInstance(&info, NULL, &gpu->instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        fprintf(stderr, "%s\n", NO_VULKAN_DRIVER);
        exit(77);
    }
    check_vulkan(result, "vkCreateInstance");
}

/* Returns a queue family that draws and computes, or VK_QUEUE_FAMILY_IGNORED. */
static uint32_t find_drawing_family(VkPhysicalDevice physical_device)
{
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    VkQueueFamilyProperties families[32];
    uint32_t count = 32;
    vkGetPhysicalDeviceQueueFamilyProperties(physical_device, &count, families);
    for (uint32_t i = 0; i < count; i++)
        if ((families[i].queueFlags & wanted) == wanted)
            return i;
    return VK_QUEUE_FAMILY_IGNORED;
}

/* Returns false if the device lacks a feature. */
static bool create_device(struct gpu *gpu, const struct device_needs *needs)
{
    VkPhysicalDeviceVulkan12Features vulkan12 = needs->vulkan12;
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    const VkPhysicalDeviceFeatures2 features = {.sType =
                                                    VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                                .pNext = &vulkan12,
                                                .features = needs->features};
    const float priority = 1.0f;
    const uint32_t families[] = {gpu->family, gpu->sparse_family};
    VkDeviceQueueCreateInfo queues[2];
    for (int i = 0; i < 2; i++)
        queues[i] = (VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                              .queueFamilyIndex = families[i],
                                              .queueCount = 1,
                                              .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount =
                                         gpu->family == gpu->sparse_family ? 1 : 2,
                                     .pQueueCreateInfos = queues};
    const VkResult result = vkCreateDevice(gpu->physical_device, &info, NULL, &gpu->device);
    if (result == VK_ERROR_FEATURE_NOT_PRESENT)
        return false;
    check_vulkan(result, "vkCreateDevice");
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    vkGetDeviceQueue(gpu->device, gpu->sparse_family, 0, &gpu->sparse_queue);
    return true;
}

void open_device(struct gpu *gpu, device_test *test, const void *user)
{
    create_instance(gpu);
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t count = MAX_DEVICES;
    const VkResult result = vkEnumeratePhysicalDevices(gpu->instance, &count, devices);
    check_vulkan(result == VK_INCOMPLETE ? VK_SUCCESS : result, "vkEnumeratePhysicalDevices");
    for (uint32_t i = 0; i < count; i++) {
        struct device_needs needs = {.sparse_family = VK_QUEUE_FAMILY_IGNORED};
        gpu->physical_device = devices[i];
        gpu->family = find_drawing_family(devices[i]);
        if (gpu->family == VK_QUEUE_FAMILY_IGNORED ||
            !test(gpu->instance, devices[i], user, &needs))
            continue;
        gpu->sparse_family =
            needs.sparse_family == VK_QUEUE_FAMILY_IGNORED ? gpu->family : needs.sparse_family;
        if (create_device(gpu, &needs))
            return;
    }
    fprintf(stderr, "%s\n", count ? "no Vulkan device " CANNOT_STREAM : NO_VULKAN_DRIVER);
    exit(77);
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
