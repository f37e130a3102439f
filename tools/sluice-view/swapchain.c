#include "swapchain.h"

#include <stdio.h>
#include <string.h>

/* UNORM, because the picture's bytes are what the monitor is to show. */
static bool choose_format(const struct gpu *gpu, VkSurfaceKHR surface, VkSurfaceFormatKHR *chosen)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = 64;
    VkResult result =
        vkGetPhysicalDeviceSurfaceFormatsKHR(gpu->physical_device, surface, &count, formats);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE)
        return gpu_check(result, "vkGetPhysicalDeviceSurfaceFormatsKHR");
    for (uint32_t i = 0; i < count; i++)
        if (formats[i].format == VK_FORMAT_B8G8R8A8_UNORM ||
            formats[i].format == VK_FORMAT_R8G8B8A8_UNORM) {
            *chosen = formats[i];
            return true;
        }
    fprintf(stderr, "sluice-view: the window has no format of 8 bits per channel\n");
    return false;
}

static uint32_t clamp(uint32_t value, uint32_t least, uint32_t most)
{
    return value < least ? least : value > most ? most : value;
}

static void choose_extent(const VkSurfaceCapabilitiesKHR *surface, uint32_t width, uint32_t height,
                          VkExtent2D *extent)
{
    *extent = surface->currentExtent;
    if (extent->width == UINT32_MAX)
        *extent = (VkExtent2D){
            clamp(width, surface->minImageExtent.width, surface->maxImageExtent.width),
            clamp(height, surface->minImageExtent.height, surface->maxImageExtent.height)};
}

static bool create_semaphores(struct swapchain *s)
{
    const VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    for (uint32_t i = 0; i < s->image_count; i++)
        if (!gpu_check(vkCreateSemaphore(s->gpu->device, &info, NULL, &s->presented[i]),
                       "vkCreateSemaphore"))
            return false;
    for (uint32_t i = 0; i < SWAPCHAIN_SLOTS; i++)
        if (!gpu_check(vkCreateSemaphore(s->gpu->device, &info, NULL, &s->acquired[i]),
                       "vkCreateSemaphore"))
            return false;
    return true;
}

static void destroy_semaphores(struct swapchain *s)
{
    for (uint32_t i = 0; i < SWAPCHAIN_MAX_IMAGES; i++)
        vkDestroySemaphore(s->gpu->device, s->presented[i], NULL);
    for (uint32_t i = 0; i < SWAPCHAIN_SLOTS; i++)
        vkDestroySemaphore(s->gpu->device, s->acquired[i], NULL);
    memset(s->presented, 0, sizeof s->presented);
    memset(s->acquired, 0, sizeof s->acquired);
}

static bool is_offered(VkPresentModeKHR mode, const VkPresentModeKHR *offered, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (offered[i] == mode)
            return true;
    return false;
}

VkPresentModeKHR swapchain_choose_mode(VkPresentModeKHR wanted, const VkPresentModeKHR *offered,
                                       uint32_t count)
{
    if (wanted == VK_PRESENT_MODE_IMMEDIATE_KHR && !is_offered(wanted, offered, count))
        wanted = VK_PRESENT_MODE_MAILBOX_KHR;
    return is_offered(wanted, offered, count) ? wanted : VK_PRESENT_MODE_FIFO_KHR;
}

const char *swapchain_mode_name(VkPresentModeKHR mode)
{
    return mode == VK_PRESENT_MODE_IMMEDIATE_KHR ? "IMMEDIATE"
           : mode == VK_PRESENT_MODE_MAILBOX_KHR ? "MAILBOX"
                                                 : "FIFO";
}

static bool find_mode(struct swapchain *s)
{
    VkPresentModeKHR modes[16];
    uint32_t count = 16;
    const VkResult result = vkGetPhysicalDeviceSurfacePresentModesKHR(s->gpu->physical_device,
                                                                      s->surface, &count, modes);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE)
        return gpu_check(result, "vkGetPhysicalDeviceSurfacePresentModesKHR");
    s->mode = swapchain_choose_mode(s->wanted, modes, count);
    return true;
}

enum swapchain_outcome swapchain_create(const struct gpu *gpu, VkSurfaceKHR surface, uint32_t width,
                                        uint32_t height, struct swapchain *s)
{
    VkSurfaceCapabilitiesKHR capabilities;
    VkSurfaceFormatKHR format = {0};
    VkExtent2D extent;
    s->gpu = gpu;
    s->surface = surface;
    if (!gpu_check(
            vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu->physical_device, surface, &capabilities),
            "vkGetPhysicalDeviceSurfaceCapabilitiesKHR") ||
        !choose_format(gpu, surface, &format) || !find_mode(s))
        return SWAPCHAIN_FAILED;
    choose_extent(&capabilities, width, height, &extent);
    s->outdated = extent.width == 0 || extent.height == 0;
    if (s->outdated)
        return SWAPCHAIN_OUTDATED;
    const uint32_t count = capabilities.minImageCount + 1;
    const VkSwapchainCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = surface,
        .minImageCount = capabilities.maxImageCount && count > capabilities.maxImageCount
                             ? capabilities.maxImageCount
                             : count,
        .imageFormat = format.format,
        .imageColorSpace = format.colorSpace,
        .imageExtent = extent,
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        .preTransform = capabilities.currentTransform,
        .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
        .presentMode = s->mode,
        .clipped = VK_TRUE,
        .oldSwapchain = s->swapchain};
    VkSwapchainKHR created = VK_NULL_HANDLE;
    VkResult result = vkCreateSwapchainKHR(gpu->device, &info, NULL, &created);
    destroy_semaphores(s);
    vkDestroySwapchainKHR(gpu->device, s->swapchain, NULL);
    s->swapchain = created;
    s->image_count = SWAPCHAIN_MAX_IMAGES;
    s->width = extent.width;
    s->height = extent.height;
    if (!gpu_check(result, "vkCreateSwapchainKHR") ||
        !gpu_check(vkGetSwapchainImagesKHR(gpu->device, created, &s->image_count, s->images),
                   "vkGetSwapchainImagesKHR") ||
        !create_semaphores(s))
        return SWAPCHAIN_FAILED;
    return SWAPCHAIN_GOOD;
}

void swapchain_destroy(struct swapchain *s)
{
    if (!s->gpu)
        return;
    destroy_semaphores(s);
    vkDestroySwapchainKHR(s->gpu->device, s->swapchain, NULL);
    *s = (struct swapchain){0};
}

/* Evaluates a result. A suboptimal image is shown, and the next frame gets a new swapchain. */
static enum swapchain_outcome judge(struct swapchain *s, VkResult result, const char *call)
{
    s->outdated = result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR;
    if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR)
        return SWAPCHAIN_GOOD;
    if (result == VK_ERROR_OUT_OF_DATE_KHR)
        return SWAPCHAIN_OUTDATED;
    gpu_check(result, call);
    return SWAPCHAIN_FAILED;
}

enum swapchain_outcome swapchain_acquire(struct swapchain *s, uint32_t slot, uint32_t *image)
{
    return judge(s,
                 vkAcquireNextImageKHR(s->gpu->device, s->swapchain, UINT64_MAX, s->acquired[slot],
                                       VK_NULL_HANDLE, image),
                 "vkAcquireNextImageKHR");
}

static void record_layout(VkCommandBuffer commands, VkImage image, bool before)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = before ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = before ? VK_ACCESS_TRANSFER_WRITE_BIT : 0,
        .oldLayout = before ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .newLayout =
            before ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    /* The submission waits for the image at the stage TRANSFER. */
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         before ? VK_PIPELINE_STAGE_TRANSFER_BIT
                                : VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                         0, 0, NULL, 0, NULL, 1, &barrier);
}

void swapchain_record_copy(const struct swapchain *s, uint32_t image, const struct target *target,
                           VkCommandBuffer commands)
{
    const VkImageSubresourceLayers layers = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageBlit blit = {
        .srcSubresource = layers,
        .srcOffsets = {{0, 0, 0}, {(int32_t)target->width, (int32_t)target->height, 1}},
        .dstSubresource = layers,
        .dstOffsets = {{0, 0, 0}, {(int32_t)s->width, (int32_t)s->height, 1}}};
    record_layout(commands, s->images[image], true);
    vkCmdBlitImage(commands, target->color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   s->images[image], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit,
                   VK_FILTER_NEAREST);
    record_layout(commands, s->images[image], false);
}

enum swapchain_outcome swapchain_present(struct swapchain *s, uint32_t image)
{
    const VkPresentInfoKHR info = {.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                   .waitSemaphoreCount = 1,
                                   .pWaitSemaphores = &s->presented[image],
                                   .swapchainCount = 1,
                                   .pSwapchains = &s->swapchain,
                                   .pImageIndices = &image};
    const bool was_outdated = s->outdated;
    enum swapchain_outcome outcome =
        judge(s, vkQueuePresentKHR(s->gpu->queue, &info), "vkQueuePresentKHR");
    s->outdated |= was_outdated;
    return outcome;
}
