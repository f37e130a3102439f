/*
 * A compute shader (demand.comp) samples a few of a thousand textures; what it misses is loaded,
 * and it is launched again, until nothing is missing. gpu.c has the plain Vulkan. Exit status 77:
 * no device can page.
 */
#include "gpu.h"

#include <sluice/demand.h>

#include <stdio.h>

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
    struct gpu gpu;
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    SluiceDemandTextureId textures[TEXTURE_COUNT];
    struct answer *answer; /* mapped */
};

static bool can_page(VkInstance instance, VkPhysicalDevice device,
                     VkPhysicalDeviceFeatures *features, VkPhysicalDeviceVulkan12Features *vulkan12)
{
    return sluiceRequireVulkanFeatures(instance, device, vkGetInstanceProcAddr,
                                       SLUICE_RESIDENCY_MODE_PAGED, &log_callback, features,
                                       vulkan12) == SLUICE_SUCCESS;
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
    const SluiceDemandTextureCreateInfo texture = {
        .structSize = sizeof texture,
        .image = {.pfnOpen = open_image}, /* closed by sluiceDestroyImageSource */
        .pSampler =
            &(SluiceDemandSampler){.structSize = sizeof(SluiceDemandSampler), .maxAnisotropy = 8},
        .failureColor = {1, 0, 1, 1}};
    for (uint32_t i = 0; i < TEXTURE_COUNT; i++)
        SLUICE(sluiceAddDemandTexture(app->loader, &texture, &app->textures[i]));
}

/* Set 0 is Sluice's and comes with each launch. Set 1 is the program's and has the answer. */
static void create_shader(struct app *app)
{
    VkDescriptorSetLayout set_0;
    SLUICE(sluiceGetDemandDescriptorSetLayout(app->loader, &set_0));
    app->answer = create_answer(&app->gpu, sizeof *app->answer);
    create_pipeline(&app->gpu, demand_comp, sizeof demand_comp, set_0, 0);
}

/* Returns how many samples missed something. */
static uint32_t trace(struct app *app, SluiceDemandRequests *requests)
{
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    SluiceDemandTicket ticket;
    app->answer->missing = 0;
    begin_commands(&app->gpu);
    SLUICE(sluiceBeginDemandLaunch(app->loader, app->gpu.commands, &launch));

    bind_shader(&app->gpu, launch.descriptorSet);
    vkCmdDispatch(app->gpu.commands, 32, 32, 1);

    SLUICE(sluiceEndDemandLaunch(app->loader, app->gpu.commands));
    submit(&app->gpu, launch.semaphore, launch.signalValue);

    /* Waits for the launch and begins to read; a preview would not wait for the ticket. */
    SLUICE(sluiceProcessDemandRequests(app->loader, &launch, UINT64_MAX, requests, &ticket));
    SLUICE(sluiceWaitDemandTicket(app->loader, ticket, UINT64_MAX, NULL));
    return app->answer->missing;
}

static void destroy(struct app *app)
{
    sluiceDestroyDemandLoader(app->loader); /* waits for its launches, closes images */
    sluiceDestroyVulkanContext(app->context);
    destroy_gpu(&app->gpu);
}

int main(void)
{
    struct app app = {0};
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    create_gpu(&app.gpu, VK_QUEUE_COMPUTE_BIT, can_page);
    create_loader(&app);
    create_shader(&app);
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
