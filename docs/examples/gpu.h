/**
 * Plain Vulkan that clusters.c, demand.c and vulkan.c share: a device, one compute shader, and its
 * answer, a buffer that the host reads. Every function ends the program if Vulkan fails.
 */
#ifndef DOCS_EXAMPLES_GPU_H
#define DOCS_EXAMPLES_GPU_H

#include <sluice/vulkan.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Ends the program with status 1 and "`what` failed" unless `good`. */
void check(bool good, const char *what);
#define VK(call) check((call) == VK_SUCCESS, #call)
#define SLUICE(call) check((call) == SLUICE_SUCCESS, #call)

extern const SluiceLogCallback log_callback; ///< prints to stderr

struct gpu {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t family;
    VkQueue queue; ///< of `family`
    VkCommandPool command_pool;
    VkCommandBuffer commands;
    VkBuffer answer_buffer;
    VkDeviceMemory answer_memory;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool set_pool;
    VkDescriptorSet set; ///< set 1 of the shader: binding 0 is the answer
    VkPipelineLayout pipeline_layout;
    VkPipeline pipeline;
};

/** Returns whether the program can use this device; then also adds the features to enable. */
typedef bool device_test(VkInstance instance, VkPhysicalDevice device,
                         VkPhysicalDeviceFeatures *features,
                         VkPhysicalDeviceVulkan12Features *vulkan12);

/** Opens the first device that passes the test and has a queue family with all of `queue_flags`.
 *  Ends the program with status 77 if no device does. */
void create_gpu(struct gpu *gpu, VkQueueFlags queue_flags, device_test *test);
/** Destroys the answer and the pipeline, too. The device must be idle. */
void destroy_gpu(const struct gpu *gpu);

/** Returns the answer, `size` bytes, mapped until destroy_gpu. */
void *create_answer(struct gpu *gpu, size_t size);
/** Call after create_answer. `set_0` is the layout of the shader's set 0, `code_size` and
 *  `constants_size` (of push constants) are in bytes. */
void create_pipeline(struct gpu *gpu, const uint32_t *code, size_t code_size,
                     VkDescriptorSetLayout set_0, uint32_t constants_size);

void begin_commands(const struct gpu *gpu);
/** Binds the pipeline, `set_0` and the set of the answer. */
void bind_shader(const struct gpu *gpu, VkDescriptorSet set_0);
/** Makes the answer visible to the host, ends the commands and submits them. They signal the
 *  timeline semaphore with `value`. */
void submit(const struct gpu *gpu, VkSemaphore semaphore, uint64_t value);

#endif /* DOCS_EXAMPLES_GPU_H */
