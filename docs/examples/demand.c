/*
 * A compute shader (demand.comp) samples a few of a thousand textures; what it misses is loaded,
 * and it is launched again, until nothing is missing. Exit status 77: no device can do that.
 */
#include <sluice/demand.h>

#include <stdio.h>
#include <stdlib.h>

#include "demand_comp.h" /* the SPIR-V */

#define TEXTURE_COUNT 1000
#define SAMPLED_COUNT 4

struct answer {       /* as in demand.comp */
    uint32_t missing; /* samples */
    uint32_t padding[3];
    float color[4];
    uint32_t textures[SAMPLED_COUNT];
};

struct app {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    SluiceDemandTextureId textures[TEXTURE_COUNT];
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

/** The first device that can page; on success `*features`, `*vulkan12` are what it must have. */
static bool choose_device(struct app *app, VkPhysicalDeviceFeatures *features,
                          VkPhysicalDeviceVulkan12Features *vulkan12)
{
    VkPhysicalDevice devices[16];
    uint32_t count = 16;
    if (vkEnumeratePhysicalDevices(app->instance, &count, devices) < 0)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        app->physical_device = devices[i];
        if (sluiceRequireVulkanFeatures(app->instance, devices[i], vkGetInstanceProcAddr,
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

static void paint_ramp(void *pUserData, uint32_t mipLevel, uint32_t x, uint32_t y, uint32_t width,
                       uint32_t height, float rgba[4])
{
    (void)pUserData;
    rgba[0] = ((float)x + 0.5f) / (float)width;
    rgba[1] = ((float)y + 0.5f) / (float)height;
    rgba[2] = mipLevel > 0 ? 1.0f : 0.0f;
    rgba[3] = 1.0f;
}

/* On a worker thread, for textures that are sampled. A renderer opens a file. */
static SluiceResult open_image(void *pUserData, SluiceImageSource **pSource)
{
    const SluiceProceduralImage image = {NULL, paint_ramp};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = 8192,
                                  .height = 8192,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "ramp"};
    (void)pUserData;
    return sluiceCreateProceduralImageSource(&image, &info, NULL, pSource);
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
    const SluiceDemandTextureCreateInfo texture = {
        .structSize = sizeof texture,
        .image = {.pfnOpen = open_image}, /* closed by sluiceDestroyImageSource */
        .pSampler =
            &(SluiceDemandSampler){.structSize = sizeof(SluiceDemandSampler), .maxAnisotropy = 8},
        .failureColor = {1, 0, 1, 1}};
    for (uint32_t i = 0; i < TEXTURE_COUNT; i++)
        SLUICE(sluiceAddDemandTexture(app->loader, &texture, &app->textures[i]));
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
                                     .codeSize = sizeof demand_comp,
                                     .pCode = demand_comp};
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

/* How many samples missed something. */
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
    vkCmdDispatch(app->commands, 32, 32, 1);

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
    for (uint32_t i = 0; i < SAMPLED_COUNT; i++) /* shaders take the low 32 bits */
        app.answer->textures[i] = (uint32_t)app.textures[i * TEXTURE_COUNT / SAMPLED_COUNT];
    uint32_t launches = 0;
    do {
        uint32_t missing = trace(&app, &requests);
        printf("launch %u: %u samples miss %u pages\n", ++launches, missing, requests.missingCount);
    } while (requests.missingCount > 0 && launches < 20);

    SluiceDemandStatistics statistics = {.structSize = sizeof statistics};
    SLUICE(sluiceGetDemandStatistics(app.loader, &statistics));
    printf("%u of %u textures opened, %u tiles, %.1f MB\n", (unsigned)statistics.texturesOpened,
           TEXTURE_COUNT, (unsigned)statistics.residentTileCount,
           (double)statistics.tileMemorySize * 1e-6);
    const float *color = app.answer->color;
    printf("color %.2f %.2f %.2f\n", (double)color[0], (double)color[1], (double)color[2]);
    bool sharp = requests.missingCount == 0 && app.answer->missing == 0 && color[2] == 0.0f &&
                 statistics.texturesOpened == SAMPLED_COUNT;
    destroy(&app);
    return sharp ? 0 : 1;
}
