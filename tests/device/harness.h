/**
 * A headless Vulkan device for tests. With the validation layer, if installed, any message of
 * warning or error severity fails the test.
 *
 * Environment: SLUICE_DEVICE selects a device by index or by a part of its name. SLUICE_RESIDENCY
 * is the tested mode: sparse, paged, dense or auto. Default: auto. Without a device that has Vulkan
 * 1.2 and the mode, a test program says why and exits with status 77. SLUICE_UPLOAD_QUEUE=1: the
 * library copies tiles on a queue of a family that does not draw, or else on the drawing queue.
 * SLUICE_ABANDON=n: one in n frames and launches is recorded, abandoned, and begun again.
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
    bool leaves_auto; ///< true: streamers choose their mode, and the mode of each texture
    bool validates;
    uint32_t message_count; ///< warnings and errors of validation
    bool failed;            ///< a test has failed, so leftovers are not reported
    VkPhysicalDevice physical_device;
    VkPhysicalDeviceMemoryProperties memory;
    VkDevice device;
    uint32_t family;
    VkQueue queue, sparse_queue; ///< sparse_queue: VK_NULL_HANDLE without sparse residency
    VkQueue upload_queue;        ///< VK_NULL_HANDLE unless SLUICE_UPLOAD_QUEUE is set
    uint32_t upload_family;
    uint64_t upload_queue_copies; ///< sum over destroyed streamers
    SluiceVulkanDeviceCapabilities caps;
    SluiceResidencyMode mode; ///< not AUTO
    const char *mode_name;
    SluiceVulkanContext *context;
    bool min_lod;   ///< probers let samplers clamp: caps.shaderResourceMinLod
    bool cubic;     ///< probers support bicubic filters
    bool mixes;     ///< probers support textures of several modes; set before creating one
    bool page_loop; ///< probers find pages by a loop instead of an index
    bool hlsl;      ///< probers are in HLSL; they find pages by a loop, without min_lod
    bool anisotropy, mirror_clamp; ///< features that are enabled if available
    bool reads_bytes;              ///< features for addresses and arrays of buffers
    bool runs_bytes;               ///< runners read byte pages if reads_bytes
    /** Shared by all probers and painters of a kind, because compiling takes longer than
     * running. */
    VkPipeline probe_pipelines[HARNESS_PROBE_KINDS], paint_pipelines[HARNESS_PAINT_KINDS];
    VkCommandPool pool;
    VkCommandBuffer commands[HARNESS_FRAMES];
    uint32_t frame_count;
    VkDescriptorSet set;                       ///< set of the recorded frame
    SluiceStreamingFrame last[HARNESS_FRAMES]; ///< last frame of each command buffer
    uint64_t time;                             ///< time of the last frame; one more each frame
    uint32_t log_count[3];                     ///< messages of the library by severity
    char last_message[256];                    ///< last message of any severity
    uint32_t abandon_one_in; ///< one frame or launch in this many is abandoned; 0: none
    uint32_t abandon_turn, abandoned_count;
    bool quiet; ///< expected failures are counted but not printed
#define HARNESS_MEMBER(name) PFN_vk##name name;
    HARNESS_INSTANCE_FUNCTIONS(HARNESS_MEMBER)
    HARNESS_DEVICE_FUNCTIONS(HARNESS_MEMBER)
#undef HARNESS_MEMBER
};

/** Returns 0; 77 without a device, with a message; or 1. */
int harness_init(struct harness *h);
/** Initializes with extensions. Returns 77 if the device lacks one. `features`: chain of structures
 * for vkCreateDevice, or NULL. Also enables bufferDeviceAddress. */
int harness_init_with(struct harness *h, const char *const *extensions, uint32_t extension_count,
                      void *features);
/** Device requirements of a test for a newer extension. */
struct harness_newer {
    /** Adds extensions to `info` and features to `vulkan12` and its chain, if the device has
     * them. */
    void (*prepare)(struct harness *h, VkDeviceCreateInfo *info,
                    VkPhysicalDeviceVulkan12Features *vulkan12, void *user);
    void *user;
    uint32_t layer_version; ///< older validation does not support the extension and stays off
};
/** Initializes with a newer extension. Returns as harness_init does. */
int harness_init_newer(struct harness *h, const struct harness_newer *newer);
/** Returns `status`, or 1 if it was 0 and validation reports leftovers. After a failed test,
 * leftovers are not reported. */
int harness_finish(struct harness *h, int status);

/**
 * Replaces the harness's context by one with these settings, except for the device, its queues and
 * the log. NULL functions: the harness's own. `settings` NULL: the usual context. After an error
 * there is no context. Destroy its streamers and demand loaders before.
 */
SluiceResult harness_set_context(struct harness *h, const SluiceVulkanContextCreateInfo *settings);
/** Returns the settings of the usual context. */
SluiceVulkanContextCreateInfo harness_context_info(struct harness *h);

/** Fills in the context, the mode if AUTO, and frames as the unit of time. Time 0 then means the
 * newest map only, no standby tiles, and immediate retries. Other fields are kept. */
void harness_fill(struct harness *h, SluiceVulkanStreamerCreateInfo *info);

void harness_buffer_init(struct harness *h, struct harness_buffer *buffer, uint64_t size,
                         VkBufferUsageFlags usage);
void harness_buffer_finish(struct harness *h, struct harness_buffer *buffer);

/**
 * Runs a frame: begin, `record` (may be NULL), end, submit. `wait`: wait for the GPU. Fails the
 * test on any error.
 */
void harness_frame(struct harness *h, SluiceVulkanStreamer *streamer, bool wait,
                   void (*record)(void *user, VkCommandBuffer commands), void *user);

/** Destroys a streamer. Use one streamer at a time. */
void harness_destroy(struct harness *h, SluiceVulkanStreamer *streamer);

/** Runs frames and waits for each, for all reads and binds, until nothing is pending. */
void harness_settle(struct harness *h, SluiceVulkanStreamer *streamer, uint32_t frame_count,
                    void (*record)(void *user, VkCommandBuffer commands), void *user);

/** Runs commands outside of frames, and waits. */
void harness_run(struct harness *h, void (*record)(void *user, VkCommandBuffer commands),
                 void *user);

/** Returns true in one of abandon_one_in calls, in the same ones each run, and counts them. */
bool harness_abandons(struct harness *h);

/** Fails the test if validation has reported anything. */
void harness_check_silence(const struct harness *h);

/** Returns whether the device is a CPU, such as lavapipe. */
bool harness_is_software(struct harness *h);

/** Returns the tolerance of a device's levels against the formula; 0 for a CPU. */
float harness_level_error(struct harness *h);

#endif /* TESTS_DEVICE_HARNESS_H */
