/* A renderer's part for Sluice, as docs/integrating.md shows it. Compiled, not run. */
#include <sluice/open.h>
#include <sluice/vulkan.h>

#include <stdbool.h>
#include <stdio.h>

#define FRAMES_IN_FLIGHT 2

/* Objects that the renderer owns. */
struct renderer {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t family; /* of the queue that frames go to */
    VkQueue queue, sparse_queue;
    uint32_t sparse_family;
    const SluiceDeviceMemoryCallbacks *memory; /* of its allocator, such as VMA; or NULL */
};

/* Objects for streaming. */
struct streaming {
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceImageOpener *opener;
    SluiceStreamingFrame frames[FRAMES_IN_FLIGHT];
    bool paged; /* specialization constant 0 of the shaders */
};

struct material {
    SluiceImageSource *sources[3]; /* color, normal, roughness */
    SluiceVulkanTexture textures[3];
};

static void print_message(void *pUserData, SluiceLogSeverity severity, const char *pMessage)
{
    (void)pUserData;
    if (severity != SLUICE_LOG_INFO)
        fprintf(stderr, "sluice: %s\n", pMessage);
}
static const SluiceLogCallback log_callback = {NULL, print_message};

/* Before vkCreateDevice. Adds the features that Sluice needs to those of the renderer. */
bool require_features(VkInstance instance, VkPhysicalDevice device,
                      VkPhysicalDeviceFeatures *features,
                      VkPhysicalDeviceVulkan12Features *vulkan12, uint32_t *sparse_family);
bool require_features(VkInstance instance, VkPhysicalDevice device,
                      VkPhysicalDeviceFeatures *features,
                      VkPhysicalDeviceVulkan12Features *vulkan12, uint32_t *sparse_family)
{
    SluiceVulkanDeviceCapabilities caps = {.structSize = sizeof caps};
    if (sluiceGetVulkanDeviceCapabilities(instance, device, vkGetInstanceProcAddr, &caps) !=
        SLUICE_SUCCESS)
        return false;
    if (caps.sparse)
        *sparse_family = caps.sparseQueueFamilyIndex; /* create a queue of it, too */
    return sluiceRequireVulkanFeatures(instance, device, vkGetInstanceProcAddr,
                                       SLUICE_RESIDENCY_MODE_AUTO, &log_callback, features,
                                       vulkan12) == SLUICE_SUCCESS;
}

SluiceResult start_streaming(struct streaming *s, const struct renderer *r);
SluiceResult start_streaming(struct streaming *s, const struct renderer *r)
{
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = r->family,
                                                   .instance = r->instance,
                                                   .physicalDevice = r->physical_device,
                                                   .device = r->device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .sparseQueue = r->sparse_queue,
                                                   .sparseQueueFamilyIndex = r->sparse_family,
                                                   .log = log_callback,
                                                   .pDeviceMemory = r->memory,
                                                   .memoryBudget = 512u << 20};
    SluiceResult result = sluiceCreateVulkanContext(&context, &s->context);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                                 .context = s->context,
                                                 .framesInFlight = FRAMES_IN_FLIGHT,
                                                 .textureArray = SLUICE_TEXTURE_ARRAY_COMBINED};
    if ((result = sluiceCreateVulkanStreamer(&info, &s->streamer)) != SLUICE_SUCCESS)
        return result;
    SluiceResidencyMode mode;
    result = sluiceGetVulkanResidencyMode(s->streamer, &mode);
    s->paged = mode == SLUICE_RESIDENCY_MODE_PAGED;
    const SluiceImageOpenerCreateInfo opener = {.structSize = sizeof opener, .log = log_callback};
    return result == SLUICE_SUCCESS ? sluiceCreateImageOpener(&opener, &s->opener) : result;
}

/* Textures that are sampled with the same uv: one writes feedback, the others follow it. */
SluiceResult add_material(struct streaming *s, const char *const paths[3],
                          struct material *material);
SluiceResult add_material(struct streaming *s, const char *const paths[3],
                          struct material *material)
{
    SluiceTextureId primary = SLUICE_NO_TEXTURE;
    for (int i = 0; i < 3; i++) {
        SluiceResult result = sluiceOpenImageSource(s->opener, paths[i], &material->sources[i]);
        if (result != SLUICE_SUCCESS)
            return result;
        const SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info,
                                                    .source = material->sources[i],
                                                    .primaryId = primary,
                                                    .maxAnisotropy = 8.0f};
        result = sluiceAddVulkanTexture(s->streamer, &info, &material->textures[i]);
        if (result != SLUICE_SUCCESS)
            return result;
        if (i == 0)
            primary = material->textures[0].textureId;
    }
    return SLUICE_SUCCESS;
}

/* Once the renderer has waited for the frame FRAMES_IN_FLIGHT before. Returns set 0 of the draws.
 */
VkDescriptorSet begin_frame(struct streaming *s, VkCommandBuffer commands, uint64_t frame,
                            uint64_t nanoseconds);
VkDescriptorSet begin_frame(struct streaming *s, VkCommandBuffer commands, uint64_t frame,
                            uint64_t nanoseconds)
{
    SluiceStreamingFrame *streaming = &s->frames[frame % FRAMES_IN_FLIGHT];
    streaming->structSize = sizeof *streaming;
    SluiceResult result = sluiceBeginStreamingFrame(s->streamer, commands, nanoseconds, streaming);
    if (result != SLUICE_SUCCESS)
        fprintf(stderr, "sluiceBeginStreamingFrame: %s\n", sluiceGetResultName(result));
    return result == SLUICE_SUCCESS ? streaming->descriptorSet : VK_NULL_HANDLE;
}

/* After the draws, outside a render pass. Then submit, and signal what is returned. */
const SluiceStreamingFrame *end_frame(struct streaming *s, VkCommandBuffer commands,
                                      uint64_t frame);
const SluiceStreamingFrame *end_frame(struct streaming *s, VkCommandBuffer commands, uint64_t frame)
{
    SluiceResult result = sluiceEndStreamingFrame(s->streamer, commands);
    return result == SLUICE_SUCCESS ? &s->frames[frame % FRAMES_IN_FLIGHT] : NULL;
}

void remove_material(struct streaming *s, struct material *material);
void remove_material(struct streaming *s, struct material *material)
{
    for (int i = 2; i >= 0; i--) /* followers first */
        sluiceRemoveVulkanTexture(s->streamer, material->textures[i].textureId);
    sluiceWaitVulkanStreamerIdle(s->streamer); /* ends reads of the sources */
    for (int i = 0; i < 3; i++)
        sluiceDestroyImageSource(material->sources[i]);
}

/* The frames were submitted or abandoned. */
void stop_streaming(struct streaming *s, struct material *materials, uint32_t count);
void stop_streaming(struct streaming *s, struct material *materials, uint32_t count)
{
    sluiceDestroyVulkanStreamer(s->streamer); /* waits for its frames, and for reads of sources */
    sluiceDestroyVulkanContext(s->context);
    for (uint32_t i = 0; i < 3 * count; i++)
        sluiceDestroyImageSource(materials[i / 3].sources[i % 3]);
    sluiceDestroyImageOpener(s->opener);
}
