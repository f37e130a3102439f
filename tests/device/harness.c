#include "device/harness.h"

#include "support/test.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#define LIBRARY "vulkan-1.dll"
#else
#define LIBRARY "libvulkan.so.1"
#endif
#define MAX_DEVICES 16u
#define MAX_FAMILIES 32u
#define LAYER "VK_LAYER_KHRONOS_validation"

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user)
{
    (void)types;
    if (severity < VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT)
        return VK_FALSE;
    /* The loader warns about libraries of other drivers. Only messages of the layer count. */
    if (data->pMessageIdName && strcmp(data->pMessageIdName, "Loader Message") == 0)
        return VK_FALSE;
    struct harness *h = user;
    if (h->message_count++ < 10 && !h->failed)
        fprintf(stderr, "# validation: %s\n", data->pMessage);
    return VK_FALSE;
}

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct harness *h = user;
    h->log_count[severity]++;
    snprintf(h->last_message, sizeof h->last_message, "%s", message);
    if (!h->quiet)
        fprintf(stderr, "# %s\n", message);
}

static bool layer_is_installed(struct harness *h, uint32_t version)
{
    PFN_vkEnumerateInstanceLayerProperties enumerate =
        (PFN_vkEnumerateInstanceLayerProperties)h->get(NULL, "vkEnumerateInstanceLayerProperties");
    VkLayerProperties layers[64];
    uint32_t count = 64;
    if (!enumerate || enumerate(&count, layers) < 0)
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(layers[i].layerName, LAYER) == 0)
            return layers[i].specVersion >= version;
    return false;
}

static bool create_instance(struct harness *h, uint32_t layer_version)
{
    const char *layers[] = {LAYER}, *extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                                     VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    VkValidationFeatureEnableEXT enables[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        /* Performance messages are excluded: the layer advises against copies into
         * VK_IMAGE_LAYOUT_GENERAL, but a streamed image is sampled while other tiles of it are
         * written. */
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = h};
    VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                        .pNext = &messenger,
                                        .enabledValidationFeatureCount = 1,
                                        .pEnabledValidationFeatures = enables};
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application};
    h->validates = layer_is_installed(h, layer_version);
    if (h->validates) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = layers;
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = extensions;
    }
    PFN_vkCreateInstance create = (PFN_vkCreateInstance)h->get(NULL, "vkCreateInstance");
    if (!create || create(&info, NULL, &h->instance) != VK_SUCCESS)
        return false;
#define LOAD(name) h->name = (PFN_vk##name)h->get(h->instance, "vk" #name);
    HARNESS_INSTANCE_FUNCTIONS(LOAD)
#undef LOAD
    if (!h->validates)
        return true;
    PFN_vkCreateDebugUtilsMessengerEXT create_messenger =
        (PFN_vkCreateDebugUtilsMessengerEXT)h->get(h->instance, "vkCreateDebugUtilsMessengerEXT");
    return create_messenger &&
           create_messenger(h->instance, &messenger, NULL, &h->messenger) == VK_SUCCESS;
}

/* Reads SLUICE_RESIDENCY. Returns false if it is no mode. */
static bool pick_mode(struct harness *h)
{
    static const struct {
        const char *name;
        SluiceResidencyMode mode;
    } modes[] = {{"auto", SLUICE_RESIDENCY_MODE_AUTO},
                 {"sparse", SLUICE_RESIDENCY_MODE_SPARSE},
                 {"paged", SLUICE_RESIDENCY_MODE_PAGED},
                 {"dense", SLUICE_RESIDENCY_MODE_DENSE}};
    const char *wanted = getenv("SLUICE_RESIDENCY");
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++)
        if (strcmp(wanted && *wanted ? wanted : "auto", modes[i].name) == 0) {
            h->mode = modes[i].mode;
            h->mode_name = modes[i].name;
            return true;
        }
    return false;
}

static bool can_run(struct harness *h, VkPhysicalDevice device)
{
    VkPhysicalDeviceFeatures features = {0};
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    return sluiceRequireVulkanFeatures(h->instance, device, h->get, h->mode, NULL, &features,
                                       &vulkan12) == SLUICE_SUCCESS;
}

static bool pick_device(struct harness *h)
{
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t count = MAX_DEVICES;
    if (h->EnumeratePhysicalDevices(h->instance, &count, devices) < 0)
        return false;
    const char *wanted = getenv("SLUICE_DEVICE");
    for (uint32_t i = 0; i < count; i++) {
        char number[16];
        snprintf(number, sizeof number, "%u", i);
        SluiceVulkanDeviceCapabilities caps = {.structSize = sizeof caps};
        if (sluiceGetVulkanDeviceCapabilities(h->instance, devices[i], h->get, &caps) !=
            SLUICE_SUCCESS)
            continue;
        bool is_number = wanted && wanted[strspn(wanted, "0123456789")] == '\0';
        bool named = wanted && (is_number ? strcmp(wanted, number) == 0
                                          : strstr(caps.deviceName, wanted) != NULL);
        if ((wanted && !named) || !caps.nonUniformIndexing || !can_run(h, devices[i]))
            continue;
        h->physical_device = devices[i];
        h->caps = caps;
        return true;
    }
    return false;
}

static uint32_t drawing_family(struct harness *h)
{
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = MAX_FAMILIES;
    h->GetPhysicalDeviceQueueFamilyProperties(h->physical_device, &count, families);
    const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; i++)
        if ((families[i].queueFlags & both) == both)
            return i;
    return 0;
}

/* Returns a family that copies and does not draw, or else the drawing family. */
static uint32_t copying_family(struct harness *h)
{
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = MAX_FAMILIES;
    h->GetPhysicalDeviceQueueFamilyProperties(h->physical_device, &count, families);
    for (uint32_t i = 0; i < count; i++)
        if (families[i].queueFlags & VK_QUEUE_TRANSFER_BIT &&
            !(families[i].queueFlags & (VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT)))
            return i;
    return h->family;
}

/* Lists each family once. Returns the number of queues. */
static uint32_t list_queues(struct harness *h, VkDeviceQueueCreateInfo queues[3])
{
    static const float priority = 1.0f;
    const uint32_t families[3] = {
        h->family, h->caps.sparse ? h->caps.sparseQueueFamilyIndex : h->family, h->upload_family};
    uint32_t count = 0;
    for (uint32_t i = 0; i < 3; i++) {
        bool listed = false;
        for (uint32_t j = 0; j < count; j++)
            listed |= queues[j].queueFamilyIndex == families[i];
        if (!listed)
            queues[count++] =
                (VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                          .queueFamilyIndex = families[i],
                                          .queueCount = 1,
                                          .pQueuePriorities = &priority};
    }
    return count;
}

/* Requirements of a test beyond the library's. */
struct extras {
    const char *const *extensions;
    uint32_t extension_count;
    void *features;
    const struct harness_newer *newer; ///< NULL: nothing
};

static bool has_extensions(struct harness *h, const struct extras *extras)
{
    static VkExtensionProperties there[512];
    uint32_t count = 512, found = 0;
    if (h->EnumerateDeviceExtensionProperties(h->physical_device, NULL, &count, there) < 0)
        return false;
    for (uint32_t i = 0; i < extras->extension_count; i++)
        for (uint32_t j = 0; j < count; j++)
            found += strcmp(extras->extensions[i], there[j].extensionName) == 0;
    return found == extras->extension_count;
}

static bool create_device(struct harness *h, const struct extras *extras)
{
    SluiceLogCallback log = {h, on_log};
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &vulkan12};
    VkPhysicalDeviceVulkan12Features there12 = vulkan12;
    VkPhysicalDeviceFeatures2 there = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                       .pNext = &there12};
    h->GetPhysicalDeviceFeatures2(h->physical_device, &there);
    features.features.shaderResourceResidency = there.features.shaderResourceResidency;
    features.features.shaderResourceMinLod = there.features.shaderResourceMinLod;
    /* The test shaders require it for pages, and are equal in all modes. */
    features.features.shaderSampledImageArrayDynamicIndexing = VK_TRUE;
    vulkan12.shaderSampledImageArrayNonUniformIndexing = VK_TRUE;
    features.features.samplerAnisotropy = there.features.samplerAnisotropy;
    vulkan12.samplerMirrorClampToEdge = there12.samplerMirrorClampToEdge;
    vulkan12.pNext = extras->features;
    vulkan12.bufferDeviceAddress = there12.bufferDeviceAddress;
    vulkan12.shaderStorageBufferArrayNonUniformIndexing =
        there12.shaderStorageBufferArrayNonUniformIndexing;
    h->reads_bytes =
        there12.bufferDeviceAddress && there12.shaderStorageBufferArrayNonUniformIndexing;
    h->anisotropy = there.features.samplerAnisotropy;
    h->mirror_clamp = there12.samplerMirrorClampToEdge;
    if (sluiceRequireVulkanFeatures(h->instance, h->physical_device, h->get, h->mode, &log,
                                    &features.features, &vulkan12) != SLUICE_SUCCESS)
        return false;
    if (h->mode == SLUICE_RESIDENCY_MODE_AUTO)
        h->mode = h->caps.sparse ? SLUICE_RESIDENCY_MODE_SPARSE : SLUICE_RESIDENCY_MODE_PAGED;
    h->family = drawing_family(h);
    const char *uploads = getenv("SLUICE_UPLOAD_QUEUE");
    h->upload_family = uploads ? copying_family(h) : h->family;
    VkDeviceQueueCreateInfo queues[3];
    const uint32_t queue_count = list_queues(h, queues);
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = &features,
                               .queueCreateInfoCount = queue_count,
                               .pQueueCreateInfos = queues,
                               .enabledExtensionCount = extras->extension_count,
                               .ppEnabledExtensionNames = extras->extensions};
    if (extras->newer)
        extras->newer->prepare(h, &info, &vulkan12, extras->newer->user);
    if (h->CreateDevice(h->physical_device, &info, NULL, &h->device) != VK_SUCCESS)
        return false;
#define LOAD(name) h->name = (PFN_vk##name)h->GetDeviceProcAddr(h->device, "vk" #name);
    HARNESS_DEVICE_FUNCTIONS(LOAD)
#undef LOAD
    h->GetDeviceQueue(h->device, h->family, 0, &h->queue);
    if (h->caps.sparse)
        h->GetDeviceQueue(h->device, h->caps.sparseQueueFamilyIndex, 0, &h->sparse_queue);
    if (uploads)
        h->GetDeviceQueue(h->device, h->upload_family, 0, &h->upload_queue);
    h->GetPhysicalDeviceMemoryProperties(h->physical_device, &h->memory);
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                    .queueFamilyIndex = h->family};
    if (h->CreateCommandPool(h->device, &pool, NULL, &h->pool) != VK_SUCCESS)
        return false;
    VkCommandBufferAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = h->pool,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = HARNESS_FRAMES};
    return h->AllocateCommandBuffers(h->device, &allocate, h->commands) == VK_SUCCESS;
}

/* Prints TAP for "all skipped". The returned status tells the build. */
static int no_device(struct harness *h, const char *why)
{
    harness_finish(h, 77);
    printf("1..0 # SKIP %s\n", why);
    return 77;
}

int harness_init(struct harness *h)
{
    return harness_init_with(h, NULL, 0, NULL);
}

static int init(struct harness *h, const struct extras *extras)
{
    *h = (struct harness){0};
    h->library = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (!h->library)
        return no_device(h, "there is no Vulkan loader (" LIBRARY ")");
    *(void **)&h->get = dlsym(h->library, "vkGetInstanceProcAddr"); /* conversion as in dlopen(3) */
    if (!h->get || !create_instance(h, extras->newer ? extras->newer->layer_version : 0))
        return no_device(h, "no Vulkan 1.2 instance can be created");
    if (!pick_mode(h)) {
        fprintf(stderr, "SLUICE_RESIDENCY is none of sparse, paged, dense and auto\n");
        harness_finish(h, 1);
        return 1;
    }
    if (!pick_device(h))
        return no_device(h, getenv("SLUICE_DEVICE")
                                ? "the device that SLUICE_DEVICE names is absent or lacks the mode"
                                : "no device has Vulkan 1.2 and what the residency mode needs");
    if (extras->extension_count && !has_extensions(h, extras))
        return no_device(h, "the device lacks an extension that this test is about");
    if (!create_device(h, extras) || harness_set_context(h, NULL) != SLUICE_SUCCESS)
        return 1;
    const char *abandon = getenv("SLUICE_ABANDON");
    h->abandon_one_in = abandon ? (uint32_t)strtoul(abandon, NULL, 10) : 0;
    fprintf(stderr, "# %s, residency %s, validation %s\n", h->caps.deviceName, h->mode_name,
            h->validates ? "on" : "absent");
    return 0;
}

int harness_init_with(struct harness *h, const char *const *extensions, uint32_t extension_count,
                      void *features)
{
    return init(h, &(struct extras){extensions, extension_count, features, NULL});
}

int harness_init_newer(struct harness *h, const struct harness_newer *newer)
{
    return init(h, &(struct extras){.newer = newer});
}

int harness_finish(struct harness *h, int status)
{
    h->failed = status != 0;
    if (h->device) {
        h->DeviceWaitIdle(h->device);
        sluiceDestroyVulkanContext(h->context);
        h->DestroyCommandPool(h->device, h->pool, NULL);
        for (uint32_t i = 0; i < HARNESS_PROBE_KINDS; i++)
            h->DestroyPipeline(h->device, h->probe_pipelines[i], NULL);
        for (uint32_t i = 0; i < HARNESS_PAINT_KINDS; i++)
            h->DestroyPipeline(h->device, h->paint_pipelines[i], NULL);
        h->DestroyDevice(h->device, NULL);
    }
    if (h->messenger)
        ((PFN_vkDestroyDebugUtilsMessengerEXT)h->get(
            h->instance, "vkDestroyDebugUtilsMessengerEXT"))(h->instance, h->messenger, NULL);
    if (h->instance)
        h->DestroyInstance(h->instance, NULL);
    if (status == 0 && h->message_count)
        status = 1;
    /* The loader stays loaded: threads and thread-local data of drivers may outlive an unload and
     * crash. */
    *h = (struct harness){0};
    return status;
}

SluiceVulkanContextCreateInfo harness_context_info(struct harness *h)
{
    return (SluiceVulkanContextCreateInfo){.structSize = sizeof(SluiceVulkanContextCreateInfo),
                                           .queueFamilyIndex = h->family,
                                           .instance = h->instance,
                                           .physicalDevice = h->physical_device,
                                           .device = h->device,
                                           .pfnGetInstanceProcAddr = h->get,
                                           .sparseQueue = h->sparse_queue,
                                           .sparseQueueFamilyIndex = h->caps.sparseQueueFamilyIndex,
                                           .uploadQueue = h->upload_queue,
                                           .uploadQueueFamilyIndex = h->upload_family,
                                           .log = {h, on_log}};
}

SluiceResult harness_set_context(struct harness *h, const SluiceVulkanContextCreateInfo *settings)
{
    const SluiceVulkanContextCreateInfo usual = harness_context_info(h);
    SluiceVulkanContextCreateInfo info = settings ? *settings : usual;
    info.structSize = usual.structSize;
    info.queueFamilyIndex = usual.queueFamilyIndex;
    info.instance = usual.instance;
    info.physicalDevice = usual.physicalDevice;
    info.device = usual.device;
    info.sparseQueue = usual.sparseQueue;
    info.sparseQueueFamilyIndex = usual.sparseQueueFamilyIndex;
    info.uploadQueue = usual.uploadQueue;
    info.uploadQueueFamilyIndex = usual.uploadQueueFamilyIndex;
    info.log = usual.log;
    if (!info.pfnGetInstanceProcAddr)
        info.pfnGetInstanceProcAddr = usual.pfnGetInstanceProcAddr;
    sluiceDestroyVulkanContext(h->context);
    return sluiceCreateVulkanContext(&info, &h->context);
}

/* Time stamps count frames here. Defaults in seconds would hide effects that tests look for. */
static void fill_times(SluiceVulkanStreamerCreateInfo *info)
{
    info->ticksPerSecond = 60;
    info->newestFeedbackMapOnly = info->feedbackTimeoutTicks == 0;
    info->noStandbyTiles = info->numExtraStandbyTiles == 0;
    if (info->retryDelayTicks == 0)
        info->retryDelayTicks = 1;
}

void harness_fill(struct harness *h, SluiceVulkanStreamerCreateInfo *info)
{
    info->structSize = sizeof *info;
    info->context = h->context;
    if (info->residencyMode == SLUICE_RESIDENCY_MODE_AUTO && !h->leaves_auto)
        info->residencyMode = h->mode;
    info->framesInFlight = HARNESS_FRAMES;
    fill_times(info);
}

void harness_buffer_init(struct harness *h, struct harness_buffer *buffer, uint64_t size,
                         VkBufferUsageFlags usage)
{
    *buffer = (struct harness_buffer){.size = size};
    VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    assert_int_equal(h->CreateBuffer(h->device, &info, NULL, &buffer->buffer), VK_SUCCESS);
    VkMemoryRequirements memory;
    h->GetBufferMemoryRequirements(h->device, buffer->buffer, &memory);
    const VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .allocationSize = memory.size,
                                     .memoryTypeIndex = UINT32_MAX};
    for (uint32_t i = 0; i < h->memory.memoryTypeCount; i++)
        if (memory.memoryTypeBits >> i & 1 &&
            (h->memory.memoryTypes[i].propertyFlags & wanted) == wanted) {
            allocate.memoryTypeIndex = i;
            /* the host reads results, so cached memory is preferred */
            if (h->memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
                break;
        }
    assert_int_equal(h->AllocateMemory(h->device, &allocate, NULL, &buffer->memory), VK_SUCCESS);
    assert_int_equal(h->BindBufferMemory(h->device, buffer->buffer, buffer->memory, 0), VK_SUCCESS);
    assert_int_equal(h->MapMemory(h->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->mapped),
                     VK_SUCCESS);
}

void harness_buffer_finish(struct harness *h, struct harness_buffer *buffer)
{
    h->DestroyBuffer(h->device, buffer->buffer, NULL);
    h->FreeMemory(h->device, buffer->memory, NULL);
    *buffer = (struct harness_buffer){0};
}

static void begin_commands(struct harness *h, VkCommandBuffer commands)
{
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    assert_int_equal(h->ResetCommandBuffer(commands, 0), VK_SUCCESS);
    assert_int_equal(h->BeginCommandBuffer(commands, &begin), VK_SUCCESS);
}

static void wait_for(struct harness *h, VkSemaphore semaphore, uint64_t value)
{
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &semaphore,
                                .pValues = &value};
    assert_int_equal(h->WaitSemaphores(h->device, &info, UINT64_MAX), VK_SUCCESS);
}

bool harness_abandons(struct harness *h)
{
    if (h->abandon_one_in == 0)
        return false;
    h->abandon_turn = h->abandon_turn * 1664525u + 1013904223u;
    bool abandons = (h->abandon_turn >> 16) % h->abandon_one_in == 0;
    h->abandoned_count += abandons;
    return abandons;
}

/* Abandons a frame after its begin, its commands or its end, and begins the command buffer
 * again. */
static void abandon_frame(struct harness *h, SluiceVulkanStreamer *streamer,
                          VkCommandBuffer commands,
                          void (*record)(void *user, VkCommandBuffer commands), void *user)
{
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    uint32_t length = h->abandoned_count % 3;
    CHECK_OK(sluiceBeginStreamingFrame(streamer, commands, h->time, &frame));
    h->set = frame.descriptorSet;
    if (record && length > 0)
        record(user, commands);
    if (length > 1)
        CHECK_OK(sluiceEndStreamingFrame(streamer, commands));
    CHECK_OK(sluiceAbandonStreamingFrame(streamer, &frame));
    assert_int_equal(h->ResetCommandBuffer(commands, 0), VK_SUCCESS);
    begin_commands(h, commands);
}

void harness_frame(struct harness *h, SluiceVulkanStreamer *streamer, bool wait,
                   void (*record)(void *user, VkCommandBuffer commands), void *user)
{
    uint32_t at = h->frame_count++ % HARNESS_FRAMES;
    VkCommandBuffer commands = h->commands[at];
    if (h->last[at].semaphore)
        wait_for(h, h->last[at].semaphore, h->last[at].signalValue);
    begin_commands(h, commands);
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    h->time++;
    while (harness_abandons(h))
        abandon_frame(h, streamer, commands, record, user);
    CHECK_OK(sluiceBeginStreamingFrame(streamer, commands, h->time, &frame));
    h->set = frame.descriptorSet;
    if (record)
        record(user, commands);
    CHECK_OK(sluiceEndStreamingFrame(streamer, commands));
    assert_int_equal(h->EndCommandBuffer(commands), VK_SUCCESS);
    VkTimelineSemaphoreSubmitInfo timeline = {.sType =
                                                  VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                              .waitSemaphoreValueCount = 1,
                                              .pWaitSemaphoreValues = &frame.uploadValue,
                                              .signalSemaphoreValueCount = 1,
                                              .pSignalSemaphoreValues = &frame.signalValue};
    VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                           .pNext = &timeline,
                           .waitSemaphoreCount = frame.uploadSemaphore ? 1 : 0,
                           .pWaitSemaphores = &frame.uploadSemaphore,
                           .pWaitDstStageMask = &stages,
                           .commandBufferCount = 1,
                           .pCommandBuffers = &commands,
                           .signalSemaphoreCount = 1,
                           .pSignalSemaphores = &frame.semaphore};
    assert_int_equal(h->QueueSubmit(h->queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    h->last[at] = frame;
    if (wait)
        wait_for(h, frame.semaphore, frame.signalValue);
}

void harness_destroy(struct harness *h, SluiceVulkanStreamer *streamer)
{
    SluiceVulkanStreamerStatistics counts = {.structSize = sizeof counts};
    if (h->upload_queue && sluiceGetVulkanStreamerStatistics(streamer, &counts) == SLUICE_SUCCESS) {
        fprintf(stderr, "# %llu copies on the upload queue\n",
                (unsigned long long)counts.uploadQueueCopies);
        h->upload_queue_copies += counts.uploadQueueCopies;
    }
    sluiceDestroyVulkanStreamer(streamer);
    for (uint32_t i = 0; i < HARNESS_FRAMES; i++)
        h->last[i] = (SluiceStreamingFrame){.structSize = sizeof(SluiceStreamingFrame)};
}

void harness_settle(struct harness *h, SluiceVulkanStreamer *streamer, uint32_t frame_count,
                    void (*record)(void *user, VkCommandBuffer commands), void *user)
{
    for (uint32_t i = 0; i < frame_count; i++) {
        CHECK_OK(sluiceWaitVulkanStreamerIdle(streamer));
        harness_frame(h, streamer, true, record, user);
    }
}

void harness_run(struct harness *h, void (*record)(void *user, VkCommandBuffer commands),
                 void *user)
{
    VkCommandBuffer commands = h->commands[0];
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    begin_commands(h, commands);
    record(user, commands);
    assert_int_equal(h->EndCommandBuffer(commands), VK_SUCCESS);
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                           .commandBufferCount = 1,
                           .pCommandBuffers = &commands};
    assert_int_equal(h->QueueSubmit(h->queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
}

void harness_check_silence(const struct harness *h)
{
    assert_int_equal(h->message_count, 0);
}

bool harness_is_software(struct harness *h)
{
    VkPhysicalDeviceProperties properties;
    h->GetPhysicalDeviceProperties(h->physical_device, &properties);
    return properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

float harness_level_error(struct harness *h)
{
    return harness_is_software(h) ? 0 : 0.125f;
}
