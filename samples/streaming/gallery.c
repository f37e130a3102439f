#include "gallery.h"

#include <inttypes.h>
#include <stdio.h>

#include "../../tools/common/descriptors.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/progress.h"
#include "../../tools/common/text.h"

/* Recordings, traces, frames of the reference, and three files per worker of comparison.c. */
#define WRITTEN_AT_ONCE 210

/* Frames without a new tile after which the device is out of memory. It is retried more often than
 * that. */
#define FRAMES_IN_VAIN 240

static bool open_surroundings(struct gallery *gallery)
{
    const SluiceFormat format = SLUICE_FORMAT_R8G8B8A8_SRGB;
    uint32_t scale = gallery->settings.generate_scale;
    gallery->floor_pattern =
        (struct pattern_image){"parquet", 4096 / scale, 4096 / scale, pattern_parquet, 1};
    gallery->wall_pattern =
        (struct pattern_image){"wallpaper", 2048 / scale, 2048 / scale, pattern_wallpaper, 1};
    if (pattern_create_source(&gallery->floor_pattern, format, &gallery->floor) == SLUICE_SUCCESS &&
        pattern_create_source(&gallery->wall_pattern, format, &gallery->wall) == SLUICE_SUCCESS &&
        room_build(&gallery->pictures, &gallery->room))
        return true;
    fprintf(stderr, "out of memory\n");
    return false;
}

static bool counts_residency(const struct gallery *gallery)
{
    const struct settings *settings = &gallery->settings;
    SluiceResidencyMode mode = gallery->gpu.modes[0];
    /* Sparse images report residency and pages have a table. In dense mode everything is
     * resident. */
    bool able =
        mode == SLUICE_RESIDENCY_MODE_PAGED ||
        (mode == SLUICE_RESIDENCY_MODE_SPARSE && gallery->gpu.capabilities.shaderResourceResidency);
    if (settings->check_residency == THREE_WAY_ON && !able)
        text_say("%s cannot tell in this mode what is not resident: nothing is checked",
                 gallery->gpu.properties.deviceName);
    return able && (settings->check_residency == THREE_WAY_ON ||
                    (settings->check_residency == THREE_WAY_AUTO && settings->compare));
}

struct camera gallery_camera(const struct settings *settings, const struct room *room,
                             uint32_t frame)
{
    uint32_t rest = settings->frames - settings->rest_frames;
    return walk_camera(room, frame < rest ? (float)frame / (float)rest : 1.0f);
}

bool gallery_fill(struct view *view, const struct room *room)
{
    struct camera camera = walk_camera(room, 0.0f);
    uint64_t tile_count = view_tile_count(view);
    uint32_t count = 0, in_vain = 0;
    struct progress progress;
    struct view_frame frame = {0};
    progress_begin(&progress, "loading everything to compare with", "tiles", tile_count);
    do {
        if (!view_wait(view, view->frame_index % VIEW_FRAMES_IN_FLIGHT) ||
            !view_draw(view, &camera, 0, &frame) || !view_settle(view))
            return false;
        progress_update(&progress, frame.statistics.mappedTileCount);
        if (frame.statistics.givenUpTileCount > 0) {
            fprintf(stderr, "%u tiles cannot be loaded\n", frame.statistics.givenUpTileCount);
            return false;
        }
        /* Count frames without a new tile. Tiles for which there is no memory wait and are never
         * given up. */
        in_vain = frame.statistics.mappedTileCount > count ? 0 : in_vain + 1;
        count = frame.statistics.mappedTileCount;
        if (in_vain > FRAMES_IN_VAIN) {
            fprintf(stderr, "the device has no memory for more than %u of %" PRIu64 " tiles\n",
                    count, tile_count);
            return false;
        }
    } while (frame.statistics.mappedTileCount < tile_count);
    progress_end(&progress);
    return true;
}

/* Draws whole rounds of the frames in flight, so that the walk begins with the first slot again. */
static bool warm_up(struct gallery *gallery)
{
    struct view *view = &gallery->streamed;
    struct camera camera = walk_camera(&gallery->room, 0.0f);
    struct view_frame frame;
    uint32_t count = gallery->settings.warm_up;
    for (uint32_t i = 0; i < count || i % VIEW_FRAMES_IN_FLIGHT > 0; i++) {
        uint64_t steps = i < count ? i + 1 : count;
        uint64_t time_stamp = steps * 1000000u / gallery->settings.frames_per_second;
        if (!view_draw(view, &camera, time_stamp, &frame) ||
            !view_wait(view, i % VIEW_FRAMES_IN_FLIGHT) || !view_settle(view))
            return false;
    }
    view->frame_index = 0;
    return true;
}

static bool open_views(struct gallery *gallery)
{
    const struct settings *settings = &gallery->settings;
    struct view_request request = {
        .gpu = &gallery->gpu,
        .room = &gallery->room,
        .target = &gallery->target,
        .settings = settings,
        .pictures = &gallery->pictures,
        .floor = gallery->floor,
        .wall = gallery->wall,
        .mode = gallery->gpu.modes[0],
        .counting = counts_residency(gallery),
        .needs = settings_find_needs(settings),
    };
    if (!target_create(&gallery->gpu, settings->size[0], settings->size[1], settings->samples,
                       &gallery->target) ||
        !view_create(&request, settings->record, &gallery->streamed) || !warm_up(gallery))
        return false;
    if (!settings->compare)
        return true;
    request.everything = true;
    request.counting = false;
    request.needs = false;
    request.mode = gallery->gpu.modes[1];
    return view_create(&request, NULL, &gallery->truth) &&
           gallery_fill(&gallery->truth, &gallery->room);
}

static struct picture_limits device_limits(const struct gpu *gpu)
{
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceFeatures(gpu->physical_device, &features);
    return (struct picture_limits){
        .max_size = gpu->properties.limits.maxImageDimension2D,
        .max_bytes =
            gpu->capabilities.sparse ? gpu->capabilities.sparseAddressSpaceSize : UINT64_MAX,
        .takes_blocks = features.textureCompressionBC,
    };
}

/* Checks outputs before anything is drawn. */
static bool outputs_spare_inputs(const struct gallery *gallery)
{
    const struct settings *settings = &gallery->settings;
    char csv[4096], report[4096];
    bool good = true;
    for (size_t i = 0; i < settings->images.count && good; i++)
        good = output_add_input(settings->images.items[i]);
    good = good && (!settings->neural || output_add_input(settings->neural));
    for (uint32_t i = 0; i < gallery->pictures.count && good; i++)
        good = output_add_input(gallery->pictures.pictures[i].path);
    settings_report_path(settings, "frames", ".csv", csv, sizeof csv);
    settings_report_path(settings, "report", ".html", report, sizeof report);
    return good && output_spares_inputs(csv) && output_spares_inputs(report) &&
           (!settings->record || output_spares_inputs(settings->record)) &&
           (!settings->needs_trace || output_spares_inputs(settings->needs_trace));
}

enum gallery_outcome gallery_open(struct gallery *gallery)
{
    const struct settings *settings = &gallery->settings;
    struct gpu_request device = {settings->device,
                                 settings->validation,
                                 {settings_residency_mode(settings->residency),
                                  settings_residency_mode(settings->compare_with)}};
    for (uint32_t i = 0; settings->neural && i < settings->neural_mode_count; i++)
        device.byte_pages = device.neural =
            device.byte_pages || settings->neural_modes[i] == NEURAL_SAMPLE;
    bool unsupported;
    if (!gpu_create(&device, &gallery->gpu, &unsupported))
        return unsupported ? GALLERY_NO_DEVICE : GALLERY_FAILED;
    struct picture_limits limits = device_limits(&gallery->gpu);
    /* Keep descriptors for the outputs of the walk, because pictures stay open. */
    struct descriptors_kept kept;
    descriptors_keep(&kept, WRITTEN_AT_ONCE);
    bool hung = pictures_open(settings, &limits, &gallery->pictures);
    descriptors_release(&kept);
    gpu_choose_mode(&gallery->gpu, view_texture_count(&gallery->pictures));
    return hung && outputs_spare_inputs(gallery) && open_surroundings(gallery) &&
                   (!settings->reference || reference_open(gallery, &gallery->reference)) &&
                   open_views(gallery)
               ? GALLERY_READY
               : GALLERY_FAILED;
}

bool gallery_close(struct gallery *gallery)
{
    bool recorded = view_destroy(&gallery->streamed);
    view_destroy(&gallery->truth);
    reference_close(&gallery->reference);
    if (gallery->gpu.device)
        target_destroy(&gallery->gpu, &gallery->target);
    room_finish(&gallery->room);
    sluiceDestroyImageSource(gallery->floor);
    sluiceDestroyImageSource(gallery->wall);
    pictures_close(&gallery->pictures);
    gpu_destroy(&gallery->gpu);
    return recorded;
}
