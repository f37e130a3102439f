/*
 * Streams the six faces of a sky as one cube map. The view turns, and only visible tiles are
 * loaded. The faces are painted, or come from a store of `sluice-bake --cube`.
 */
#include "../../tools/common/log.h"
#include "../../tools/common/shared_options.h"
#include "../../tools/common/target.h"
#include "../common/draw_pipeline.h"
#include "../common/paged_sample.h"
#include "../common/png_file.h"
#include "faces.h"

#include "sky_frag.h" /* SPIR-V */
#include "sky_vert.h"

#ifdef HAVE_STORE
#include <sluice/store.h>
#endif

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define EDGE_WIDTH 0.006f

struct settings {
    struct paged_sample common;
    const char *store;
    uint32_t size[2], frames, face_size;
    bool edges, everything;
};

/* Push constants of sky.glsl. */
struct view {
    float right[4], up[4], ahead[4];
    uint32_t table_index;
    float edges;
};

struct app {
    struct settings settings;
    struct gpu gpu;
    struct faces faces;
    SluiceImageSource *store;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanTexture textures[FACES];
    SluiceStreamingFrame frame;
    struct target target;
    struct gpu_buffer picture;
    VkSampler sampler;
    VkDescriptorSetLayout cube_layout;
    VkDescriptorPool pool;
    VkDescriptorSet cube_set;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkCommandBuffer commands;
};

static bool sluice(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        fprintf(stderr, "cube-sky: %s: %s\n", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static bool open_source(struct app *app, SluiceImageSource **source)
{
#ifdef HAVE_STORE
    if (app->settings.store) {
        const SluiceStoreImageSourceCreateInfo info = {
            .structSize = sizeof info, .pPath = app->settings.store, .log = {NULL, log_say}};
        SluiceResult result = sluiceCreateStoreImageSource(&info, &app->store);
        *source = app->store;
        return sluice(result, app->settings.store);
    }
#endif
    SluiceResult result = faces_create(app->settings.face_size, &app->faces);
    *source = app->faces.cube;
    return sluice(result, "faces");
}

static bool create_streamer(struct app *app)
{
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = app->gpu.family,
                                                   .instance = app->gpu.instance,
                                                   .physicalDevice = app->gpu.physical_device,
                                                   .device = app->gpu.device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .log = {NULL, log_say}};
    if (!sluice(sluiceCreateVulkanContext(&context, &app->context), "context"))
        return false;
    const SluiceVulkanStreamerDebugInfo debug = {.structSize = sizeof debug,
                                                 .mapEverything = app->settings.everything};
    const SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                                 .context = app->context,
                                                 .residencyMode = SLUICE_RESIDENCY_MODE_PAGED,
                                                 .framesInFlight = 1,
                                                 .ticksPerSecond = 60,
                                                 .feedbackTimeoutTicks = 30,
                                                 .pDebug = &debug};
    return sluice(sluiceCreateVulkanStreamer(&info, &app->streamer), "streamer");
}

/* Sets `cube` for an array of six sources. Stores declare it themselves. */
static bool add_sky(struct app *app)
{
    SluiceImageInfo image = {.structSize = sizeof image};
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .cube = !app->settings.store};
    if (!open_source(app, &info.source) || !sluice(sluiceGetImageInfo(info.source, &image), "sky"))
        return false;
    if (image.arrayLayerCount != FACES || (app->settings.store && !image.cube)) {
        fprintf(stderr,
                "cube-sky: %s: has %u layers and is %s; a store of one cube map is needed\n",
                app->settings.store, image.arrayLayerCount, image.cube ? "cube maps" : "no cube");
        return false;
    }
    return sluice(sluiceAddVulkanTextureArray(app->streamer, &info, FACES, app->textures), "sky");
}

static bool create_cube_set(struct app *app)
{
    const VkSamplerCreateInfo sampler = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                         .magFilter = VK_FILTER_LINEAR,
                                         .minFilter = VK_FILTER_LINEAR,
                                         .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                         .maxLod = VK_LOD_CLAMP_NONE};
    const VkDescriptorSetLayoutBinding binding = {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                                  VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    const VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings = &binding};
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
    VkDevice device = app->gpu.device;
    if (!gpu_check(vkCreateSampler(device, &sampler, NULL, &app->sampler), "sampler") ||
        !gpu_check(vkCreateDescriptorSetLayout(device, &layout, NULL, &app->cube_layout),
                   "set layout") ||
        !gpu_check(vkCreateDescriptorPool(device, &pool, NULL, &app->pool), "pool"))
        return false;
    const VkDescriptorSetAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = app->pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &app->cube_layout};
    if (!gpu_check(vkAllocateDescriptorSets(device, &info, &app->cube_set), "set"))
        return false;
    const VkDescriptorImageInfo image = {app->sampler, app->textures[0].cubeView,
                                         VK_IMAGE_LAYOUT_GENERAL};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = app->cube_set,
                                        .descriptorCount = 1,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                        .pImageInfo = &image};
    vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
    return true;
}

static bool create_pipeline(struct app *app)
{
    VkDescriptorSetLayout sets[2] = {VK_NULL_HANDLE, app->cube_layout};
    if (!sluice(sluiceGetVulkanDescriptorSetLayout(app->streamer, &sets[0]), "layout"))
        return false;
    const VkPushConstantRange range = {VK_SHADER_STAGE_ALL, 0, sizeof(struct view)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 2,
                                               .pSetLayouts = sets,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    if (!gpu_check(vkCreatePipelineLayout(app->gpu.device, &layout, NULL, &app->layout), "layout"))
        return false;
    VkShaderModule vertex = gpu_create_shader(&app->gpu, sky_vert, sizeof sky_vert);
    VkShaderModule fragment = gpu_create_shader(&app->gpu, sky_frag, sizeof sky_frag);
    const struct draw_pipeline_info info = {
        .target = &app->target, .layout = app->layout, .vertex = vertex, .fragment = fragment};
    bool created = vertex && fragment && draw_pipeline_create(&app->gpu, &info, &app->pipeline);
    vkDestroyShaderModule(app->gpu.device, vertex, NULL);
    vkDestroyShaderModule(app->gpu.device, fragment, NULL);
    return created;
}

static bool create(struct app *app)
{
    const uint32_t *size = app->settings.size;
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = app->gpu.command_pool,
        .commandBufferCount = 1};
    return create_streamer(app) && add_sky(app) &&
           target_create(&app->gpu, size[0], size[1], 1, &app->target) &&
           gpu_create_buffer(&app->gpu, (VkDeviceSize)size[0] * size[1] * 4,
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT, &app->picture) &&
           create_cube_set(app) && create_pipeline(app) &&
           gpu_check(vkAllocateCommandBuffers(app->gpu.device, &commands, &app->commands),
                     "commands");
}

/* Turns the view by a quarter in the first half of the frames. It ends where three faces meet. */
static struct view view_in_frame(const struct app *app, uint32_t frame)
{
    const struct settings *s = &app->settings;
    float turned = fminf(2.0f * (float)frame / (float)s->frames, 1.0f);
    float yaw = 0.8f - 1.57f * (1 - turned), pitch = 0.3f, wide = 1.1f;
    float high = wide * (float)s->size[1] / (float)s->size[0];
    return (struct view){
        .right = {wide * cosf(yaw), 0, wide * sinf(yaw)},
        .up = {-high * sinf(pitch) * sinf(yaw), high * cosf(pitch), high * sinf(pitch) * cosf(yaw)},
        .ahead = {cosf(pitch) * sinf(yaw), sinf(pitch), -cosf(pitch) * cosf(yaw)},
        .table_index = app->textures[0].tableIndex,
        .edges = s->edges ? EDGE_WIDTH : 0};
}

static void record(struct app *app, uint32_t number)
{
    const float black[4] = {0, 0, 0, 1};
    const struct view view = view_in_frame(app, number);
    const VkDescriptorSet sets[2] = {app->frame.descriptorSet, app->cube_set};
    target_begin(&app->target, app->commands, black);
    vkCmdBindPipeline(app->commands, VK_PIPELINE_BIND_POINT_GRAPHICS, app->pipeline);
    vkCmdBindDescriptorSets(app->commands, VK_PIPELINE_BIND_POINT_GRAPHICS, app->layout, 0, 2, sets,
                            0, NULL);
    vkCmdPushConstants(app->commands, app->layout, VK_SHADER_STAGE_ALL, 0, sizeof view, &view);
    vkCmdDraw(app->commands, 3, 1, 0, 0);
    target_end(&app->target, app->commands);
}

static bool submit(const struct app *app)
{
    const VkTimelineSemaphoreSubmitInfo values = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &app->frame.signalValue};
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .pNext = &values,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &app->commands,
                               .signalSemaphoreCount = 1,
                               .pSignalSemaphores = &app->frame.semaphore};
    return gpu_check(vkQueueSubmit(app->gpu.queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
}

static bool draw_frame(struct app *app, uint32_t number)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    app->frame.structSize = sizeof app->frame;
    if (!gpu_check(vkBeginCommandBuffer(app->commands, &info), "vkBeginCommandBuffer") ||
        !sluice(sluiceBeginStreamingFrame(app->streamer, app->commands, number, &app->frame),
                "frame"))
        return false;
    record(app, number);
    if (!sluice(sluiceEndStreamingFrame(app->streamer, app->commands), "frame"))
        return false;
    target_copy_out(&app->target, app->commands, app->picture.buffer);
    const VkSemaphoreWaitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &app->frame.semaphore,
                                      .pValues = &app->frame.signalValue};
    return gpu_check(vkEndCommandBuffer(app->commands), "vkEndCommandBuffer") && submit(app) &&
           gpu_check(vkWaitSemaphores(app->gpu.device, &wait, UINT64_MAX), "vkWaitSemaphores") &&
           sluice(sluiceWaitVulkanStreamerIdle(app->streamer), "reads");
}

static bool run(struct app *app)
{
    SluiceVulkanStreamerStatistics statistics = {.structSize = sizeof statistics};
    for (uint32_t i = 1; i <= app->settings.frames; i++)
        if (!draw_frame(app, i))
            return false;
    if (!sluice(sluiceGetVulkanStreamerStatistics(app->streamer, &statistics), "statistics"))
        return false;
    printf("%llu tiles loaded, %llu KiB read\n", (unsigned long long)statistics.tilesMapped,
           (unsigned long long)(statistics.bytesRead >> 10));
    return png_file_write(app->settings.common.output, app->picture.mapped, app->settings.size[0],
                          app->settings.size[1]);
}

static void destroy(struct app *app)
{
    VkDevice device = app->gpu.device;
    sluiceDestroyVulkanStreamer(app->streamer);
    sluiceDestroyVulkanContext(app->context);
    sluiceDestroyImageSource(app->store);
    faces_destroy(&app->faces);
    vkDestroyPipeline(device, app->pipeline, NULL);
    vkDestroyPipelineLayout(device, app->layout, NULL);
    vkDestroyDescriptorPool(device, app->pool, NULL);
    vkDestroyDescriptorSetLayout(device, app->cube_layout, NULL);
    vkDestroySampler(device, app->sampler, NULL);
    gpu_destroy_buffer(&app->gpu, &app->picture);
    target_destroy(&app->gpu, &app->target);
    gpu_destroy(&app->gpu);
}

static enum option_outcome read_settings(struct settings *s, int argc, char **argv)
{
    const struct option options[] = {
        {OPTION_TEXT, "output", "FILE", "sky.png", &s->common.output, "the picture, as PNG",
         .letter = 'o'},
        {OPTION_EXTENT, "size", "WxH", "640x360", s->size, "pixels", 16, 4096},
        {OPTION_UINT, "frames", "N", "60", &s->frames, "frames; the view turns in the first half",
         2, 1000000},
        {OPTION_UINT, "face", "N", "2048", &s->face_size, "texels of an edge of a painted face", 4,
         16384},
#ifdef HAVE_STORE
        {OPTION_TEXT, "store", "FILE", "(painted)", &s->store,
         "the sky: a store of sluice-bake --cube"},
#endif
        {OPTION_FLAG, "edges", .value = &s->edges, .help = "draw the edges of the cube"},
        {OPTION_FLAG, "everything", .value = &s->everything,
         .help = "load every tile, seen or not, to compare"},
        option_device(&s->common.device),
        option_list_devices(&s->common.list_devices),
        option_validation(&s->common.validation),
    };
    const struct option_table table = {
        "cube-sky",
        "usage: cube-sky [options]\n\n"
        "Turns the view in a sky whose six faces stream as one cube map.\n",
        "Exit status: 0; 1 if something failed; 2 for wrong usage; 77 if no device has pages.\n",
        options, sizeof options / sizeof *options};
    return options_parse(&table, argc, argv);
}

int main(int argc, char **argv)
{
    struct app app = {0};
    enum option_outcome outcome = read_settings(&app.settings, argc, argv);
    int status = paged_sample_begin(outcome, &app.settings.common, &app.gpu);
    if (status != PAGED_SAMPLE_GOES_ON)
        return status;
    bool good = create(&app) && run(&app);
    destroy(&app);
    return paged_sample_end(&app.gpu, good);
}
