/* NULL and zero in every argument of the functions of sluice-vulkan. */
#include "device/harness.h"
#include "null_arguments/calls.h"

#include <sluice/demand.h>
#include <sluice/neural_compress.h>
#include <sluice/neural_paths.h>
#include <sluice/demand_query.h>
#include <sluice/demand_strict.h>
#include <sluice/vulkan_control.h>
#include <sluice/vulkan_strict.h>
#include <sluice/vulkan_explain.h>
#include <sluice/vulkan_neural.h>
#include <sluice/vulkan_proxy.h>

#include <stdio.h>
#include <stdlib.h>

/* clang-format off */
/* CALLS
sluiceGetVulkanDeviceCapabilities(f->h->instance, f->h->physical_device, f->h->get, &f->out.caps)
sluiceGetVulkanFormatCapabilities(f->h->instance, f->h->physical_device, f->h->get, SLUICE_FORMAT_R8G8B8A8_UNORM, &f->out.format)
!sluiceGetVulkanSparseImageLayout(f->h->instance, f->h->physical_device, f->h->device, f->h->get, ?NULL, &f->info, &f->out.sparse)
sluiceRequireVulkanFeatures(f->h->instance, f->h->physical_device, f->h->get, f->h->mode, ?NULL, &f->out.features, &f->out.features12)
sluiceCreateVulkanContext(&f->context_info, &f->out.context) => sluiceDestroyVulkanContext(f->out.context)
!sluiceDestroyVulkanContext(f->h->context)
sluiceSetVulkanMemoryBudget(f->h->context, ?0)
sluiceGetVulkanContextStatistics(f->h->context, &f->out.context_statistics)
sluiceCreateVulkanStreamer(&f->streamer_info, &f->out.streamer) => sluiceDestroyVulkanStreamer(f->out.streamer)
!sluiceDestroyVulkanStreamer(f->streamer)
sluiceCompactVulkanStreamer(f->streamer, ?1, &f->out.page)
sluiceWaitVulkanStreamerIdle(f->streamer)
sluiceResolveAllVulkanTextures(f->streamer)
sluiceStepVulkanLoads(f->streamer, ?1)
sluiceAddVulkanTexture(f->streamer, &f->texture_info, &f->out.texture)
sluiceAddVulkanTextureArray(f->streamer, &f->texture_info, 1, &f->out.texture)
sluiceRemoveVulkanTexture(f->streamer, f->texture.textureId)
sluiceGetVulkanSampler(f->streamer, f->texture.textureId, &f->out.sampler_handle)
sluiceGetVulkanBuffers(f->streamer, &f->out.buffers)
sluiceGetVulkanPages(f->streamer, &f->out.pages)
sluiceGetVulkanDescriptorSetLayout(f->streamer, &f->out.set_layout)
sluiceBeginStreamingFrame(f->streamer, f->commands, 2, &f->out.frame) => sluiceAbandonStreamingFrame(f->streamer, &f->out.frame)
!sluiceEndStreamingFrame(f->streamer, f->commands)
!sluiceAbandonStreamingFrame(f->streamer, &f->frame)
sluiceGetVulkanStreamerSettings(f->streamer, &f->settings)
sluiceSetVulkanStreamerSettings(f->streamer, &f->settings)
sluiceGetVulkanStreamerStatistics(f->streamer, &f->out.statistics)
sluiceGetVulkanReadStatistics(f->streamer, ?f->source, &f->out.reads)
sluiceRetryVulkanSource(f->streamer, ?f->source)
sluiceGetVulkanResidencyMode(f->streamer, &f->out.mode)
sluiceChooseVulkanResidencyMode(&f->h->caps, f->h->mode, 1, &f->out.mode)
sluiceGetVulkanStreamerManager(f->streamer, &f->out.manager)
sluiceGetVulkanTextureState(f->streamer, f->texture.textureId, ?NULL, &f->out.texture_state)
sluiceExplainVulkanTexture(f->streamer, f->texture.textureId, ?NULL, &f->out.explanation)
sluiceGetVulkanLoadStages(f->streamer, &f->out.stages)
sluiceWriteVulkanFeedback(f->streamer, f->texture.textureId, 64, sizeof f->out.feedback, f->out.feedback)
sluiceRequestVulkanTexture(f->streamer, f->texture.textureId, &f->request, ?&f->out.request)
sluiceGetVulkanRequestProgress(f->streamer, f->request_id, &f->out.request_progress)
sluiceWaitVulkanRequest(f->streamer, f->request_id, ?0, &f->out.wait)
sluiceWithdrawVulkanRequest(f->streamer, f->request_id)
sluiceGetVulkanTextureControl(f->streamer, f->texture.textureId, &f->out.control)
sluiceSetVulkanTextureControl(f->streamer, f->texture.textureId, &f->control)
sluiceEvictVulkanTexture(f->streamer, f->texture.textureId, ?1)
sluiceSetVulkanPrimaryTexture(f->streamer, f->texture.textureId, ?SLUICE_NO_TEXTURE)
sluiceSetVulkanStrictMode(f->streamer, ?NULL)
!sluiceReleaseVulkanSource(f->streamer, f->source)
sluiceInvalidateVulkanTexture(f->streamer, f->texture.textureId, ?NULL, ?1)
sluiceReplaceVulkanSource(f->streamer, f->texture.textureId, f->source)
sluiceIsVulkanSourceInUse(f->streamer, f->source, &f->out.in_use)
sluiceSetVulkanUvTransform(f->streamer, f->texture.textureId, ?&f->uv)

sluiceCreateNeuralCompressor(f->h->context, &f->compressor_info, &f->out.compressor) => sluiceDestroyNeuralCompressor(f->out.compressor)
!sluiceDestroyNeuralCompressor(f->compressor)
sluiceRecordNeuralTraining(f->compressor, f->commands, ?1, &f->out.page)
sluiceRecordNeuralReadback(f->compressor, f->commands)
sluiceGetNeuralProgress(f->compressor, &f->out.progress)
sluiceGetNeuralCheckpoint(f->compressor, ?f->checkpoint, checkpoint_size(f))
sluiceGetNeuralTrainedSet(f->compressor, &f->out.trained)

sluiceCreateDemandLoader(&f->loader_info, &f->out.loader) => sluiceDestroyDemandLoader(f->out.loader)
!sluiceDestroyDemandLoader(f->loader)
sluiceAddDemandTexture(f->loader, &f->demand_info, &f->out.id)
sluiceAddDemandTextureVariant(f->loader, f->id, &f->sampler, &f->out.id)
sluiceAddDemandGrid(f->loader, &f->grid_info, &f->out.id)
sluiceRemoveDemandTexture(f->loader, f->id)
sluiceReplaceDemandImage(f->loader, f->id, &f->demand_info.image)
sluiceInvalidateDemandTexture(f->loader, f->id)
sluiceRetryDemandTexture(f->loader, f->id)
sluiceRemakeDemandTiles(f->loader, f->made, ?NULL, ?1)
sluiceRemakeDemandPages(f->loader, f->made_pages, 0, 1)
sluicePreloadDemandTexture(f->loader, f->id, 0, ?&f->out.ticket)
sluicePreloadDemandRegion(f->loader, f->id, &f->demand_region, ?&f->out.ticket)
sluiceAddDemandResource(f->loader, &f->resource_info, &f->out.resource, &f->out.page)
sluiceRemoveDemandResource(f->loader, f->resource)
sluiceInvalidateDemandPages(f->loader, f->resource, 0, 1)
sluiceGetMissedDemandPages(f->loader, f->resource, &f->out.page_count, &f->out.page)
sluiceSetDemandPageValue(f->loader, f->resource, 0, ?1, ?true)
sluiceSetDemandPageBytes(f->loader, f->bytes, 0, &f->out.page, ?true)
sluiceAddDemandProxies(f->loader, f->set, ?0, &f->out.resource, &f->out.page)
sluiceProcessDemandProxies(f->loader, f->proxies, f->set)
sluiceGetProxyGeometry(f->set, 256, &f->out.geometry)
sluiceCreateVulkanNeuralDecoder(&f->decoder_info, &f->out.decoder) => sluiceDestroyVulkanNeuralDecoder(f->out.decoder)
!sluiceDestroyVulkanNeuralDecoder(f->decoder)
sluiceAddVulkanNeuralOutput(f->decoder, &f->neural_output, &f->out.producer)
sluiceGetNeuralPaths(f->h->instance, f->h->physical_device, f->h->get, ?NULL, &f->out.paths)
sluiceRequireNeuralPaths(&f->paths, ?NULL, &f->out.features12, &f->out.path_features)
!sluiceConvertNeuralWeights(&f->convert_info, &f->convert_size, ?NULL)
sluiceGetDemandBuffers(f->loader, &f->out.demand_buffers)
sluiceGetDemandPages(f->loader, &f->out.pages)
sluiceGetDemandByteBuffers(f->loader, &f->out.byte_buffers)
sluiceGetDemandDescriptorSetLayout(f->loader, &f->out.set_layout)
sluiceBeginDemandLaunch(f->loader, f->commands, &f->out.launch) => sluiceAbandonDemandLaunch(f->loader, &f->out.launch)
!sluiceEndDemandLaunch(f->loader, f->commands)
!sluiceAbandonDemandLaunch(f->loader, &f->launch)
!sluiceProcessDemandRequests(f->loader, &f->launch, 1, &f->out.requests, ?&f->out.ticket)
sluiceGetDemandTicketStatus(f->loader, 0, &f->out.ticket_status)
sluiceWaitDemandTicket(f->loader, 0, 1, ?&f->out.ticket_status)
sluiceCancelDemandTicket(f->loader, 0)
!sluiceAbortDemandLoader(f->loader)
sluiceBeginDemandRecording(f->fresh_loader, &f->recording, &f->out.recorder) => sluiceEndRecording(f->out.recorder)
sluiceGetDemandLoaderSettings(f->loader, &f->loader_settings)
sluiceSetDemandLoaderSettings(f->loader, &f->loader_settings)
sluiceGetDemandTileInfo(f->loader, f->id, 0, 0, 0, &f->out.tile_info)
sluiceGetDemandRegionProgress(f->loader, f->id, ?NULL, &f->out.region_progress)
sluiceWaitDemandRegion(f->loader, f->id, ?NULL, ?0, &f->out.demand_wait)
sluiceGetDemandMisses(f->loader, &f->out.miss_count, ?f->out.misses)
sluiceGetDemandSlotImages(f->loader, &f->out.image_count, ?f->out.slot_images)
sluiceGetDemandSlots(f->loader, &f->out.slot_count, ?f->out.slots)
sluiceSetDemandStrictMode(f->loader, ?NULL)
sluiceIsDemandSourceInUse(f->loader, f->source, &f->out.in_use)
!sluiceReleaseDemandSource(f->loader, f->source)
sluiceGetDemandStatistics(f->loader, &f->out.demand_statistics)
*/
/* clang-format on */

struct fixture {
    struct harness *h;
    VkCommandBuffer commands; ///< begun
    SluiceImageInfo info;
    SluiceImageSource *source;
    SluiceVulkanContextCreateInfo context_info;
    SluiceVulkanStreamerCreateInfo streamer_info;
    SluiceVulkanStreamer *streamer;
    SluiceStreamingFrame frame;
    SluiceVulkanTextureCreateInfo texture_info;
    SluiceVulkanTexture texture;
    SluiceVulkanStreamerSettings settings;
    SluiceVulkanTextureRequest request;
    SluiceTextureRequestId request_id;
    SluiceVulkanTextureControl control;
    SluiceUvTransform uv;
    SluiceDemandLoaderSettings loader_settings;
    SluiceDemandLoaderCreateInfo loader_info;
    SluiceDemandLoader *loader, *fresh_loader;
    SluiceFileRecordingInfo recording;
    SluiceDemandTextureCreateInfo demand_info;
    SluiceDemandSampler sampler;
    SluiceDemandTextureId id;
    SluiceImageRegion demand_region;
    SluiceDemandGridCreateInfo grid_info;
    SluiceDemandResourceCreateInfo resource_info;
    SluiceDemandResourceId resource, bytes, proxies, made_pages;
    SluiceDemandTextureId made;
    SluiceProxySet *set;
    SluiceDemandLaunch launch;
    SluiceNeuralCompressorCreateInfo compressor_info;
    SluiceNeuralTrainingChannel channel;
    const float *mips[1];
    float texel;
    SluiceNeuralCompressor *compressor;
    void *checkpoint;
    size_t checkpoint_size;
    SluiceNeuralPaths paths;
    SluiceNeuralConvertInfo convert_info;
    uint64_t convert_size;
    SluiceVulkanNeuralDecoderCreateInfo decoder_info;
    SluiceVulkanNeuralDecoder *decoder;
    SluiceVulkanNeuralOutput neural_output;
    struct {
        SluiceNeuralPaths paths;
        SluiceNeuralPathFeatures path_features;
        SluiceVulkanNeuralDecoder *decoder;
        const SluiceTileProducer *producer;
        SluiceResidencyMode mode;
        SluiceVulkanDeviceCapabilities caps;
        SluiceVulkanFormatCapabilities format;
        SluiceVulkanSparseImageLayout sparse;
        VkPhysicalDeviceFeatures features;
        VkPhysicalDeviceVulkan12Features features12;
        SluiceVulkanContext *context;
        SluiceVulkanContextStatistics context_statistics;
        SluiceVulkanStreamer *streamer;
        SluiceVulkanTexture texture;
        SluiceVulkanBuffers buffers;
        SluiceVulkanPages pages;
        VkDescriptorSetLayout set_layout;
        VkSampler sampler_handle;
        SluiceStreamingFrame frame;
        SluiceVulkanStreamerStatistics statistics;
        SluiceVulkanTextureState texture_state;
        SluiceVulkanExplanation explanation;
        SluiceDemandTileInfo tile_info;
        SluiceDemandRegionProgress region_progress;
        SluiceDemandWaitStatus demand_wait;
        SluiceDemandMiss misses[1];
        SluiceDemandSlotImage slot_images[1];
        SluiceDemandSlot slots[1];
        uint32_t miss_count, slot_count, image_count;
        SluiceVulkanLoadStages stages;
        uint8_t feedback[4096];
        SluiceTextureRequestId request;
        SluiceVulkanTextureControl control;
        bool in_use;
        SluiceVulkanWaitStatus wait;
        SluiceVulkanRequestProgress request_progress;
        SluiceTileLoaderStatistics reads;
        SluiceDemandLoader *loader;
        SluiceDemandTextureId id;
        SluiceDemandTicket ticket;
        SluiceDemandResourceId resource;
        SluiceProxyGeometry geometry;
        uint32_t page, page_count;
        SluiceDemandBuffers demand_buffers;
        SluiceDemandByteBuffers byte_buffers;
        SluiceDemandLaunch launch;
        SluiceDemandRequests requests;
        SluiceStreamedTextureManager *manager;
        SluiceRecorder *recorder;
        SluiceDemandTicketStatus ticket_status;
        SluiceDemandStatistics demand_statistics;
        SluiceNeuralCompressor *compressor;
        SluiceNeuralProgress progress;
        SluiceNeuralTrainedSet trained;
    } out;
};

CALLS_FUNCTIONS

static size_t *checkpoint_size(struct fixture *f)
{
    return &f->checkpoint_size;
}

static struct harness h;

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)level, (void)x, (void)y, (void)width, (void)height;
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 0.5f;
}

static SluiceResult fill(void *user, uint32_t page, uint64_t *value)
{
    (void)user;
    *value = page;
    return SLUICE_SUCCESS;
}

static void init_streamer(struct fixture *f)
{
    f->streamer_info =
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .maxTextureCount = 8,
                                         .tilesPerFrame = 4,
                                         .maxRegionCount = 64};
    harness_fill(&h, &f->streamer_info);
    CHECK_OK(sluiceCreateVulkanStreamer(&f->streamer_info, &f->streamer));
    f->settings.structSize = sizeof f->settings;
    f->loader_settings.structSize = sizeof f->loader_settings;
    CHECK_OK(sluiceGetVulkanStreamerSettings(f->streamer, &f->settings));
    f->texture_info = (SluiceVulkanTextureCreateInfo){
        .structSize = sizeof(SluiceVulkanTextureCreateInfo), .source = f->source};
    CHECK_OK(sluiceAddVulkanTexture(f->streamer, &f->texture_info, &f->texture));
    f->control.structSize = sizeof f->control;
    f->uv = (SluiceUvTransform){.scaleU = 8, .scaleV = 8};
    f->request = (SluiceVulkanTextureRequest){.structSize = sizeof f->request, .until = UINT64_MAX};
    CHECK_OK(
        sluiceRequestVulkanTexture(f->streamer, f->texture.textureId, &f->request, &f->request_id));
}

static SluiceResult record_tiles(void *user, const SluiceTileBatch *batch, SluiceResult *answers)
{
    (void)user, (void)batch, (void)answers;
    return SLUICE_NOT_READY;
}

static SluiceResult record_pages(void *user, const SluiceBytePageBatch *batch,
                                 SluiceResult *answers)
{
    (void)user, (void)batch, (void)answers;
    return SLUICE_NOT_READY;
}

/* A texture and byte pages that commands write. */
static void add_made(struct fixture *f)
{
    const SluiceImageInfo image = {.structSize = sizeof image,
                                   .width = 64,
                                   .height = 64,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM};
    const SluiceTileProducer producer = {
        .structSize = sizeof producer, .pImage = &image, .pfnRecordTiles = record_tiles};
    const SluiceDemandTextureCreateInfo texture = {.structSize = sizeof texture,
                                                   .pProducer = &producer};
    const SluiceDemandResourceCreateInfo pages = {
        .structSize = sizeof pages, .pageCount = 4, .pageSize = 4, .pfnRecordPages = record_pages};
    uint32_t first;
    CHECK_OK(sluiceAddDemandTexture(f->loader, &texture, &f->made));
    CHECK_OK(sluiceAddDemandResource(f->loader, &pages, &f->made_pages, &first));
}

static void init_loader(struct fixture *f)
{
    f->loader_info =
        (SluiceDemandLoaderCreateInfo){.structSize = sizeof(SluiceDemandLoaderCreateInfo),
                                       .context = h.context,
                                       .maxTextureCount = 64,
                                       .pageCapacity = 4096,
                                       .maxTilesInFlight = 4,
                                       .memoryBudget = 4 << 20};
    CHECK_OK(sluiceCreateDemandLoader(&f->loader_info, &f->loader));
    CHECK_OK(sluiceGetDemandLoaderSettings(f->loader, &f->loader_settings));
    CHECK_OK(sluiceCreateDemandLoader(&f->loader_info, &f->fresh_loader));
    f->recording = (SluiceFileRecordingInfo){.structSize = sizeof(SluiceFileRecordingInfo),
                                             .pPath = "null_arguments_demand.trace"};
    f->demand_region = (SluiceImageRegion){.width = 1, .height = 1};
    f->demand_info = (SluiceDemandTextureCreateInfo){
        .structSize = sizeof(SluiceDemandTextureCreateInfo), .image = {.source = f->source}};
    f->sampler.structSize = sizeof f->sampler;
    f->frame.structSize = sizeof f->frame;
    f->launch.structSize = sizeof f->launch;
    CHECK_OK(sluiceAddDemandTexture(f->loader, &f->demand_info, &f->id));
    f->grid_info = (SluiceDemandGridCreateInfo){.structSize = sizeof(SluiceDemandGridCreateInfo),
                                                .columnCount = 1,
                                                .rowCount = 1,
                                                .pTextureIds = &f->id};
    f->resource_info = (SluiceDemandResourceCreateInfo){
        .structSize = sizeof(SluiceDemandResourceCreateInfo), .pageCount = 4, .pfnFill = fill};
    uint32_t first;
    CHECK_OK(sluiceAddDemandResource(f->loader, &f->resource_info, &f->resource, &first));
    const SluiceDemandResourceCreateInfo bytes = {
        .structSize = sizeof bytes, .pageCount = 4, .pageSize = 4};
    CHECK_OK(sluiceAddDemandResource(f->loader, &bytes, &f->bytes, &first));
    add_made(f);
    const SluiceProxySetCreateInfo set = {.structSize = sizeof set, .maxProxyCount = 4};
    const SluiceProxyBox box = {{0, 0, 0}, {1, 1, 1}};
    SluiceProxyId proxy;
    CHECK_OK(sluiceCreateProxySet(&set, &f->set));
    CHECK_OK(sluiceAddGeometryProxy(f->set, &box, &proxy));
    CHECK_OK(sluiceAddDemandProxies(f->loader, f->set, 0, &f->proxies, &first));
}

/* Shared by all tests, because its passes take long to compile. One texel. */
static SluiceNeuralCompressor *compressor;

static void init_compressor(struct fixture *f)
{
    f->texel = 0.5f;
    f->mips[0] = &f->texel;
    f->compressor_info =
        (SluiceNeuralCompressorCreateInfo){.structSize = sizeof(SluiceNeuralCompressorCreateInfo),
                                           .width = 1,
                                           .height = 1,
                                           .channelCount = 1,
                                           .pChannels = &f->channel,
                                           .ppMips = f->mips,
                                           .batchSize = 32};
    if (!compressor)
        CHECK_OK(sluiceCreateNeuralCompressor(h.context, &f->compressor_info, &compressor));
    f->compressor = compressor;
    CHECK_OK(sluiceGetNeuralCheckpoint(f->compressor, NULL, &f->checkpoint_size));
    f->checkpoint = malloc(f->checkpoint_size);
    CHECK_OK(sluiceRecordNeuralReadback(f->compressor, f->commands));
}

/* Shared by all tests. 4 x 4 texels, all zero. */
static SluiceVulkanNeuralDecoder *decoder;

static void init_decoder(struct fixture *f)
{
    static const SluiceNeuralConstants constants = {
        .schema = 3,
        .width = 4,
        .height = 4,
        .mipCount = 1,
        .channelCount = 2,
        .validChannels = 3,
        .inputCount = 48,
        .networkFeatures = 16,
        .highFeatures = 4,
        .highBits = 4,
        .lowFeatures = 4,
        .lowBits = 4,
        .residentMipCount = 1,
        .slices = {{0, 0x20002, 0, 0x20002}, {8, 0x10001, 0, 0x10001}}};
    static const uint8_t latents[12], weights[9472];
    f->paths.structSize = f->out.paths.structSize = sizeof f->paths;
    f->convert_info.structSize = sizeof f->convert_info;
    f->decoder_info = (SluiceVulkanNeuralDecoderCreateInfo){.structSize = sizeof f->decoder_info,
                                                            .context = h.context,
                                                            .pConstants = &constants,
                                                            .pLatents = latents,
                                                            .latentSize = sizeof latents,
                                                            .pWeights = weights,
                                                            .weightSize = sizeof weights};
    f->neural_output = (SluiceVulkanNeuralOutput){.structSize = sizeof f->neural_output,
                                                  .format = SLUICE_FORMAT_BC4_UNORM_BLOCK,
                                                  .channelCount = 1};
    if (!decoder)
        CHECK_OK(sluiceCreateVulkanNeuralDecoder(&f->decoder_info, &decoder));
    f->decoder = decoder;
}

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    h.quiet = true;
    f->h = &h;
    f->commands = h.commands[0];
    f->info = (SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                                .width = 64,
                                .height = 64,
                                .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                .pName = "gray"};
    const SluiceProceduralImage image = {NULL, texel};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &f->info, NULL, &f->source));
    f->context_info = harness_context_info(&h);
    init_streamer(f);
    init_loader(f);
    init_decoder(f);
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    assert_int_equal(h.BeginCommandBuffer(f->commands, &begin), VK_SUCCESS);
    init_compressor(f);
}

/* Submits nothing of the recorded commands. */
static void fixture_finish(struct fixture *f)
{
    assert_int_equal(h.ResetCommandBuffer(f->commands, 0), VK_SUCCESS);
    free(f->checkpoint);
    sluiceDestroyDemandLoader(f->loader);
    sluiceDestroyProxySet(f->set);
    sluiceDestroyDemandLoader(f->fresh_loader);
    remove(f->recording.pPath);
    sluiceDestroyVulkanStreamer(f->streamer);
    sluiceDestroyImageSource(f->source);
    h.quiet = false;
    harness_check_silence(&h);
}

#include "device_calls.h"

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    CHECK_OK(harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.loaderThreadCount = 1}));
    status = RUN_TESTS(tests);
    sluiceDestroyVulkanNeuralDecoder(decoder);
    sluiceDestroyNeuralCompressor(compressor);
    return harness_finish(&h, status);
}
