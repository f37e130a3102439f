#include "stage.h"

#include "fault_source.h"
#include "scene_data.h"
#include "scene_images.h"
#include "scene_played.h"
#include "stage_draw.h"
#include "stage_pick.h"
#include "traced.h"

#include "../../samples/common/slow_source.h"
#include "../common/log.h"
#include "../common/text.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_BUDGET (4ull << 20)
#define FROZEN_SECONDS 1e9 /* feedback timeout while requests are frozen (L) */

struct stage {
    const struct gpu *gpu;
    struct scene_data scene;
    struct view_settings settings; ///< settings applied last
    struct view_settings opened;   ///< settings at creation
    struct traced *traced;         ///< traced scene, which leaves most other fields unused; or NULL
    struct played *played; ///< recording, which leaves all fields but textures unused; or NULL
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    struct stage_drawing drawing;
    struct stage_texture *textures;
    uint32_t *table_indices;
    struct tile_marks marks;
    uint32_t baking_count, heap_tiles;
    struct frames_signal last;  ///< signal of the last recorded frame
    uint32_t finest_level;      ///< finest level set for all textures
    SluiceImageSource **slow;   ///< wrap the scene's sources; NULL without a slow line
    SluiceImageSource **faulty; ///< wrap `slow`, or the scene's sources
    atomic_uint source_fails;
    struct slow_line line;
    bool is_slow;
    atomic_uint_least64_t now;
};

static bool check(SluiceResult result, const char *what)
{
    if (result == SLUICE_SUCCESS)
        return true;
    text_say("sluice-view: %s: %s", what, sluiceGetResultName(result));
    return false;
}

static uint64_t slow_now(void *user_data)
{
    return atomic_load(&((struct stage *)user_data)->now);
}

static bool begin_slowness(struct stage *s)
{
    if (s->settings.source_latency <= 0 && s->settings.source_bandwidth <= 0)
        return true;
    const struct slow_line_info info = {1e3 * s->settings.source_latency,
                                        s->settings.source_bandwidth, slow_now, s};
    s->slow = calloc(s->scene.image_count + 1, sizeof *s->slow);
    s->is_slow = s->slow && slow_line_init(&s->line, &info);
    for (uint32_t i = 0; s->is_slow && i < s->scene.image_count; i++)
        if (!check(slow_source_create(&s->line, s->scene.images[i].source, &s->slow[i]),
                   "slow_source_create"))
            return false;
    return s->is_slow;
}

static bool begin_faults(struct stage *s)
{
    s->faulty = calloc(s->scene.image_count + 1, sizeof *s->faulty);
    for (uint32_t i = 0; s->faulty && i < s->scene.image_count; i++)
        if (!check(fault_source_create(&s->source_fails,
                                       s->slow ? s->slow[i] : s->scene.images[i].source,
                                       &s->faulty[i]),
                   "fault_source_create"))
            return false;
    return s->faulty;
}

static SluiceResidencyMode mode_of(const struct view_settings *settings)
{
    static const SluiceResidencyMode modes[] = {
        SLUICE_RESIDENCY_MODE_AUTO, SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED,
        SLUICE_RESIDENCY_MODE_DENSE};
    return modes[settings->residency];
}

/* Chooses heaps of at most an eighth of the budget, down to STAGE_LEAST_HEAP_TILES. Buffers of the
 * streamer count against the budget, too, so a heap as large as the budget would not fit. */
static uint32_t choose_heap_tiles(uint64_t budget)
{
    const uint64_t most = budget / 8 / SLUICE_DEFAULT_TILE_SIZE;
    uint32_t tiles = STAGE_HEAP_TILES;
    while (budget > 0 && tiles > most && tiles > STAGE_LEAST_HEAP_TILES)
        tiles /= 2;
    return tiles;
}

const struct view_settings *stage_opened(const struct stage *s)
{
    return &s->opened;
}

uint32_t stage_heap_tiles(const struct stage *s)
{
    return s->heap_tiles;
}

/* Returns the maps per frame. The streamer has room for one texture more than the scene. */
static uint32_t maps_per_frame(const struct stage *s, uint32_t wanted)
{
    const uint32_t all = s->scene.image_count + 1;
    return wanted == 0 || wanted > all ? all : wanted;
}

static bool create_streamer(struct stage *s, const struct stage_request *request)
{
    const SluiceVulkanStreamerDebugInfo debug = {
        .structSize = sizeof debug, .mapEverything = s->settings.load == VIEW_LOAD_EVERYTHING};
    const struct gpu *gpu = s->gpu;
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = gpu->family,
                                                   .instance = gpu->instance,
                                                   .physicalDevice = gpu->physical_device,
                                                   .device = gpu->device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .sparseQueue = gpu->sparse_queue,
                                                   .sparseQueueFamilyIndex = gpu->sparse_family,
                                                   .log = {NULL, log_say},
                                                   .loaderThreadCount = request->threads};
    const SluiceVulkanStreamerCreateInfo streamer = {
        .structSize = sizeof streamer,
        .residencyMode = mode_of(&s->settings),
        .framesInFlight = FRAMES_SLOTS,
        .maxTextureCount = s->scene.image_count + 1,
        .maxTexturesPerFrame = s->scene.image_count + 1,
        .texturesPerFrame = maps_per_frame(s, s->settings.textures_per_frame),
        .feedbackInTurns = true, /* shaders choose in each frame whether to use turns */
        .tilesPerFrame = s->settings.tiles_per_frame,
        .maxLoadsInFlight = s->settings.loads_in_flight,
        .heapTileCapacity = s->heap_tiles,
        .textureArray = SLUICE_TEXTURE_ARRAY_COMBINED,
        .ticksPerSecond = STAGE_TICKS_PER_SECOND,
        .pDebug = &debug};
    if (!check(sluiceCreateVulkanContext(&context, &s->context), "sluiceCreateVulkanContext"))
        return false;
    SluiceVulkanStreamerCreateInfo info = streamer;
    info.context = s->context;
    return check(sluiceCreateVulkanStreamer(&info, &s->streamer), "sluiceCreateVulkanStreamer");
}

static const char *format_name(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_R8_UNORM: return "R8";
    case SLUICE_FORMAT_R8G8B8A8_UNORM: return "RGBA8";
    case SLUICE_FORMAT_R8G8B8A8_SRGB: return "RGBA8 sRGB";
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: return "RGBA16F";
    case SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK:
    case SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK: return "BC1";
    case SLUICE_FORMAT_BC3_SRGB_BLOCK:
    case SLUICE_FORMAT_BC3_UNORM_BLOCK: return "BC3";
    case SLUICE_FORMAT_BC7_SRGB_BLOCK:
    case SLUICE_FORMAT_BC7_UNORM_BLOCK: return "BC7";
    default: return "other";
    }
}

static uint32_t primary_of(const struct stage *s, uint32_t i)
{
    return s->settings.texture_sets == VIEW_ON ? s->scene.images[i].primary : STAGE_NO_TEXTURE;
}

static bool describe_texture(struct stage *s, uint32_t i, const SluiceVulkanTexture *texture)
{
    const struct scene_image *image = &s->scene.images[i];
    SluiceImageInfo about = {.structSize = sizeof about};
    SluiceStreamedTextureManager *manager = NULL;
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    if (!check(sluiceGetVulkanStreamerManager(s->streamer, &manager), image->name) ||
        !check(sluiceGetTextureLayout(manager, texture->textureId, &layout), image->name) ||
        !check(sluiceGetImageInfo(image->source, &about), image->name))
        return false;
    s->table_indices[i] = texture->tableIndex;
    s->textures[i] = (struct stage_texture){texture->textureId,
                                            image->name,
                                            image->path,
                                            texture->width,
                                            texture->height,
                                            texture->mipLevelCount,
                                            primary_of(s, i),
                                            format_name(about.format),
                                            (uint64_t)layout.tileCount * SLUICE_DEFAULT_TILE_SIZE};
    return true;
}

/* Returns true for faults of a file or of its format. Other errors end the scene. */
static bool can_be_replaced(SluiceResult result)
{
    return result == SLUICE_ERROR_UNSUPPORTED || result == SLUICE_ERROR_INVALID_ARGUMENT ||
           result == SLUICE_ERROR_CORRUPT_DATA || result == SLUICE_ERROR_IO;
}

/* Wraps the new source of a replaced image. Its old wrappers hold a destroyed source. */
static SluiceResult wrap_replaced(struct stage *s, uint32_t i)
{
    SluiceImageSource *source = s->scene.images[i].source;
    SluiceResult result = SLUICE_SUCCESS;
    sluiceDestroyImageSource(s->faulty[i]);
    s->faulty[i] = NULL;
    if (s->slow) {
        sluiceDestroyImageSource(s->slow[i]);
        s->slow[i] = NULL;
        result = slow_source_create(&s->line, source, &s->slow[i]);
        source = s->slow[i];
    }
    return result == SLUICE_SUCCESS ? fault_source_create(&s->source_fails, source, &s->faulty[i])
                                    : result;
}

static bool add_texture(struct stage *s, uint32_t i)
{
    const struct scene_image *image = &s->scene.images[i];
    const bool follows = primary_of(s, i) != STAGE_NO_TEXTURE;
    SluiceVulkanTexture texture;
    SluiceVulkanTextureCreateInfo info = {
        .structSize = sizeof info,
        .source = s->faulty[i],
        .primaryId = follows ? s->textures[image->primary].id : SLUICE_NO_TEXTURE,
        .pUvTransform = image->transformed ? &image->transform : NULL,
        .addressModeU = (VkSamplerAddressMode)image->wrap_u,
        .addressModeV = (VkSamplerAddressMode)image->wrap_v,
        .explicitAddressModes = true,
        .maxAnisotropy = (float)s->settings.anisotropy};
    SluiceResult result = sluiceAddVulkanTexture(s->streamer, &info, &texture);
    if (can_be_replaced(result) && scene_images_replace(&s->scene, i, result)) {
        result = wrap_replaced(s, i);
        info.source = s->faulty[i];
        if (result == SLUICE_SUCCESS)
            result = sluiceAddVulkanTexture(s->streamer, &info, &texture);
    }
    return check(result, image->name) && describe_texture(s, i, &texture);
}

/* Adds primaries first, since followers need their ids. */
static bool add_textures(struct stage *s)
{
    for (int follows = 0; follows < 2; follows++)
        for (uint32_t i = 0; i < s->scene.image_count; i++)
            if ((s->scene.images[i].primary != SCENE_NO_IMAGE) == follows && !add_texture(s, i))
                return false;
    return true;
}

static bool create_marks(struct stage *s)
{
    SluiceTextureId *ids = malloc((s->scene.image_count + 1u) * sizeof *ids);
    for (uint32_t i = 0; ids && i < s->scene.image_count; i++)
        ids[i] = s->textures[i].id;
    const bool created =
        ids && tile_marks_create(s->streamer, ids, s->scene.image_count, &s->marks);
    if (!created)
        text_say("sluice-view: out of memory for the marks of tiles");
    free(ids);
    return created;
}

static bool create_drawing(struct stage *s, const struct shader_code *code)
{
    SluiceResidencyMode mode;
    VkDescriptorSetLayout layout;
    return check(sluiceGetVulkanResidencyMode(s->streamer, &mode),
                 "sluiceGetVulkanResidencyMode") &&
           check(sluiceGetVulkanDescriptorSetLayout(s->streamer, &layout),
                 "sluiceGetVulkanDescriptorSetLayout") &&
           stage_drawing_create(s->gpu, &s->scene,
                                &(struct stage_drawing_info){s->table_indices, layout, &s->marks,
                                                             code,
                                                             mode == SLUICE_RESIDENCY_MODE_PAGED},
                                &s->drawing);
}

struct stage *stage_create(const struct stage_request *request,
                           const struct view_settings *settings, struct scene_data *scene)
{
    struct stage *s = calloc(1, sizeof *s);
    if (!s) {
        scene_data_finish(scene);
        return NULL;
    }
    s->scene = *scene;
    *scene = (struct scene_data){0};
    s->gpu = request->gpu;
    s->settings = s->opened = *settings;
    s->heap_tiles = choose_heap_tiles(settings->budget);
    if (s->scene.pbrt) {
        s->traced = traced_create(request, settings, s->scene.pbrt);
        s->scene.pbrt = NULL;
        if (s->traced)
            return s;
        stage_destroy(s);
        return NULL;
    }
    if (s->scene.played) {
        s->played = s->scene.played; /* freed with the scene */
        s->heap_tiles = s->played->begin.heapTileCapacity;
        s->textures = scene_played_textures(s->played);
        if (s->textures)
            return s;
        text_say("sluice-view: out of memory");
        stage_destroy(s);
        return NULL;
    }
    s->textures = calloc(s->scene.image_count + 1, sizeof *s->textures);
    s->table_indices = calloc(s->scene.image_count + 1, sizeof *s->table_indices);
    if (s->textures && s->table_indices && begin_slowness(s) && begin_faults(s) &&
        create_streamer(s, request) && add_textures(s) && create_marks(s) &&
        create_drawing(s, request->code)) {
        s->baking_count = scene_images_baking(&s->scene);
        stage_apply(s, settings);
        return s;
    }
    stage_destroy(s);
    return NULL;
}

void stage_destroy(struct stage *s)
{
    if (!s)
        return;
    traced_destroy(s->traced);
    sluiceDestroyVulkanStreamer(s->streamer);
    sluiceDestroyVulkanContext(s->context);
    stage_drawing_destroy(&s->drawing);
    tile_marks_destroy(&s->marks);
    for (uint32_t i = 0; s->faulty && i < s->scene.image_count; i++)
        sluiceDestroyImageSource(s->faulty[i]);
    for (uint32_t i = 0; s->slow && i < s->scene.image_count; i++)
        sluiceDestroyImageSource(s->slow[i]);
    if (s->is_slow)
        slow_line_finish(&s->line);
    free(s->faulty);
    free(s->slow);
    scene_data_finish(&s->scene);
    free(s->textures);
    free(s->table_indices);
    free(s);
}

/* Applies the setting of texture sets. A texture that leaves its set writes feedback of its own
 * from the next frame on. */
static void apply_sets(struct stage *s)
{
    for (uint32_t i = 0; i < s->scene.image_count; i++) {
        const uint32_t primary = primary_of(s, i);
        if (s->scene.images[i].primary == SCENE_NO_IMAGE)
            continue;
        s->textures[i].primary = primary;
        check(sluiceSetVulkanPrimaryTexture(s->streamer, s->textures[i].id,
                                            primary == STAGE_NO_TEXTURE ? SLUICE_NO_TEXTURE
                                                                        : s->textures[primary].id),
              "sluiceSetVulkanPrimaryTexture");
    }
}

/* Applies the finest level. Finer tiles become standby tiles. Shaders stop sampling them at once.
 */
static void apply_finest_level(struct stage *s)
{
    s->finest_level = s->settings.finest_level;
    for (uint32_t i = 0; i < s->scene.image_count; i++) {
        SluiceVulkanTextureControl control = {.structSize = sizeof control};
        if (s->textures[i].primary != STAGE_NO_TEXTURE)
            continue;
        if (sluiceGetVulkanTextureControl(s->streamer, s->textures[i].id, &control) !=
            SLUICE_SUCCESS)
            continue;
        control.finestLevel = s->finest_level;
        check(sluiceSetVulkanTextureControl(s->streamer, s->textures[i].id, &control),
              "sluiceSetVulkanTextureControl");
    }
}

void stage_apply(struct stage *s, const struct view_settings *settings)
{
    SluiceVulkanStreamerSettings now = {.structSize = sizeof now};
    if (s->traced) {
        traced_apply(s->traced, settings);
        return;
    }
    if (s->played)
        return;
    const uint64_t budget =
        settings->budget && settings->budget < LEAST_BUDGET ? LEAST_BUDGET : settings->budget;
    check(sluiceSetVulkanMemoryBudget(s->context, budget), "sluiceSetVulkanMemoryBudget");
    if (!check(sluiceGetVulkanStreamerSettings(s->streamer, &now),
               "sluiceGetVulkanStreamerSettings"))
        return;
    now.texturesPerFrame = maps_per_frame(s, settings->textures_per_frame);
    now.tilesPerFrame = settings->tiles_per_frame;
    now.numExtraStandbyTiles = settings->standby;
    now.feedbackTimeoutTicks =
        (uint64_t)((settings->freeze_wants ? FROZEN_SECONDS : settings->timeout) *
                   STAGE_TICKS_PER_SECOND);
    now.residencyFadeTicks = (uint64_t)(settings->fade * STAGE_TICKS_PER_SECOND);
    now.holdLoads = settings->pause != 0;
    now.missesToExpire = settings->misses;
    now.prefetchLevels = settings->prefetch_levels;
    check(sluiceSetVulkanStreamerSettings(s->streamer, &now), "sluiceSetVulkanStreamerSettings");
    const bool other_sets = settings->texture_sets != s->settings.texture_sets;
    const bool other_finest = settings->finest_level != s->finest_level;
    s->settings = *settings;
    if (other_sets)
        apply_sets(s);
    if (other_sets || other_finest)
        apply_finest_level(s);
    atomic_store(&s->source_fails, settings->source_fails);
}

/* Retries reads that failed because their picture was still being baked. */
static void look_at_bakes(struct stage *s)
{
    const uint32_t before = s->baking_count;
    if (before == 0)
        return;
    s->baking_count = scene_images_baking(&s->scene);
    if (s->baking_count < before)
        sluiceRetryVulkanSource(s->streamer, NULL);
}

bool stage_share_scene(const struct stage *s, struct scene_data *scene)
{
    *scene = (struct scene_data){0};
    return s->traced && scene_pbrt_share(s->traced->pbrt, &s->scene, scene);
}

bool stage_record(struct stage *s, const struct stage_draw *draw, VkCommandBuffer commands,
                  struct frames_end *end)
{
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    if (s->traced)
        return traced_record(s->traced, draw, commands, end);
    if (s->played)
        return true; /* panels draw it */
    atomic_store(&s->now, draw->time_stamp);
    look_at_bakes(s);
    if (!check(sluiceBeginStreamingFrame(s->streamer, commands, draw->time_stamp, &frame),
               "sluiceBeginStreamingFrame"))
        return false;
    const uint32_t view = draw->settings->view;
    tile_marks_update(&s->marks, draw->time_stamp, view == VIEW_MISSING || view == VIEW_AGE);
    end->views[UI_TEXTURE_PICTURE] =
        stage_drawing_record(&s->drawing, &s->scene, draw, frame.descriptorSet,
                             (uint32_t)(draw->number % FRAMES_SLOTS), commands);
    s->last = (struct frames_signal){frame.semaphore, frame.signalValue};
    end->signals[end->signal_count++] = s->last;
    return end->views[UI_TEXTURE_PICTURE] &&
           check(sluiceEndStreamingFrame(s->streamer, commands), "sluiceEndStreamingFrame");
}

/* Waits for the semaphore of the last frame. The streamer reads feedback of frames whose semaphore
 * is signaled. Drivers may signal the fence of a frame before its semaphore, so the fence is not
 * enough. */
static bool wait_for_last(const struct stage *s)
{
    const VkSemaphoreWaitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &s->last.semaphore,
                                      .pValues = &s->last.value};
    return !s->last.semaphore ||
           gpu_check(vkWaitSemaphores(s->gpu->device, &wait, UINT64_MAX), "vkWaitSemaphores");
}

bool stage_settle(struct stage *s)
{
    return s->traced || s->played ||
           (wait_for_last(s) &&
            check(sluiceWaitVulkanStreamerIdle(s->streamer), "sluiceWaitVulkanStreamerIdle"));
}

bool stage_prepare_shaders(struct stage *s, const struct shader_code *code)
{
    return s->streamer && stage_drawing_prepare(&s->drawing, &s->scene, code);
}

void stage_take_shaders(struct stage *s)
{
    stage_drawing_take(&s->drawing);
}

void stage_drop_shaders(struct stage *s)
{
    stage_drawing_drop(&s->drawing);
}

void stage_restart(struct stage *s)
{
    for (uint32_t i = 0; i < s->scene.image_count; i++)
        sluiceEvictVulkanTexture(s->streamer, s->textures[i].id, 0);
}

uint32_t stage_baking_count(const struct stage *s)
{
    return s->traced ? traced_opening_count(s->traced) : s->baking_count;
}

double stage_resident_part(const struct stage *s)
{
    SluiceStreamedTextureManager *manager = NULL;
    SluiceStreamedTextureStatistics now = {.structSize = sizeof now};
    if (s->traced)
        return traced_complete(s->traced);
    sluiceGetVulkanStreamerManager(s->streamer, &manager);
    if (sluiceGetStatistics(manager, &now) != SLUICE_SUCCESS || now.tileCount == 0)
        return 1.0;
    return (double)(now.mappedTileCount + now.standbyTileCount) / (double)now.tileCount;
}

const char *stage_name(const struct stage *s)
{
    return s->scene.name;
}

SluiceVulkanStreamer *stage_streamer(const struct stage *s)
{
    return s->streamer;
}

SluiceStreamedTextureManager *stage_manager(const struct stage *s)
{
    SluiceStreamedTextureManager *manager = s->played ? s->played->manager : NULL;
    if (s->streamer)
        sluiceGetVulkanStreamerManager(s->streamer, &manager);
    return manager;
}

struct played *stage_played(const struct stage *s)
{
    return s->played;
}

struct traced *stage_traced(const struct stage *s)
{
    return s->traced;
}

SluiceVulkanContext *stage_context(const struct stage *s)
{
    return s->traced ? s->traced->context : s->context;
}

uint32_t stage_message_count(const struct stage *s)
{
    return s->scene.message_count;
}

const char *stage_message(const struct stage *s, uint32_t index)
{
    return s->scene.messages[index];
}

uint32_t stage_texture_count(const struct stage *s)
{
    return s->traced   ? s->traced->picture_count
           : s->played ? s->played->texture_count
                       : s->scene.image_count;
}

const SluiceImageSource *stage_source(const struct stage *s, uint32_t index)
{
    return s->streamer ? s->faulty[index] : NULL;
}

SluiceImageSource *stage_borrow_source(const struct stage *s, uint32_t index)
{
    return s->traced ? traced_borrow_source(s->traced, index)
                     : (SluiceImageSource *)stage_source(s, index);
}

void stage_return_source(const struct stage *s, uint32_t index, SluiceImageSource *source)
{
    if (s->traced)
        traced_return_source(s->traced, index, source);
}

const struct stage_texture *stage_texture(const struct stage *s, uint32_t index)
{
    return s->traced ? &s->traced->pictures[index].texture : &s->textures[index];
}

struct view_camera stage_camera(const struct stage *s)
{
    return s->scene.camera;
}

void stage_bounds(const struct stage *s, struct vec3 bounds[2])
{
    bounds[0] = s->scene.bounds[0];
    bounds[1] = s->scene.bounds[1];
}

uint32_t stage_camera_count(const struct stage *s)
{
    return s->scene.camera_count;
}

const struct file_camera *stage_file_camera(const struct stage *s, uint32_t index)
{
    return &s->scene.cameras[index];
}

const struct camera_path *stage_tour(const struct stage *s)
{
    return &s->scene.tour;
}

struct stage_pick stage_pick(const struct stage *s, const struct view_camera *camera, float aspect,
                             float x, float y)
{
    return s->traced ? traced_pick(s->traced, camera, x, y)
                     : scene_pick(&s->scene, camera, aspect, x, y);
}

bool stage_pick_pixel(const struct stage *s, const struct stage_pick *pick,
                      const struct stage_pixel *pixel, float texels[4])
{
    if (!scene_pick_pixel(&s->scene, pick, pixel, texels))
        return false;
    for (int i = 0; i < 4; i++)
        texels[i] *= (float)(i % 2 == 0 ? s->textures[pick->texture].width
                                        : s->textures[pick->texture].height);
    return true;
}

bool stage_find_texel(const struct stage *s, uint32_t texture, float u, float v,
                      struct vec3 *position, struct vec3 *normal)
{
    return scene_find_texel(&s->scene, texture, u, v, position, normal);
}

uint32_t stage_triangle_count(const struct stage *s)
{
    return s->scene.index_count / 3;
}

uint64_t stage_now(const struct stage *s)
{
    return s->played ? s->played->frames[s->played->frame].time : atomic_load(&s->now);
}
