/* Lines that neural-streaming.md shows. Compiled, not run. */
#include <sluice/demand.h>
#include <sluice/neural_pages.h>
#include <sluice/vulkan_neural.h>

struct material {
    const SluiceNeuralSet *set;
    SluiceNeuralPages pages;
};

SluiceResult add_albedo(SluiceVulkanNeuralDecoder *decoder, SluiceVulkanStreamer *streamer,
                        SluiceVulkanTexture *pTexture);
SluiceResult add_albedo(SluiceVulkanNeuralDecoder *decoder, SluiceVulkanStreamer *streamer,
                        SluiceVulkanTexture *pTexture)
{
    const SluiceNeuralColorSpace sRGB = SLUICE_NEURAL_COLOR_SRGB;
    const SluiceTileProducer *pProducer;
    SluiceResult result;
    const SluiceVulkanNeuralOutput albedo = {.structSize = sizeof albedo,
                                             .format = SLUICE_FORMAT_BC7_SRGB_BLOCK,
                                             .channelCount = 3,
                                             .from = {sRGB, sRGB, sRGB},
                                             .to = {sRGB, sRGB, sRGB}};
    result = sluiceAddVulkanNeuralOutput(decoder, &albedo, &pProducer);
    if (result == SLUICE_SUCCESS) {
        SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .pProducer = pProducer};
        result = sluiceAddVulkanTexture(streamer, &info, pTexture);
    }
    return result;
}

SluiceResult add_pages(SluiceDemandLoader *loader, struct material *material,
                       SluiceDemandResourceId *pResource, uint32_t *pFirstPage);

static SluiceResult read_page(void *pUserData, uint32_t page, uint32_t size, void *pBytes)
{
    const struct material *material = pUserData;
    (void)size; /* pageSize */
    return sluiceReadNeuralPage(material->set, &material->pages, page, pBytes);
}

SluiceResult add_pages(SluiceDemandLoader *loader, struct material *material,
                       SluiceDemandResourceId *pResource, uint32_t *pFirstPage)
{
    SluiceResult result = sluiceLayOutNeuralPages(material->set, 65536, &material->pages);
    if (result == SLUICE_SUCCESS) {
        SluiceDemandResourceCreateInfo info = {.structSize = sizeof info,
                                               .pageCount = material->pages.pageCount,
                                               .pageSize = material->pages.pageSize,
                                               .pUserData = material,
                                               .pfnRead = read_page};
        result = sluiceAddDemandResource(loader, &info, pResource, pFirstPage);
    }
    return result;
}
