/*
 * A mesh of a million clusters, of which a compute shader (clusters.comp) reads the visible ones.
 * The vertices of a cluster are a byte page: those that are missed are read, and the shader is
 * launched again, until nothing is missing. Exit status 77: no device can do that.
 */
#include <sluice/demand.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clusters_comp.h" /* the SPIR-V */

#define CLUSTER_COUNT (1u << 20)
#define VISIBLE_COUNT 126 /* as in clusters.comp, as the next one */
#define VERTEX_COUNT 256

struct vertex {
    float position[3];
    uint32_t color;
};

struct answer { /* as in clusters.comp */
    uint32_t first_page;
    uint32_t missing; /* clusters */
    uint32_t visible[VISIBLE_COUNT];
    struct {
        float low[4], high[4];
    } bounds[VISIBLE_COUNT];
};

struct app {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    SluiceDemandResourceId clusters;
    uint32_t first_page;
    VkBuffer answer_buffer;
    VkDeviceMemory answer_memory;
    struct answer *answer; /* mapped */
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool set_pool;
    VkDescriptorSet set;
    VkPipelineLayout pipeline_layout;
    VkPipeline pipeline;
    VkCommandPool command_pool;
    VkCommandBuffer commands;
};

static void check(bool good, const char *what)
{
    if (!good) {
        fprintf(stderr, "%s failed\n", what);
        exit(1);
    }
}
#define VK(call) check((call) == VK_SUCCESS, #call)
#define SLUICE(call) check((call) == SLUICE_SUCCESS, #call)

static void print_message(void *pUserData, SluiceLogSeverity severity, const char *pMessage)
{
    (void)pUserData, (void)severity;
    fprintf(stderr, "%s\n", pMessage);
}
static const SluiceLogCallback log_callback = {NULL, print_message};

static bool choose_family(struct app *app)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(app->physical_device, &count, families);
    for (app->family = 0; app->family < count; app->family++)
        if (families[app->family].queueFlags & VK_QUEUE_COMPUTE_BIT)
            return true;
    return false;
}

/** The first device that can page and index arrays of buffers; on success `*features`, `*vulkan12`
 *  are what it must have. */
static bool choose_device(struct app *app, VkPhysicalDeviceFeatures *features,
                          VkPhysicalDeviceVulkan12Features *vulkan12)
{
    VkPhysicalDevice devices[16];
    uint32_t count = 16;
    if (vkEnumeratePhysicalDevices(app->instance, &count, devices) < 0)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceVulkan12Features there = {
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
        VkPhysicalDeviceFeatures2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                         .pNext = &there};
        vkGetPhysicalDeviceFeatures2(devices[i], &all);
        app->physical_device = devices[i];
        vulkan12->shaderStorageBufferArrayNonUniformIndexing = VK_TRUE;
        if (there.shaderStorageBufferArrayNonUniformIndexing &&
            sluiceRequireVulkanFeatures(app->instance, devices[i], vkGetInstanceProcAddr,
                                        SLUICE_RESIDENCY_MODE_PAGED, &log_callback, features,
                                        vulkan12) == SLUICE_SUCCESS &&
            choose_family(app))
            return true;
    }
    return false;
}

static void create_device(struct app *app)
{
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                     .pApplicationInfo = &application};
    VK(vkCreateInstance(&instance, NULL, &app->instance));

    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &vulkan12};
    if (!choose_device(app, &features.features, &vulkan12))
        exit(77);
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                     .queueFamilyIndex = app->family,
                                     .queueCount = 1,
                                     .pQueuePriorities = &priority};
    VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                 .pNext = &features,
                                 .queueCreateInfoCount = 1,
                                 .pQueueCreateInfos = &queue};
    VK(vkCreateDevice(app->physical_device, &device, NULL, &app->device));
    vkGetDeviceQueue(app->device, app->family, 0, &app->queue);
}

/* A vertex of a cluster. A renderer reads a file. */
static struct vertex vertex_of(uint32_t cluster, uint32_t i)
{
    struct vertex vertex = {{(float)(cluster % 1024), (float)(cluster / 1024), 0}, cluster};
    vertex.position[0] += (float)(i * 97 % 256) / 256.0f;
    vertex.position[1] += (float)(i * 61 % 256) / 256.0f;
    vertex.position[2] = (float)((cluster ^ i) % 64);
    return vertex;
}

/* On a worker thread, for clusters that are visible. */
static SluiceResult read_cluster(void *pUserData, uint32_t page, uint32_t size, void *pBytes)
{
    struct vertex vertices[VERTEX_COUNT];
    (void)pUserData;
    for (uint32_t i = 0; i < VERTEX_COUNT; i++)
        vertices[i] = vertex_of(page, i);
    memcpy(pBytes, vertices, size);
    return SLUICE_SUCCESS;
}

static void create_loader(struct app *app)
{
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = app->family,
                                                   .instance = app->instance,
                                                   .physicalDevice = app->physical_device,
                                                   .device = app->device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .log = log_callback};
    SLUICE(sluiceCreateVulkanContext(&context, &app->context));
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .context = app->context, .memoryBudget = 64u << 20};
    SLUICE(sluiceCreateDemandLoader(&info, &app->loader));
    const SluiceDemandResourceCreateInfo clusters = {.structSize = sizeof clusters,
                                                     .pageCount = CLUSTER_COUNT,
                                                     .pageSize =
                                                         VERTEX_COUNT * sizeof(struct vertex),
                                                     .pfnRead = read_cluster};
    SLUICE(sluiceAddDemandResource(app->loader, &clusters, &app->clusters, &app->first_page));
}

static uint32_t find_host_memory(const struct app *app, uint32_t type_bits)
{
    const VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(app->physical_device, &memory);
    for (uint32_t i = 0; i < memory.memoryTypeCount; i++)
        if ((type_bits >> i & 1) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted)
            return i;
    check(false, "finding host memory");
    return 0;
}

static void create_answer(struct app *app)
{
    VkBufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                 .size = sizeof(struct answer),
                                 .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    VK(vkCreateBuffer(app->device, &buffer, NULL, &app->answer_buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(app->device, app->answer_buffer, &needs);
    VkMemoryAllocateInfo memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                   .allocationSize = needs.size,
                                   .memoryTypeIndex = find_host_memory(app, needs.memoryTypeBits)};
    VK(vkAllocateMemory(app->device, &memory, NULL, &app->answer_memory));
    VK(vkBindBufferMemory(app->device, app->answer_buffer, app->answer_memory, 0));
    VK(vkMapMemory(app->device, app->answer_memory, 0, VK_WHOLE_SIZE, 0, (void **)&app->answer));
}

/* Set 1 holds the answer alone: set 0 comes with each launch. */
static void create_set(struct app *app)
{
    const VkDescriptorSetLayoutBinding binding = {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                                  VK_SHADER_STAGE_COMPUTE_BIT, NULL};
    VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings = &binding};
    VK(vkCreateDescriptorSetLayout(app->device, &layout, NULL, &app->set_layout));
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1,
                                       .poolSizeCount = 1,
                                       .pPoolSizes = &size};
    VK(vkCreateDescriptorPool(app->device, &pool, NULL, &app->set_pool));
    VkDescriptorSetAllocateInfo set = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                       .descriptorPool = app->set_pool,
                                       .descriptorSetCount = 1,
                                       .pSetLayouts = &app->set_layout};
    VK(vkAllocateDescriptorSets(app->device, &set, &app->set));
    const VkDescriptorBufferInfo buffer = {app->answer_buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = app->set,
                                        .descriptorCount = 1,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = &buffer};
    vkUpdateDescriptorSets(app->device, 1, &write, 0, NULL);
}

static void create_pipeline(struct app *app)
{
    VkDescriptorSetLayout sets[2] = {VK_NULL_HANDLE, app->set_layout};
    SLUICE(sluiceGetDemandDescriptorSetLayout(app->loader, &sets[0]));
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 2,
                                         .pSetLayouts = sets};
    VK(vkCreatePipelineLayout(app->device, &layout, NULL, &app->pipeline_layout));
    VkShaderModuleCreateInfo code = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                     .codeSize = sizeof clusters_comp,
                                     .pCode = clusters_comp};
    VkShaderModule module;
    VK(vkCreateShaderModule(app->device, &code, NULL, &module));
    VkComputePipelineCreateInfo pipeline = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main"},
        .layout = app->pipeline_layout};
    VK(vkCreateComputePipelines(app->device, VK_NULL_HANDLE, 1, &pipeline, NULL, &app->pipeline));
    vkDestroyShaderModule(app->device, module, NULL);
}

static void create_commands(struct app *app)
{
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                    .queueFamilyIndex = app->family};
    VK(vkCreateCommandPool(app->device, &pool, NULL, &app->command_pool));
    VkCommandBufferAllocateInfo buffers = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = app->command_pool,
                                           .commandBufferCount = 1};
    VK(vkAllocateCommandBuffers(app->device, &buffers, &app->commands));
}

static void submit(const struct app *app, const SluiceDemandLaunch *launch)
{
    VkTimelineSemaphoreSubmitInfo values = {.sType =
                                                VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                            .signalSemaphoreValueCount = 1,
                                            .pSignalSemaphoreValues = &launch->signalValue};
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .pNext = &values,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &app->commands,
                         .signalSemaphoreCount = 1,
                         .pSignalSemaphores = &launch->semaphore};
    VK(vkQueueSubmit(app->queue, 1, &info, VK_NULL_HANDLE));
}

/* How many clusters were missing. */
static uint32_t trace(struct app *app, SluiceDemandRequests *requests)
{
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    SluiceDemandTicket ticket;
    app->answer->missing = 0;
    VK(vkBeginCommandBuffer(app->commands, &begin));
    SLUICE(sluiceBeginDemandLaunch(app->loader, app->commands, &launch));

    const VkDescriptorSet sets[] = {launch.descriptorSet, app->set};
    vkCmdBindPipeline(app->commands, VK_PIPELINE_BIND_POINT_COMPUTE, app->pipeline);
    vkCmdBindDescriptorSets(app->commands, VK_PIPELINE_BIND_POINT_COMPUTE, app->pipeline_layout, 0,
                            2, sets, 0, NULL);
    vkCmdDispatch(app->commands, VISIBLE_COUNT, 1, 1);

    SLUICE(sluiceEndDemandLaunch(app->loader, app->commands));
    VkMemoryBarrier to_host = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(app->commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                         VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, NULL, 0, NULL);
    VK(vkEndCommandBuffer(app->commands));
    submit(app, &launch);

    /* Waits for the launch and begins to read; a preview would not wait for the ticket. */
    SLUICE(sluiceProcessDemandRequests(app->loader, &launch, UINT64_MAX, requests, &ticket));
    SLUICE(sluiceWaitDemandTicket(app->loader, ticket, UINT64_MAX, NULL));
    return app->answer->missing;
}

static void destroy(struct app *app)
{
    sluiceDestroyDemandLoader(app->loader); /* waits for the device, closes what was opened */
    sluiceDestroyVulkanContext(app->context);
    vkDestroyCommandPool(app->device, app->command_pool, NULL);
    vkDestroyPipeline(app->device, app->pipeline, NULL);
    vkDestroyPipelineLayout(app->device, app->pipeline_layout, NULL);
    vkDestroyDescriptorPool(app->device, app->set_pool, NULL);
    vkDestroyDescriptorSetLayout(app->device, app->set_layout, NULL);
    vkDestroyBuffer(app->device, app->answer_buffer, NULL);
    vkFreeMemory(app->device, app->answer_memory, NULL);
    vkDestroyDevice(app->device, NULL);
    vkDestroyInstance(app->instance, NULL);
}

int main(void)
{
    struct app app = {0};
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    create_device(&app);
    create_loader(&app);
    create_answer(&app);
    create_set(&app);
    create_pipeline(&app);
    create_commands(&app);
    app.answer->first_page = app.first_page;
    for (uint32_t i = 0; i < VISIBLE_COUNT; i++)
        app.answer->visible[i] = i * (CLUSTER_COUNT / VISIBLE_COUNT);
    for (uint32_t launch = 1; trace(&app, &requests) > 0; launch++)
        printf("launch %u: %u clusters missing, %u being read\n", launch, requests.missingCount,
               requests.servedCount);
    for (uint32_t i = 0; i < VISIBLE_COUNT; i++)
        for (uint32_t v = 0; v < VERTEX_COUNT; v++) {
            struct vertex vertex = vertex_of(app.answer->visible[i], v);
            for (uint32_t c = 0; c < 3; c++)
                check(vertex.position[c] >= app.answer->bounds[i].low[c] &&
                          vertex.position[c] <= app.answer->bounds[i].high[c],
                      "bounding a cluster");
        }
    SluiceDemandStatistics statistics = {.structSize = sizeof statistics};
    SLUICE(sluiceGetDemandStatistics(app.loader, &statistics));
    printf("%llu of %u clusters were read; they occupy %llu KiB\n",
           (unsigned long long)statistics.residentBytePageCount, CLUSTER_COUNT,
           (unsigned long long)statistics.byteMemorySize / 1024);
    check(statistics.residentBytePageCount == VISIBLE_COUNT, "reading visible clusters alone");
    destroy(&app);
    return 0;
}
