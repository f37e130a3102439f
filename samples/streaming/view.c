#include "view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/log.h"
#include "../../tools/common/text.h"
#include "view_needs.h"
#include "view_neural.h"

_Static_assert(PREDICT_SLOTS == VIEW_FRAMES_IN_FLIGHT, "one for each frame in flight");

#define WAIT_NANOSECONDS 60000000000ull

/** Prints "what: SLUICE_..." and returns false unless it is a success. */
static bool check(SluiceResult result, const char *what)
{
    if (result == SLUICE_SUCCESS)
        return true;
    text_say("%s: %s", what, sluiceGetResultName(result));
    return false;
}

/** Counts floor, wall, and two textures per picture. */
uint32_t view_texture_count(const struct picture_list *pictures)
{
    return 2 + 2 * pictures->count;
}

static bool begin_slowness(struct view *view)
{
    if (view->request.everything || slowness_begin(&view->slowness, view->request.settings,
                                                   view_texture_count(view->request.pictures)))
        return true;
    fprintf(stderr, "out of memory\n");
    return false;
}

static bool create_context(struct view *view)
{
    const struct gpu *gpu = view->request.gpu;
    SluiceVulkanContextCreateInfo info = {
        .structSize = sizeof info,
        .queueFamilyIndex = gpu->family,
        .instance = gpu->instance,
        .physicalDevice = gpu->physical_device,
        .device = gpu->device,
        .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
        .sparseQueue = gpu->sparse_queue,
        .sparseQueueFamilyIndex = gpu->sparse_family,
        .log = {NULL, log_say},
        .loaderThreadCount = view->request.settings->threads,
    };
    if (view->slowness.on) /* two attempts per read; later frames request the tile again */
        info.readRetry = (SluiceTileRetryPolicy){2, 1000000, 1000000};
    return check(sluiceCreateVulkanContext(&info, &view->context), "sluiceCreateVulkanContext");
}

static bool create_streamer(struct view *view)
{
    const struct settings *settings = view->request.settings;
    const SluiceVulkanStreamerDebugInfo everything = {.structSize = sizeof everything,
                                                      .mapEverything = true};
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info,
        .context = view->context,
        .residencyMode = view->request.mode,
        .framesInFlight = VIEW_FRAMES_IN_FLIGHT,
        .maxTextureCount = view_texture_count(view->request.pictures),
        .maxRegionCount = VIEW_MAX_REGIONS,
        .texturesPerFrame = settings->textures_per_frame,
        .tilesPerFrame = settings->tiles_per_frame,
        .heapTileCapacity = settings->heap_tiles,
        .maxHeapCount = settings->max_heaps,
        .numExtraStandbyTiles = settings->standby,
        .noStandbyTiles = settings->standby == 0,
        .ticksPerSecond = 1000000, /* simulated time, see view_frame */
        .feedbackTimeoutTicks = (uint64_t)(settings->timeout * 1e6),
        .newestFeedbackMapOnly = settings->timeout * 1e6 < 1,
        .maxLoadsInFlight = settings->loads_in_flight,
        .residencyFadeTicks = (uint64_t)(settings->fade * 1e6),
        .maxTouchedTiles = settings->touched_tiles,
    };
    if (view->request.everything) {
        info.pDebug = &everything;
        info.tilesPerFrame = 1024;
        info.maxHeapCount = 0;
        info.maxLoadsInFlight = 0;
        info.residencyFadeTicks = 0;
    }
    return check(sluiceCreateVulkanStreamer(&info, &view->streamer),
                 "sluiceCreateVulkanStreamer") &&
           check(sluiceGetVulkanStreamerManager(view->streamer, &view->manager),
                 "sluiceGetVulkanStreamerManager");
}

static bool create_renderer(struct view *view)
{
    const struct view_request *request = &view->request;
    struct renderer_request info = {.room = request->room,
                                    .target = request->target,
                                    .neural_layout = view->neural.layout,
                                    .neural_words = view->neural.words,
                                    .neural_size = view->neural.words_size,
                                    .anisotropy = request->settings->anisotropy,
                                    .counting = request->counting,
                                    .needs = request->needs,
                                    .paged = request->mode == SLUICE_RESIDENCY_MODE_PAGED};
    return check(sluiceGetVulkanDescriptorSetLayout(view->streamer, &info.streamer_layout),
                 "sluiceGetVulkanDescriptorSetLayout") &&
           renderer_create(request->gpu, &info, &view->renderer);
}

SluiceResult view_add_texture(struct view *view, SluiceImageSource *source,
                              const SluiceTileProducer *producer, SluiceTextureId primary,
                              bool repeat, SluiceVulkanTexture *texture)
{
    VkSamplerAddressMode mode =
        repeat ? VK_SAMPLER_ADDRESS_MODE_REPEAT : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info,
                                          .source = source ? slowness_wrap(&view->slowness, source)
                                                           : NULL,
                                          .pProducer = producer,
                                          .primaryId = primary,
                                          .addressModeU = mode,
                                          .addressModeV = mode,
                                          .explicitAddressModes = true};
    SluiceResult result = info.source || producer
                              ? sluiceAddVulkanTexture(view->streamer, &info, texture)
                              : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS) {
        view->texture_ids[view->texture_count] =
            (struct needs_id){texture->textureId, texture->tableIndex};
        view->sources[view->texture_count++] = info.source;
        return result;
    }
    SluiceImageInfo image = {.structSize = sizeof image, .pName = "a texture"};
    if (source)
        (void)sluiceGetImageInfo(source, &image);
    text_say("%s: cannot be streamed: %s", image.pName, sluiceGetResultName(result));
    return result;
}

/* Removes a picture's color texture: without its relief the picture is not shown. */
static void take_back(struct view *view, const SluiceVulkanTexture *texture)
{
    check(sluiceRemoveVulkanTexture(view->streamer, texture->textureId),
          "sluiceRemoveVulkanTexture");
    view->texture_count--;
}

bool view_allocate_sets(const struct view *view, VkDescriptorSetLayout layout, uint32_t count,
                        VkDescriptorSet *sets)
{
    for (uint32_t i = 0; i < count; i++) {
        VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = view->descriptor_pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &layout};
        if (!gpu_check(vkAllocateDescriptorSets(view->request.gpu->device, &info, &sets[i]),
                       "vkAllocateDescriptorSets"))
            return false;
    }
    return true;
}

static bool create_descriptor_pool(struct view *view)
{
    uint32_t surface_count = 2 + view->request.pictures->count;
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * GALLERY_BINDING_COUNT * VIEW_FRAMES_IN_FLIGHT},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4 * surface_count},
    };
    VkDescriptorPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 2 * VIEW_FRAMES_IN_FLIGHT + surface_count,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    return gpu_check(
        vkCreateDescriptorPool(view->request.gpu->device, &info, NULL, &view->descriptor_pool),
        "vkCreateDescriptorPool");
}

/** Creates floor or wall: a repeating texture without a relief. */
static bool create_tiled_surface(struct view *view, SluiceImageSource *source,
                                 struct renderer_surface *surface)
{
    SluiceVulkanTexture color;
    if (view_add_texture(view, source, NULL, SLUICE_NO_TEXTURE, true, &color) != SLUICE_SUCCESS)
        return false;
    surface->color_index = surface->relief_index = color.tableIndex;
    surface->exposure = 1.0f;
    renderer_write_texture_set(&view->renderer, surface->textures, color.imageView, color.imageView,
                               true);
    return true;
}

static SluiceResult create_picture_surface(struct view *view, const struct picture *picture,
                                           struct renderer_surface *surface)
{
    bool sets = view->request.settings->texture_sets == SETTING_ON;
    SluiceVulkanTexture color, relief;
    if (picture->neural)
        return view_neural_create_surface(view, picture, surface);
    SluiceResult result =
        view_add_texture(view, picture->color, NULL, SLUICE_NO_TEXTURE, false, &color);
    if (result != SLUICE_SUCCESS)
        return result;
    result = view_add_texture(view, picture->relief, NULL,
                              sets ? color.textureId : SLUICE_NO_TEXTURE, false, &relief);
    if (result != SLUICE_SUCCESS) {
        take_back(view, &color);
        return result;
    }
    surface->color_index = color.tableIndex;
    surface->relief_index = relief.tableIndex;
    surface->relief_feedback = !sets;
    surface->exposure = picture->exposure;
    surface->relief_scale = 0.0012f; /* meters from the deepest to the highest paint */
    surface->gray = picture->gray;
    surface->painted = true;
    renderer_write_texture_set(&view->renderer, surface->textures, color.imageView,
                               relief.imageView, false);
    return SLUICE_SUCCESS;
}

static bool is_fatal(SluiceResult result)
{
    return result == SLUICE_ERROR_VULKAN || result == SLUICE_ERROR_DEVICE_LOST ||
           result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/* Pictures that cannot be streamed, or for which the streamer has no room, stay plain. */
static bool create_pictures(struct view *view)
{
    uint32_t count = view->request.pictures->count, left_out = 0;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < count; i++) {
        struct renderer_surface *surface = &view->surfaces[2 + i];
        if (result != SLUICE_ERROR_LIMIT_EXCEEDED)
            result = create_picture_surface(view, &view->request.pictures->pictures[i], surface);
        if (is_fatal(result))
            return false;
        surface->missing = result != SLUICE_SUCCESS;
        left_out += surface->missing;
    }
    if (left_out)
        fprintf(stderr, "%u of %u pictures are left out%s\n", left_out, count,
                result == SLUICE_ERROR_LIMIT_EXCEEDED &&
                        view->request.mode == SLUICE_RESIDENCY_MODE_SPARSE
                    ? ": this device bears no more in sparse mode; --residency paged shows more"
                    : "");
    return true;
}

static bool create_surfaces(struct view *view)
{
    const struct view_request *request = &view->request;
    uint32_t count = 2 + request->pictures->count;
    view->surfaces = calloc(count, sizeof *view->surfaces);
    view->texture_ids =
        calloc(view_texture_count(view->request.pictures), sizeof *view->texture_ids);
    view->sources = calloc(view_texture_count(view->request.pictures), sizeof(SluiceImageSource *));
    if (!view->surfaces || !view->texture_ids || !view->sources)
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!view_allocate_sets(view, view->renderer.texture_layout, 1,
                                &view->surfaces[i].textures))
            return false;
    if (!create_tiled_surface(view, request->floor, &view->surfaces[0]) ||
        !create_tiled_surface(view, request->wall, &view->surfaces[1]))
        return false;
    return create_pictures(view);
}

static bool create_slot(struct view *view, struct view_slot *slot)
{
    const struct gpu *gpu = view->request.gpu;
    const struct target *target = view->request.target;
    VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                        .commandPool = gpu->command_pool,
                                        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                        .commandBufferCount = 1};
    if (!gpu_check(vkAllocateCommandBuffers(gpu->device, &info, &slot->commands),
                   "vkAllocateCommandBuffers") ||
        !gpu_create_buffer(gpu, sizeof(struct GalleryFrame), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                           &slot->frame) ||
        !gpu_create_buffer(gpu, sizeof(struct GalleryCounts),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           &slot->counts) ||
        !gpu_create_buffer(gpu, (VkDeviceSize)target->width * target->height * 4,
                           VK_BUFFER_USAGE_TRANSFER_DST_BIT, &slot->pixels) ||
        !view_allocate_sets(view, view->renderer.frame_layout, 1, &slot->frame_set))
        return false;
    memset(slot->counts.mapped, 0, sizeof(struct GalleryCounts));
    renderer_write_frame_set(&view->renderer, slot->frame_set, slot->frame.buffer,
                             slot->counts.buffer, slot->counts.buffer);
    return true;
}

static bool create_slots(struct view *view)
{
    VkQueryPoolCreateInfo queries = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = 2 * VIEW_FRAMES_IN_FLIGHT};
    for (uint32_t i = 0; i < VIEW_FRAMES_IN_FLIGHT; i++)
        if (!create_slot(view, &view->slots[i]))
            return false;
    return gpu_check(
        vkCreateQueryPool(view->request.gpu->device, &queries, NULL, &view->timestamps),
        "vkCreateQueryPool");
}

static bool create_prediction(struct view *view)
{
    const struct view_request *request = &view->request;
    if (request->settings->predict <= 0.0 || request->everything)
        return true;
    return predict_create(&view->renderer, request->target, &view->predict);
}

bool view_create(const struct view_request *request, const char *record_path, struct view *view)
{
    *view = (struct view){.request = *request};
    bool created = begin_slowness(view) && create_context(view) && create_streamer(view) &&
                   view_neural_create(view) && create_renderer(view);
    /* Begins before the first texture, so that the recording is complete. */
    const SluiceFileRecordingInfo recording = {
        .structSize = sizeof recording, .pPath = record_path, .log = {.pfnLog = log_say}};
    if (created && record_path)
        created = check(sluiceBeginFileRecording(view->manager, &recording, &view->recorder),
                        record_path);
    if (created && create_descriptor_pool(view) && create_surfaces(view) && create_slots(view) &&
        view_needs_create(view) && create_prediction(view))
        return true;
    view_destroy(view);
    return false;
}

bool view_destroy(struct view *view)
{
    if (!view->request.gpu)
        return true;
    const struct gpu *gpu = view->request.gpu;
    vkDeviceWaitIdle(gpu->device);
    bool recorded = check(sluiceEndRecording(view->recorder), "sluiceEndRecording");
    for (uint32_t i = 0; i < VIEW_FRAMES_IN_FLIGHT; i++) {
        struct view_slot *slot = &view->slots[i];
        if (slot->commands)
            vkFreeCommandBuffers(gpu->device, gpu->command_pool, 1, &slot->commands);
        gpu_destroy_buffer(gpu, &slot->frame);
        gpu_destroy_buffer(gpu, &slot->counts);
        gpu_destroy_buffer(gpu, &slot->pixels);
        needs_slot_destroy(&view->needs, &slot->needs);
    }
    predict_destroy(&view->predict);
    needs_pass_destroy(&view->needs);
    renderer_destroy(&view->renderer);
    vkDestroyQueryPool(gpu->device, view->timestamps, NULL);
    vkDestroyDescriptorPool(gpu->device, view->descriptor_pool, NULL);
    free(view->surfaces);
    free(view->texture_ids);
    free(view->sources);
    sluiceDestroyVulkanStreamer(view->streamer);
    neural_view_destroy(&view->neural);
    sluiceDestroyVulkanContext(view->context);
    slowness_finish(&view->slowness);
    *view = (struct view){0};
    return recorded;
}

static void write_frame_data(const struct view *view, const struct camera *camera,
                             struct GalleryFrame *frame)
{
    const struct settings *settings = view->request.settings;
    const struct target *target = view->request.target;
    const struct room *room = view->request.room;
    struct mat4 look = mat4_look_at(camera->eye, camera->target);
    struct mat4 lens = mat4_perspective(
        WALK_FIELD_OF_VIEW, (float)target->width / (float)target->height, 0.05f, 200.0f);
    struct mat4 view_projection = mat4_multiply(&lens, &look);
    *frame = (struct GalleryFrame){
        .eye = {camera->eye.x, camera->eye.y, camera->eye.z},
        .feedbackProbability = (float)settings->probability,
        .roomSize = {room->width, room->height, room->length},
        .lodBias = (float)settings->lod_bias,
        .maxAnisotropy = (float)settings->anisotropy,
        .feedbackSeed = settings->seed * 0x9e3779b1u + view->frame_index,
        .latticeFrame = settings->lattice ? view->frame_index : GALLERY_NO_TEXTURE,
        .highlight = settings->highlight && !view->request.everything,
        .neuralPicks = settings->neural_picks,
    };
    if (view->request.everything) { /* a fully resident view needs no feedback */
        frame->feedbackProbability = 0.0f;
        frame->latticeFrame = GALLERY_NO_TEXTURE;
    }
    memcpy(frame->viewProjection, view_projection.m, sizeof frame->viewProjection);
}

/** Writes feedback, and nothing else, from the future camera. */
static void record_prediction(const struct view *view, VkDescriptorSet streamer_set,
                              VkCommandBuffer commands)
{
    struct GalleryFrame frame;
    write_frame_data(view, &view->ahead, &frame);
    memcpy(frame.presentEye, &view->now.eye, sizeof frame.presentEye);
    frame.pixelScale = (float)view->predict.target.height / (float)view->request.target->height;
    predict_record(&view->predict, commands, streamer_set,
                   view->frame_index % VIEW_FRAMES_IN_FLIGHT, &frame, view->surfaces);
}

/** Draws the room again to count what its samples would read. */
static void record_counting(const struct view *view, const struct view_slot *slot,
                            const struct renderer_sets *sets)
{
    const struct view_request *request = &view->request;
    static const float black[4] = {0, 0, 0, 0};
    vkCmdFillBuffer(slot->commands, slot->counts.buffer, 0, VK_WHOLE_SIZE, 0);
    gpu_barrier(slot->commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    target_begin(request->target, slot->commands, black);
    renderer_draw(&view->renderer, slot->commands, sets, view->surfaces, RENDERER_COUNT);
    target_end(request->target, slot->commands);
    gpu_barrier(slot->commands, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

static uint32_t first_query(const struct view *view)
{
    return 2 * (view->frame_index % VIEW_FRAMES_IN_FLIGHT);
}

/* After this call the frame must be submitted or abandoned. */
static bool begin_frame(struct view *view, struct view_slot *slot, uint64_t time_stamp,
                        SluiceStreamingFrame *frame)
{
    VkCommandBuffer commands = slot->commands;
    uint32_t query = first_query(view);
    vkCmdResetQueryPool(commands, view->timestamps, query, 2);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, view->timestamps, query);

    /* Records uploads of loaded tiles, and publishes them to the shaders. */
    return check(sluiceBeginStreamingFrame(view->streamer, commands, time_stamp, frame),
                 "sluiceBeginStreamingFrame");
}

/* Records one frame of a streaming application. Commands after the last time stamp are for
 * measuring only. */
static bool record_frame(struct view *view, struct view_slot *slot,
                         const SluiceStreamingFrame *frame, double *needs_seconds)
{
    const struct view_request *request = &view->request;
    static const float background[4] = {0.02f, 0.02f, 0.02f, 1.0f};
    const struct renderer_sets sets = {frame->descriptorSet, slot->frame_set, view->neural.set};
    VkCommandBuffer commands = slot->commands;

    if (request->counting)
        record_counting(view, slot, &sets);
    if (view->looks_ahead)
        record_prediction(view, frame->descriptorSet, commands);

    if (!neural_view_begin(&view->neural, view->frame_index % VIEW_FRAMES_IN_FLIGHT, commands))
        return false;
    target_begin(request->target, commands, background);
    renderer_draw(&view->renderer, commands, &sets, view->surfaces, RENDERER_SURFACE);
    target_end(request->target, commands);

    /* Records the readback of the shaders' feedback. */
    if (!neural_view_end(&view->neural, commands) ||
        !check(sluiceEndStreamingFrame(view->streamer, commands), "sluiceEndStreamingFrame"))
        return false;

    target_copy_out(request->target, commands, slot->pixels.buffer);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, view->timestamps,
                        first_query(view) + 1);
    double start = clock_seconds();
    if (request->needs)
        needs_pass_record(&view->needs, request->target, view->surfaces, frame->descriptorSet,
                          &slot->needs, commands);
    *needs_seconds = clock_seconds() - start;
    return true;
}

static bool submit(struct view *view, struct view_slot *slot, const SluiceStreamingFrame *frame)
{
    uint32_t slot_index = view->frame_index % VIEW_FRAMES_IN_FLIGHT;
    uint32_t launches = view->neural.loader ? 1 : 0;
    const SluiceDemandLaunch *launch = &view->neural.launches[slot_index];
    const uint64_t values[] = {frame->signalValue, launch->signalValue};
    const VkSemaphore semaphores[] = {frame->semaphore, launch->semaphore};
    VkTimelineSemaphoreSubmitInfo timeline = {.sType =
                                                  VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                              .signalSemaphoreValueCount = 1 + launches,
                                              .pSignalSemaphoreValues = values};
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .pNext = &timeline,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &slot->commands,
                         .signalSemaphoreCount = 1 + launches,
                         .pSignalSemaphores = semaphores};
    if (!gpu_check(vkQueueSubmit(view->request.gpu->queue, 1, &info, VK_NULL_HANDLE),
                   "vkQueueSubmit"))
        return false;
    view->neural.under_way[slot_index] = launches > 0;
    slot->semaphore = frame->semaphore;
    slot->signal_value = frame->signalValue;
    return true;
}

static struct camera camera_of(const float *m)
{
    const struct vec3 back = {m[2], m[6], m[10]};
    const struct vec3 eye = {-(m[0] * m[12] + m[1] * m[13] + m[2] * m[14]),
                             -(m[4] * m[12] + m[5] * m[13] + m[6] * m[14]),
                             -(m[8] * m[12] + m[9] * m[13] + m[10] * m[14])};
    return (struct camera){eye, vec3_sub(eye, back)};
}

static void look_ahead(struct view *view, const struct camera *camera, double seconds)
{
    const struct mat4 look = mat4_look_at(camera->eye, camera->target);
    const SluiceLookAheadInfo info = {.structSize = sizeof info,
                                      .seconds = view->request.settings->predict,
                                      .frameIndex = view->frame_index,
                                      .pictureWidth = view->request.target->width,
                                      .pictureHeight = view->request.target->height,
                                      .shrink = PREDICT_SHRINKS};
    SluiceLookAhead ahead = {.structSize = sizeof ahead};
    view->looks_ahead = false;
    if (!view->predict.renderer)
        return;
    (void)sluiceAddCameraFrame(&view->motion, &look.m[0][0],
                               seconds); /* an invalid camera counts as no motion */
    sluicePredictCamera(&view->motion, &info, &ahead);
    view->looks_ahead = ahead.draw;
    view->now = *camera;
    view->ahead = camera_of(ahead.viewMatrix);
}

bool view_draw(struct view *view, const struct camera *camera, uint64_t time_stamp,
               struct view_frame *out)
{
    uint32_t slot_index = view->frame_index % VIEW_FRAMES_IN_FLIGHT;
    struct view_slot *slot = &view->slots[slot_index];
    if (!view_wait(view, slot_index))
        return false;
    double start = clock_seconds(), needs_seconds;
    slowness_set_time(&view->slowness, time_stamp);
    write_frame_data(view, camera, slot->frame.mapped);
    look_ahead(view, camera, 1e-6 * (double)time_stamp);

    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    if (!gpu_check(vkBeginCommandBuffer(slot->commands, &begin), "vkBeginCommandBuffer") ||
        !begin_frame(view, slot, time_stamp, &frame))
        return false;
    if (!record_frame(view, slot, &frame, &needs_seconds) ||
        !gpu_check(vkEndCommandBuffer(slot->commands), "vkEndCommandBuffer") ||
        !submit(view, slot, &frame)) {
        sluiceAbandonStreamingFrame(view->streamer,
                                    &frame); /* the next frame repeats its uploads */
        return false;
    }
    out->host_seconds = clock_seconds() - start - needs_seconds;
    out->statistics.structSize = sizeof out->statistics;
    sluiceGetVulkanStreamerStatistics(view->streamer, &out->statistics);
    out->neural_bytes = neural_view_memory(&view->neural);
    view->frame_index++;
    return true;
}

bool view_wait(const struct view *view, uint32_t slot)
{
    const struct view_slot *waited = &view->slots[slot];
    if (waited->signal_value == 0)
        return true;
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &waited->semaphore,
                                .pValues = &waited->signal_value};
    return gpu_check(vkWaitSemaphores(view->request.gpu->device, &info, WAIT_NANOSECONDS),
                     "vkWaitSemaphores");
}

const uint8_t *view_pixels(const struct view *view, uint32_t slot)
{
    return view->slots[slot].pixels.mapped;
}

struct GalleryCounts view_counts(const struct view *view, uint32_t slot)
{
    struct GalleryCounts counts;
    memcpy(&counts, view->slots[slot].counts.mapped, sizeof counts);
    return counts;
}

double view_gpu_seconds(const struct view *view, uint32_t slot)
{
    uint64_t ticks[2] = {0, 0};
    if (vkGetQueryPoolResults(view->request.gpu->device, view->timestamps, 2 * slot, 2,
                              sizeof ticks, ticks, sizeof *ticks,
                              VK_QUERY_RESULT_64_BIT) != VK_SUCCESS)
        return 0.0;
    return (double)(ticks[1] - ticks[0]) * 1e-9 *
           (double)view->request.gpu->properties.limits.timestampPeriod;
}

bool view_settle(struct view *view)
{
    uint32_t newest = (view->frame_index + VIEW_FRAMES_IN_FLIGHT - 1) % VIEW_FRAMES_IN_FLIGHT;
    return neural_view_process(&view->neural, newest, true) &&
           check(sluiceWaitVulkanStreamerIdle(view->streamer), "sluiceWaitVulkanStreamerIdle");
}

uint64_t view_tile_count(const struct view *view)
{
    SluiceVulkanStreamerStatistics statistics = {.structSize = sizeof statistics};
    sluiceGetVulkanStreamerStatistics(view->streamer, &statistics);
    return statistics.tileCount;
}
