#include "target.h"

#include <string.h>

#define DEPTH_FORMAT VK_FORMAT_D32_SFLOAT
#define ENCODING_FORMAT VK_FORMAT_R8G8B8A8_SRGB

static VkAttachmentDescription attachment(VkFormat format, VkSampleCountFlagBits samples,
                                          bool cleared, bool stored, VkImageLayout layout)
{
    return (VkAttachmentDescription){
        .format = format,
        .samples = samples,
        .loadOp = cleared ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .storeOp = stored ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .finalLayout = layout,
    };
}

/* Order a pass after the previous one and its copy, because frames in flight share the images. */
static const VkSubpassDependency dependencies[] = {
    {.srcSubpass = VK_SUBPASS_EXTERNAL,
     .dstSubpass = 0,
     .srcStageMask =
         VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
         VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
     .dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                     VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                     VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
     .srcAccessMask =
         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
     .dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                      VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                      VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT},
    {.srcSubpass = 0,
     .dstSubpass = VK_SUBPASS_EXTERNAL,
     .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
     .dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
     .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
     .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT},
};

static bool create_pass(const struct gpu *gpu, struct target *target)
{
    bool resolves = target->samples != VK_SAMPLE_COUNT_1_BIT;
    const VkFormat format = target->encoding ? ENCODING_FORMAT : TARGET_FORMAT;
    const VkAttachmentDescription attachments[] = {
        attachment(format, target->samples, true, !resolves,
                   resolves ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL
                            : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
        attachment(DEPTH_FORMAT, target->samples, true, false,
                   VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL),
        attachment(format, VK_SAMPLE_COUNT_1_BIT, false, true,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
    };
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference resolve = {2, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &color,
                                    .pResolveAttachments = resolves ? &resolve : NULL,
                                    .pDepthStencilAttachment = &depth};
    VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                   .attachmentCount = resolves ? 3 : 2,
                                   .pAttachments = attachments,
                                   .subpassCount = 1,
                                   .pSubpasses = &subpass,
                                   .dependencyCount = 2,
                                   .pDependencies = dependencies};
    return gpu_check(vkCreateRenderPass(gpu->device, &info, NULL, &target->pass),
                     "vkCreateRenderPass");
}

static const VkImageUsageFlags color_usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                             VK_IMAGE_USAGE_SAMPLED_BIT;

static bool create_depth(const struct gpu *gpu, struct target *target)
{
    return gpu_create_image(gpu, DEPTH_FORMAT, target->width, target->height, target->samples,
                            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT,
                            &target->depth);
}

static bool create_images(const struct gpu *gpu, struct target *target)
{
    uint32_t width = target->width, height = target->height;
    if (!gpu_create_image(gpu, TARGET_FORMAT, width, height, VK_SAMPLE_COUNT_1_BIT, color_usage,
                          VK_IMAGE_ASPECT_COLOR_BIT, &target->color) ||
        !create_depth(gpu, target))
        return false;
    return target->samples == VK_SAMPLE_COUNT_1_BIT ||
           gpu_create_image(gpu, TARGET_FORMAT, width, height, target->samples,
                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_IMAGE_ASPECT_COLOR_BIT,
                            &target->multisampled);
}

static bool create_framebuffer(const struct gpu *gpu, struct target *target)
{
    bool resolves = target->samples != VK_SAMPLE_COUNT_1_BIT;
    const VkImageView views[] = {resolves           ? target->multisampled.view
                                 : target->encoding ? target->encoding
                                                    : target->color.view,
                                 target->depth.view, target->color.view};
    VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                    .renderPass = target->pass,
                                    .attachmentCount = resolves ? 3 : 2,
                                    .pAttachments = views,
                                    .width = target->width,
                                    .height = target->height,
                                    .layers = 1};
    return gpu_check(vkCreateFramebuffer(gpu->device, &info, NULL, &target->framebuffer),
                     "vkCreateFramebuffer");
}

bool target_create(const struct gpu *gpu, uint32_t width, uint32_t height, uint32_t samples,
                   struct target *target)
{
    VkSampleCountFlags supported = gpu->properties.limits.framebufferColorSampleCounts &
                                   gpu->properties.limits.framebufferDepthSampleCounts;
    while (samples & (samples - 1)) /* round down to a power of two */
        samples &= samples - 1;
    while (samples > 1 && !(supported & samples))
        samples /= 2;
    *target = (struct target){
        .width = width, .height = height, .samples = (VkSampleCountFlagBits)samples};
    if (create_images(gpu, target) && create_pass(gpu, target) && create_framebuffer(gpu, target))
        return true;
    target_destroy(gpu, target);
    return false;
}

static bool create_encoding_view(const struct gpu *gpu, struct target *target)
{
    const VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = target->color.image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = ENCODING_FORMAT,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    return gpu_check(vkCreateImageView(gpu->device, &info, NULL, &target->encoding),
                     "vkCreateImageView");
}

bool target_create_encoding(const struct gpu *gpu, uint32_t width, uint32_t height,
                            struct target *target)
{
    static const VkFormat formats[2] = {TARGET_FORMAT, ENCODING_FORMAT};
    *target = (struct target){.width = width, .height = height, .samples = VK_SAMPLE_COUNT_1_BIT};
    if (gpu_create_viewed_image(gpu, formats, width, height, color_usage, &target->color) &&
        create_encoding_view(gpu, target) && create_depth(gpu, target) &&
        create_pass(gpu, target) && create_framebuffer(gpu, target))
        return true;
    target_destroy(gpu, target);
    return false;
}

void target_destroy(const struct gpu *gpu, struct target *target)
{
    vkDestroyFramebuffer(gpu->device, target->framebuffer, NULL);
    vkDestroyRenderPass(gpu->device, target->pass, NULL);
    vkDestroyImageView(gpu->device, target->encoding, NULL);
    gpu_destroy_image(gpu, &target->depth);
    gpu_destroy_image(gpu, &target->multisampled);
    gpu_destroy_image(gpu, &target->color);
    memset(target, 0, sizeof *target);
}

void target_begin(const struct target *target, VkCommandBuffer commands, const float clear[4])
{
    VkClearValue clears[2] = {{{{0}}}, {.depthStencil = {1.0f, 0}}};
    memcpy(clears[0].color.float32, clear, 4 * sizeof *clear);
    VkRect2D area = {{0, 0}, {target->width, target->height}};
    VkRenderPassBeginInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                  .renderPass = target->pass,
                                  .framebuffer = target->framebuffer,
                                  .renderArea = area,
                                  .clearValueCount = 2,
                                  .pClearValues = clears};
    vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    VkViewport viewport = {0, 0, (float)target->width, (float)target->height, 0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &area);
}

void target_end(const struct target *target, VkCommandBuffer commands)
{
    (void)target;
    vkCmdEndRenderPass(commands);
}

void target_copy_out(const struct target *target, VkCommandBuffer commands, VkBuffer buffer)
{
    VkBufferImageCopy region = {
        .imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1},
        .imageExtent = {target->width, target->height, 1}};
    vkCmdCopyImageToBuffer(commands, target->color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           buffer, 1, &region);
    VkBufferMemoryBarrier to_host = {.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
                                     .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                     .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                     .buffer = buffer,
                                     .size = VK_WHOLE_SIZE};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 0,
                         NULL, 1, &to_host, 0, NULL);
}
