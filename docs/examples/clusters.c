/*
 * A compute shader (clusters.comp) bounds the visible clusters of a mesh of a million clusters. The
 * vertices of a cluster are a byte page. Pages that the shader misses are read, and it is launched
 * again, until nothing is missing. gpu.c has the plain Vulkan. Exit status 77: no device can page
 * and index arrays of buffers.
 */
#include "gpu.h"

#include <sluice/demand.h>

#include <stdio.h>
#include <string.h>

#include "clusters_comp.h" /* the SPIR-V */

#define CLUSTER_COUNT (1u << 20)
#define VISIBLE_COUNT 126 /* as in clusters.comp */
#define VERTEX_COUNT 256  /* per cluster, as in clusters.comp */

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
    struct gpu gpu;
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    SluiceDemandResourceId clusters;
    uint32_t first_page;
    struct answer *answer; /* mapped */
};

/* The shader indexes an array of buffers: byte pages lie in several. */
static bool can_page(VkInstance instance, VkPhysicalDevice device,
                     VkPhysicalDeviceFeatures *features, VkPhysicalDeviceVulkan12Features *vulkan12)
{
    VkPhysicalDeviceVulkan12Features there = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                     .pNext = &there};
    vkGetPhysicalDeviceFeatures2(device, &all);
    vulkan12->shaderStorageBufferArrayNonUniformIndexing = VK_TRUE;
    return there.shaderStorageBufferArrayNonUniformIndexing &&
           sluiceRequireVulkanFeatures(instance, device, vkGetInstanceProcAddr,
                                       SLUICE_RESIDENCY_MODE_PAGED, &log_callback, features,
                                       vulkan12) == SLUICE_SUCCESS;
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
    memcpy(pBytes, vertices, size); /* in order: the memory may be uncached */
    return SLUICE_SUCCESS;
}

static void create_loader(struct app *app)
{
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = app->gpu.family,
                                                   .instance = app->gpu.instance,
                                                   .physicalDevice = app->gpu.physical_device,
                                                   .device = app->gpu.device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .log = log_callback};
    SLUICE(sluiceCreateVulkanContext(&context, &app->context));
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .context = app->context, .memoryBudget = 64u << 20};
    SLUICE(sluiceCreateDemandLoader(&info, &app->loader));
    SluiceDemandResourceCreateInfo clusters = {.structSize = sizeof clusters,
                                               .pageCount = CLUSTER_COUNT,
                                               .pageSize = VERTEX_COUNT * sizeof(struct vertex),
                                               .pfnRead = read_cluster};
    SLUICE(sluiceAddDemandResource(app->loader, &clusters, &app->clusters, &app->first_page));
}

/* Set 0 is Sluice's and comes with each launch. Set 1 is the program's and has the answer. */
static void create_shader(struct app *app)
{
    VkDescriptorSetLayout set_0;
    SLUICE(sluiceGetDemandDescriptorSetLayout(app->loader, &set_0));
    app->answer = create_answer(&app->gpu, sizeof *app->answer);
    create_pipeline(&app->gpu, clusters_comp, sizeof clusters_comp, set_0, 0);
}

/* Returns how many clusters were missing. */
static uint32_t trace(struct app *app, SluiceDemandRequests *requests)
{
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    SluiceDemandTicket ticket;
    app->answer->missing = 0;
    begin_commands(&app->gpu);
    SLUICE(sluiceBeginDemandLaunch(app->loader, app->gpu.commands, &launch));

    bind_shader(&app->gpu, launch.descriptorSet);
    vkCmdDispatch(app->gpu.commands, VISIBLE_COUNT, 1, 1);

    SLUICE(sluiceEndDemandLaunch(app->loader, app->gpu.commands));
    submit(&app->gpu, launch.semaphore, launch.signalValue);

    /* Waits for the launch and begins to read; a preview would not wait for the ticket. */
    SLUICE(sluiceProcessDemandRequests(app->loader, &launch, UINT64_MAX, requests, &ticket));
    SLUICE(sluiceWaitDemandTicket(app->loader, ticket, UINT64_MAX, NULL));
    return app->answer->missing;
}

static void destroy(struct app *app)
{
    sluiceDestroyDemandLoader(app->loader); /* waits for its launches and reads */
    sluiceDestroyVulkanContext(app->context);
    destroy_gpu(&app->gpu);
}

static void check_bounds(const struct answer *answer)
{
    for (uint32_t i = 0; i < VISIBLE_COUNT; i++)
        for (uint32_t v = 0; v < VERTEX_COUNT; v++) {
            struct vertex vertex = vertex_of(answer->visible[i], v);
            for (uint32_t c = 0; c < 3; c++)
                check(vertex.position[c] >= answer->bounds[i].low[c] &&
                          vertex.position[c] <= answer->bounds[i].high[c],
                      "bounding a cluster");
        }
}

int main(void)
{
    struct app app = {0};
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    create_gpu(&app.gpu, VK_QUEUE_COMPUTE_BIT, can_page);
    create_loader(&app);
    create_shader(&app);
    app.answer->first_page = app.first_page;
    for (uint32_t i = 0; i < VISIBLE_COUNT; i++)
        app.answer->visible[i] = i * (CLUSTER_COUNT / VISIBLE_COUNT);
    for (uint32_t launch = 1; trace(&app, &requests) > 0; launch++)
        printf("launch %u: %u clusters missing, %u being read\n", launch, requests.missingCount,
               requests.servedCount);
    check_bounds(app.answer);

    SluiceDemandStatistics statistics = {.structSize = sizeof statistics};
    SLUICE(sluiceGetDemandStatistics(app.loader, &statistics));
    printf("%llu of %u clusters were read; they occupy %llu KiB\n",
           (unsigned long long)statistics.residentBytePageCount, CLUSTER_COUNT,
           (unsigned long long)statistics.byteMemorySize / 1024);
    check(statistics.residentBytePageCount == VISIBLE_COUNT, "reading visible clusters alone");
    destroy(&app);
    return 0;
}
