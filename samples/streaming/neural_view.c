#include "neural_view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/text.h"
#include "gallery_shared.h"
#include "neural_path.h"

#define PAGE_SIZE 16384u          ///< maximum bytes of a page of latents
#define SCRATCH_SIZE (256u << 10) ///< bytes for tiles that are being decoded
#define LOADER_MEMORY (64u << 20) ///< bytes, most of which are never allocated
#define LOADER_PAGES 65536u

static bool check(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        text_say("%s: %s", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static bool hangs_as(const struct settings *settings, enum neural_mode mode)
{
    for (uint32_t i = 0; i < settings->neural_mode_count; i++)
        if (settings->neural_modes[i] == mode)
            return true;
    return false;
}

/** Reads INT8 weights. Free the result. NULL on error. */
static void *read_weights(const SluiceNeuralSet *set, uint64_t *size)
{
    void *weights = NULL;
    SluiceResult result = sluiceGetNeuralWeights(set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, size, NULL);
    if (result == SLUICE_SUCCESS)
        weights = malloc((size_t)*size);
    if (weights)
        result = sluiceGetNeuralWeights(set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, size, weights);
    if (weights && check(result, "sluiceGetNeuralWeights"))
        return weights;
    free(weights);
    return NULL;
}

static bool create_decoder(struct neural_view *view, SluiceVulkanContext *context,
                           const void *weights, uint64_t weight_size)
{
    SluiceNeuralConstants constants;
    uint64_t size = 0;
    const SluiceNeuralSet *set = view->files->set;
    SluiceResult result = sluiceReadNeuralLatents(set, NULL, &constants, &size, NULL);
    void *latents = result == SLUICE_SUCCESS ? malloc((size_t)size) : NULL;
    if (latents)
        result = sluiceReadNeuralLatents(set, NULL, &constants, &size, latents);
    const SluiceVulkanNeuralDecoderCreateInfo info = {.structSize = sizeof info,
                                                      .context = context,
                                                      .pConstants = &constants,
                                                      .pLatents = latents,
                                                      .latentSize = size,
                                                      .pWeights = weights,
                                                      .weightSize = weight_size,
                                                      .scratchSize = SCRATCH_SIZE};
    bool created = latents && check(result, "sluiceReadNeuralLatents") &&
                   check(sluiceCreateVulkanNeuralDecoder(&info, &view->decoder),
                         "sluiceCreateVulkanNeuralDecoder");
    view->decoder_size = sizeof constants + size + weight_size + SCRATCH_SIZE;
    free(latents);
    return created;
}

static SluiceResult read_page(void *user, uint32_t page, uint32_t size, void *bytes)
{
    const struct neural_view *view = user;
    (void)size;
    return sluiceReadNeuralPage(view->files->set, &view->pages, page, bytes);
}

static bool create_loader(struct neural_view *view, SluiceVulkanContext *context,
                          uint32_t *first_page)
{
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .context = context,
                                               .launchesInFlight = NEURAL_VIEW_SLOTS,
                                               .maxTextureCount = 1,
                                               .pageCapacity = LOADER_PAGES,
                                               .memoryBudget = LOADER_MEMORY,
                                               .byteMemoryBudget = LOADER_MEMORY / 2,
                                               .bufferDeviceAddress = true};
    if (!check(sluiceLayOutNeuralPages(view->files->set, PAGE_SIZE, &view->pages),
               "sluiceLayOutNeuralPages") ||
        !check(sluiceCreateDemandLoader(&info, &view->loader), "sluiceCreateDemandLoader"))
        return false;
    const SluiceDemandResourceCreateInfo resource = {.structSize = sizeof resource,
                                                     .pageCount = view->pages.pageCount,
                                                     .pageSize = view->pages.pageSize,
                                                     .pUserData = view,
                                                     .pfnRead = read_page};
    return check(sluiceAddDemandResource(view->loader, &resource, &view->resource, first_page),
                 "sluiceAddDemandResource");
}

/** Pins the page of the coarsest mips, so that there is always something to show. */
static bool pin_last_page(struct neural_view *view)
{
    uint32_t page = view->pages.groups[view->pages.groupCount - 1].firstPage;
    void *bytes = malloc(view->pages.pageSize);
    bool pinned = bytes &&
                  check(sluiceReadNeuralPage(view->files->set, &view->pages, page, bytes),
                        "sluiceReadNeuralPage") &&
                  check(sluiceSetDemandPageBytes(view->loader, view->resource, page, bytes, true),
                        "sluiceSetDemandPageBytes");
    free(bytes);
    return pinned;
}

static bool create_buffers(struct neural_view *view, const struct neural_program *program,
                           uint32_t first_page)
{
    if (!gpu_create_buffer(view->gpu, sizeof(struct GalleryNeuralSet),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &view->set_buffer) ||
        !gpu_create_buffer(view->gpu, program->weight_size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                           &view->weights))
        return false;
    struct GalleryNeuralSet *set = view->set_buffer.mapped;
    *set = (struct GalleryNeuralSet){.firstPage = first_page};
    memcpy(&set->pages, &view->pages, sizeof set->pages);
    memcpy(view->weights.mapped, program->weights, (size_t)program->weight_size);
    return true;
}

static bool create_layout(struct neural_view *view)
{
    VkDescriptorSetLayoutBinding bindings[GALLERY_NEURAL_BINDING_COUNT];
    for (uint32_t i = 0; i < GALLERY_NEURAL_BINDING_COUNT; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                                     VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    const VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = GALLERY_NEURAL_BINDING_COUNT,
        .pBindings = bindings};
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                       GALLERY_NEURAL_BINDING_COUNT};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
    VkDevice device = view->gpu->device;
    if (!gpu_check(vkCreateDescriptorSetLayout(device, &layout, NULL, &view->layout),
                   "vkCreateDescriptorSetLayout") ||
        !gpu_check(vkCreateDescriptorPool(device, &pool, NULL, &view->pool),
                   "vkCreateDescriptorPool"))
        return false;
    const VkDescriptorSetAllocateInfo set = {.sType =
                                                 VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = view->pool,
                                             .descriptorSetCount = 1,
                                             .pSetLayouts = &view->layout};
    return gpu_check(vkAllocateDescriptorSets(device, &set, &view->set),
                     "vkAllocateDescriptorSets");
}

/** Writes the only set, which serves all frames, because the loader's buffers never change. */
static void write_set(const struct neural_view *view)
{
    SluiceDemandBuffers buffers = {.structSize = sizeof buffers};
    (void)sluiceGetDemandBuffers(view->loader, &buffers);
    const VkDescriptorBufferInfo infos[GALLERY_NEURAL_BINDING_COUNT] = {
        [GALLERY_NEURAL_BINDING_LEVELS] = {buffers.levels, 0, VK_WHOLE_SIZE},
        [GALLERY_NEURAL_BINDING_DIRECTORY] = {buffers.directory, 0, VK_WHOLE_SIZE},
        [GALLERY_NEURAL_BINDING_BLOCKS] = {buffers.blocks, 0, VK_WHOLE_SIZE},
        [GALLERY_NEURAL_BINDING_MASKS] = {buffers.masks, 0, VK_WHOLE_SIZE},
        [GALLERY_NEURAL_BINDING_REQUESTS] = {buffers.requests, 0, VK_WHOLE_SIZE},
        [GALLERY_NEURAL_BINDING_SECTIONS] = {buffers.sections, 0, VK_WHOLE_SIZE},
        [GALLERY_NEURAL_BINDING_SET] = {view->set_buffer.buffer, 0, VK_WHOLE_SIZE},
        [GALLERY_NEURAL_BINDING_WEIGHTS] = {view->weights.buffer, 0, VK_WHOLE_SIZE},
    };
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = view->set,
                                        .descriptorCount = GALLERY_NEURAL_BINDING_COUNT,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = infos};
    vkUpdateDescriptorSets(view->gpu->device, 1, &write, 0, NULL);
}

static bool create_sampling(struct neural_view *view, SluiceVulkanContext *context,
                            enum neural_path path)
{
    struct neural_program program;
    uint32_t first_page = 0;
    if (!view->gpu->byte_pages) {
        text_say("%s: --neural-as sample wants the feature bufferDeviceAddress, which is missing",
                 view->gpu->properties.deviceName);
        return false;
    }
    bool created = neural_program_create(view->gpu, view->files->set, path, &program) &&
                   create_loader(view, context, &first_page) && pin_last_page(view) &&
                   create_buffers(view, &program, first_page) && create_layout(view);
    view->words = program.words;
    view->words_size = program.words_size;
    neural_program_destroy(&program);
    if (created)
        write_set(view);
    return created;
}

bool neural_view_create(const struct gpu *gpu, SluiceVulkanContext *context,
                        const struct picture_list *pictures, const struct settings *settings,
                        struct neural_view *view)
{
    *view = (struct neural_view){0};
    if (!pictures->neural)
        return true;
    *view = (struct neural_view){.gpu = gpu, .files = pictures->neural};
    bool feedback = hangs_as(settings, NEURAL_FEEDBACK), sample = hangs_as(settings, NEURAL_SAMPLE);
    uint64_t weight_size = 0;
    void *weights = read_weights(view->files->set, &weight_size);
    bool created =
        weights && (!feedback || create_decoder(view, context, weights, weight_size)) &&
        (!sample || create_sampling(view, context, (enum neural_path)settings->neural_path));
    free(weights);
    return created;
}

void neural_view_destroy(struct neural_view *view)
{
    if (!view->gpu)
        return;
    sluiceDestroyDemandLoader(view->loader);
    sluiceDestroyVulkanNeuralDecoder(view->decoder);
    vkDestroyDescriptorPool(view->gpu->device, view->pool, NULL);
    vkDestroyDescriptorSetLayout(view->gpu->device, view->layout, NULL);
    gpu_destroy_buffer(view->gpu, &view->set_buffer);
    gpu_destroy_buffer(view->gpu, &view->weights);
    *view = (struct neural_view){0};
}

const SluiceTileProducer *neural_view_add_producer(struct neural_view *view,
                                                   const struct neural_picture *picture)
{
    SluiceVulkanNeuralOutput output = {.structSize = sizeof output,
                                       .pName = picture->texture.pName,
                                       .format = picture->format,
                                       .firstChannel = picture->texture.firstChannel,
                                       .channelCount = picture->texture.channelCount};
    const SluiceTileProducer *producer = NULL;
    memcpy(output.from, picture->from, sizeof output.from);
    memcpy(output.to, picture->to, sizeof output.to);
    return check(sluiceAddVulkanNeuralOutput(view->decoder, &output, &producer),
                 picture->texture.pName)
               ? producer
               : NULL;
}

bool neural_view_begin(struct neural_view *view, uint32_t slot, VkCommandBuffer commands)
{
    if (!view->loader)
        return true;
    if (!neural_view_process(view, slot, false))
        return false;
    view->launches[slot] = (SluiceDemandLaunch){.structSize = sizeof view->launches[slot]};
    return check(sluiceBeginDemandLaunch(view->loader, commands, &view->launches[slot]),
                 "sluiceBeginDemandLaunch");
}

bool neural_view_end(struct neural_view *view, VkCommandBuffer commands)
{
    return !view->loader ||
           check(sluiceEndDemandLaunch(view->loader, commands), "sluiceEndDemandLaunch");
}

bool neural_view_process(struct neural_view *view, uint32_t slot, bool settle)
{
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    SluiceDemandTicket ticket = 0;
    if (!view->loader || !view->under_way[slot])
        return true;
    if (!check(sluiceProcessDemandRequests(view->loader, &view->launches[slot], UINT64_MAX,
                                           &requests, &ticket),
               "sluiceProcessDemandRequests"))
        return false;
    for (uint32_t i = 0; i < NEURAL_VIEW_SLOTS; i++) /* earlier launches are processed as well */
        if (view->launches[i].launchIndex <= view->launches[slot].launchIndex)
            view->under_way[i] = false;
    return !settle || check(sluiceWaitDemandTicket(view->loader, ticket, UINT64_MAX, NULL),
                            "sluiceWaitDemandTicket");
}

uint64_t neural_view_memory(const struct neural_view *view)
{
    SluiceDemandStatistics statistics = {.structSize = sizeof statistics};
    uint64_t size = view->decoder ? view->decoder_size : 0;
    if (view->loader && sluiceGetDemandStatistics(view->loader, &statistics) == SLUICE_SUCCESS)
        size += statistics.residentBytePageCount * view->pages.pageSize + view->weights.size +
                view->set_buffer.size;
    return size;
}
