/*
 * The lines that docs/demand.md shows, compiled as they are there. A program that runs is demand.c.
 */
#include <sluice/demand.h>
#include <sluice/store.h>

static void begin(VkCommandBuffer commandBuffer)
{
    (void)commandBuffer;
}

static void trace(VkCommandBuffer commandBuffer)
{
    (void)commandBuffer;
}

static void submit(VkCommandBuffer commandBuffer, VkSemaphore semaphore, uint64_t value)
{
    (void)commandBuffer, (void)semaphore, (void)value;
}

SluiceDemandLoader *page_create_loader(VkInstance instance, VkPhysicalDevice physicalDevice,
                                       VkDevice device, uint32_t family);
SluiceDemandLoader *page_create_loader(VkInstance instance, VkPhysicalDevice physicalDevice,
                                       VkDevice device, uint32_t family)
{
    SluiceVulkanContextCreateInfo contextInfo = {.structSize = sizeof contextInfo,
                                                 .queueFamilyIndex = family,
                                                 .instance = instance,
                                                 .physicalDevice = physicalDevice,
                                                 .device = device,
                                                 .pfnGetInstanceProcAddr = vkGetInstanceProcAddr};
    SluiceVulkanContext *context;
    sluiceCreateVulkanContext(&contextInfo, &context); /* one per device; streamers share it */

    SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .context = context, .memoryBudget = 4ull << 30};
    SluiceDemandLoader *loader;
    sluiceCreateDemandLoader(&info, &loader);
    return loader;
}

/* On a worker thread. SLUICE_NOT_READY: ask again later. */
static SluiceResult open_texture(void *user, SluiceImageSource **source)
{
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info, .pPath = user};
    return sluiceCreateStoreImageSource(&info, source);
}

SluiceDemandTextureId page_create_texture(SluiceDemandLoader *loader, char *path);
SluiceDemandTextureId page_create_texture(SluiceDemandLoader *loader, char *path)
{
    SluiceDemandTextureId id = 0;
    SluiceDemandTextureCreateInfo texture = {
        .structSize = sizeof texture,
        .image = {.pUserData = path, .pfnOpen = open_texture},
        .pSampler =
            &(SluiceDemandSampler){.structSize = sizeof(SluiceDemandSampler), .maxAnisotropy = 16},
        .failureColor = {1, 0, 1, 1}};
    sluiceAddDemandTexture(loader, &texture, &id); /* shaders get (uint32_t)id */
    return id;
}

void page_launch_until_complete(SluiceDemandLoader *loader, VkCommandBuffer commandBuffer);
void page_launch_until_complete(SluiceDemandLoader *loader, VkCommandBuffer commandBuffer)
{
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    SluiceDemandTicket ticket;
    do {
        begin(commandBuffer);
        sluiceBeginDemandLaunch(loader, commandBuffer, &launch);
        trace(commandBuffer);
        sluiceEndDemandLaunch(loader, commandBuffer);
        submit(commandBuffer, launch.semaphore, launch.signalValue);
        sluiceProcessDemandRequests(loader, &launch, UINT64_MAX, &requests, &ticket);
        sluiceWaitDemandTicket(loader, ticket, UINT64_MAX, NULL);
    } while (requests.missingCount > 0);
}

void page_launch_interactively(SluiceDemandLoader *loader, VkCommandBuffer commandBuffer,
                               bool running);
void page_launch_interactively(SluiceDemandLoader *loader, VkCommandBuffer commandBuffer,
                               bool running)
{
    SluiceDemandLaunch oldest = {.structSize = sizeof oldest},
                       launch = {.structSize = sizeof launch};
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    while (running) {
        if (sluiceBeginDemandLaunch(loader, commandBuffer, &launch) == SLUICE_NOT_READY) {
            sluiceProcessDemandRequests(loader, &oldest, UINT64_MAX, &requests, NULL);
            continue;
        }
        /* trace, end the launch, submit, and keep it behind those under way */
    }
}

static uint64_t build(uint32_t page)
{
    return page;
}

void page_answer(SluiceDemandLoader *loader, SluiceDemandResourceId resource);
void page_answer(SluiceDemandLoader *loader, SluiceDemandResourceId resource)
{
    uint32_t pages[64], count = 64;
    sluiceGetMissedDemandPages(loader, resource, &count, pages);
    for (uint32_t i = 0; i < count; i++)
        sluiceSetDemandPageValue(loader, resource, pages[i], build(pages[i]), false);
}
