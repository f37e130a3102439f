/**
 * A headless Vulkan device for tests, with the validation layer where it is installed: any message
 * of warning or error severity fails the test.
 *
 * Environment: SLUICE_DEVICE picks a device by index or by a part of its name. SLUICE_RESIDENCY is
 * the mode that is tested: sparse, paged, dense or auto, which is the default. Without a device
 * that has Vulkan 1.2 and that mode a test program exits with status 77 and says why.
 * SLUICE_UPLOAD_QUEUE=1: the library copies tiles on a queue of a family that does not draw, if the
 * device has one, else on the drawing queue.
 * SLUICE_ABANDON=n: one in n frames and launches is recorded and given up, and then begun again.
 */
#ifndef TESTS_DEVICE_HARNESS_H
#define TESTS_DEVICE_HARNESS_H

#include <sluice/vulkan.h>

#define HARNESS_CUBIC_KINDS 22u
#define HARNESS_PROBE_KINDS                                                                        \
    46u ///< 16 of probers, six of others, 16 of probers that know cubic filters, 4 in HLSL
#define HARNESS_HLSL_KINDS 38u
#define HARNESS_PAINT_KINDS 32u
#define HARNESS_FRAMES 3u

/* clang-format off */
#define HARNESS_INSTANCE_FUNCTIONS(X)                                                             \
    X(CreateDevice) X(DestroyInstance) X(EnumerateDeviceExtensionProperties) X(EnumeratePhysicalDevices) X(GetDeviceProcAddr)           \
    X(GetPhysicalDeviceFeatures2) X(GetPhysicalDeviceMemoryProperties)                             \
    X(GetPhysicalDeviceProperties) X(GetPhysicalDeviceQueueFamilyProperties)

#define HARNESS_DEVICE_FUNCTIONS(X)                                                               \
    X(AllocateCommandBuffers) X(AllocateDescriptorSets) X(AllocateMemory)                         \
    X(BeginCommandBuffer) X(BindBufferMemory) X(BindImageMemory) X(CmdBeginRenderPass)            \
    X(CmdBindDescriptorSets) X(CmdBindPipeline) X(CmdCopyBufferToImage) X(CmdCopyImageToBuffer) X(CmdDispatch) X(CmdFillBuffer)           \
    X(CmdDraw) X(CmdEndRenderPass) X(CmdPipelineBarrier) X(CmdPushConstants) X(CreateBuffer)      \
    X(CreateCommandPool) X(CreateComputePipelines) X(CreateDescriptorPool)                        \
    X(CreateDescriptorSetLayout) X(CreateFramebuffer) X(CreateGraphicsPipelines)                  \
    X(CreateImage) X(CreateImageView) X(CreatePipelineLayout) X(CreateRenderPass)                 \
    X(CreateSampler) X(CreateShaderModule) X(DestroyBuffer) X(DestroyCommandPool)                 \
    X(DestroyDescriptorPool) X(DestroyDescriptorSetLayout) X(DestroyDevice)                       \
    X(DestroyFramebuffer) X(DestroyImage) X(DestroyImageView) X(DestroyPipeline)                  \
    X(DestroyPipelineLayout) X(DestroyRenderPass) X(DestroySampler) X(DestroyShaderModule)        \
    X(DeviceWaitIdle) X(EndCommandBuffer) X(FreeDescriptorSets) X(FreeMemory) X(GetBufferMemoryRequirements)            \
    X(GetDeviceQueue) X(GetImageMemoryRequirements) X(MapMemory) X(QueueSubmit)                   \
    X(ResetCommandBuffer) X(UpdateDescriptorSets) X(WaitSemaphores)
/* clang-format on */

struct harness_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *mapped; ///< host visible and coherent
    uint64_t size;
};

struct harness {
    void *library;
    PFN_vkGetInstanceProcAddr get;
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    bool leaves_auto; ///< streamers choose their mode, and that of each texture
    bool validates;
    uint32_t message_count; ///< of validation, warnings and errors
    bool failed;            ///< a test did, so what is left behind is no news
    VkPhysicalDevice physical_device;
    VkPhysicalDeviceMemoryProperties memory;
    VkDevice device;
    uint32_t family;
    VkQueue queue, sparse_queue; ///< the latter VK_NULL_HANDLE without sparse residency
    VkQueue upload_queue;        ///< VK_NULL_HANDLE unless SLUICE_UPLOAD_QUEUE is set
    uint32_t upload_family;
    uint64_t upload_queue_copies; ///< of streamers that were destroyed
    SluiceVulkanDeviceCapabilities caps;
    SluiceResidencyMode mode; ///< never AUTO
    const char *mode_name;
    SluiceVulkanContext *context;
    bool min_lod;   ///< probers have samplers clamp: caps.shaderResourceMinLod
    bool cubic;     ///< probers know bicubic filters
    bool mixes;     ///< probers know textures of several modes; set before there is one
    bool page_loop; ///< probers find pages by a loop instead of an index
    bool hlsl;      ///< probers are in HLSL; they find pages by a loop, and know no min_lod
    bool anisotropy, mirror_clamp; ///< features that are enabled because they are there
    bool reads_bytes;              ///< features for addresses and arrays of buffers
    bool runs_bytes;               ///< runners read byte pages, where reads_bytes
    /** Shared by all probers and painters of a kind: to compile one takes longer than to run it. */
    VkPipeline probe_pipelines[HARNESS_PROBE_KINDS], paint_pipelines[HARNESS_PAINT_KINDS];
    VkCommandPool pool;
    VkCommandBuffer commands[HARNESS_FRAMES];
    uint32_t frame_count;
    VkDescriptorSet set;                       ///< of the frame that is recorded
    SluiceStreamingFrame last[HARNESS_FRAMES]; ///< that used each command buffer
    uint64_t time;                             ///< of the last frame; one more each frame
    uint32_t log_count[3];                     ///< messages of the library by severity
    char last_message[256];                    ///< of any severity
    uint32_t abandon_one_in; ///< frames, launches that are recorded and given up before; 0: none
    uint32_t abandon_turn, abandoned_count;
    bool quiet; ///< expected failures are counted but not printed
#define HARNESS_MEMBER(name) PFN_vk##name name;
    HARNESS_INSTANCE_FUNCTIONS(HARNESS_MEMBER)
    HARNESS_DEVICE_FUNCTIONS(HARNESS_MEMBER)
#undef HARNESS_MEMBER
};

/** 0; or 77, having said why there is no device to test on; or 1. */
int harness_init(struct harness *h);
/** The same with extensions, and 77 if the device lacks one; `features` is a chain of structures
 * for vkCreateDevice or NULL. Also enables bufferDeviceAddress. */
int harness_init_with(struct harness *h, const char *const *extensions, uint32_t extension_count,
                      void *features);
/** What a test of a newer extension adds to a device. */
struct harness_newer {
    /** Adds extensions to `info` and features to `vulkan12` and its chain, if the device has them.
     */
    void (*prepare)(struct harness *h, VkDeviceCreateInfo *info,
                    VkPhysicalDeviceVulkan12Features *vulkan12, void *user);
    void *user;
    uint32_t layer_version; ///< validation that is older does not know the extension and stays off
};
/** As harness_init. */
int harness_init_newer(struct harness *h, const struct harness_newer *newer);
/** Returns `status`, or 1 if that was 0 and validation complains about what is left. After a failed
 *  test it says nothing of what that test left behind. */
int harness_finish(struct harness *h, int status);

/**
 * Replaces the harness's context by one with these settings, except for the device, its queues and
 * the log; a function that is NULL is the harness's own. NULL: the usual context. After an error
 * there is none. Its streamers and demand loaders must have been destroyed.
 */
SluiceResult harness_set_context(struct harness *h, const SluiceVulkanContextCreateInfo *settings);
/** Settings of the usual context. */
SluiceVulkanContextCreateInfo harness_context_info(struct harness *h);

/** Fills in the context, the mode if that is AUTO, and frames as the unit of time: then 0 is the
 * newest map alone, no standby tiles, and a second try at once. The rest stays. */
void harness_fill(struct harness *h, SluiceVulkanStreamerCreateInfo *info);

void harness_buffer_init(struct harness *h, struct harness_buffer *buffer, uint64_t size,
                         VkBufferUsageFlags usage);
void harness_buffer_finish(struct harness *h, struct harness_buffer *buffer);

/**
 * One frame: begin, `record` (may be NULL), end, submit. With `wait`, until the GPU has finished
 * it. Fails the test on any error.
 */
void harness_frame(struct harness *h, SluiceVulkanStreamer *streamer, bool wait,
                   void (*record)(void *user, VkCommandBuffer commands), void *user);

/** Use one streamer at a time, and this to destroy it. */
void harness_destroy(struct harness *h, SluiceVulkanStreamer *streamer);

/** Frames, each finished and with all reads and binds waited for, until nothing is on its way. */
void harness_settle(struct harness *h, SluiceVulkanStreamer *streamer, uint32_t frame_count,
                    void (*record)(void *user, VkCommandBuffer commands), void *user);

/** Commands outside of frames, waited for. */
void harness_run(struct harness *h, void (*record)(void *user, VkCommandBuffer commands),
                 void *user);

/** True in one of abandon_one_in calls, always in the same ones. Counts them. */
bool harness_abandons(struct harness *h);

/** Fails the test if validation has said anything. */
void harness_check_silence(const struct harness *h);

/** Whether the device is a CPU, such as lavapipe. */
bool harness_is_software(struct harness *h);

/** How far a device's levels may be off the formula; a CPU's are not. */
float harness_level_error(struct harness *h);

#endif /* TESTS_DEVICE_HARNESS_H */
