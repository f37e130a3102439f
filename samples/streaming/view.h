/**
 * The gallery drawn through one streamer: textures, frames in flight, results. A comparison has two
 * views of one room: one streams, the other has everything resident.
 */
#ifndef SAMPLES_STREAMING_VIEW_H
#define SAMPLES_STREAMING_VIEW_H

#include "camera.h"
#include "needs_pass.h"
#include "neural_view.h"
#include "predict.h"
#include "renderer.h"
#include "settings.h"
#include "slowness.h"

#include <sluice/camera_motion.h>

#define VIEW_FRAMES_IN_FLIGHT 3
#define VIEW_MAX_REGIONS (1u << 20)

/** Inputs that both views share. */
struct view_request {
    const struct gpu *gpu;
    const struct room *room;
    const struct target *target;
    const struct settings *settings;
    const struct picture_list *pictures;
    SluiceImageSource *floor, *wall;
    SluiceResidencyMode mode;
    bool everything; ///< true: make everything resident, as the truth to compare with
    bool counting;   ///< true: count samples of texels that are not resident
    bool needs;      ///< true: count the required tiles of each frame
};

/** Resources of one frame in flight. */
struct view_slot {
    VkCommandBuffer commands;
    VkDescriptorSet frame_set;
    struct gpu_buffer frame, counts, pixels;
    struct needs_slot needs;
    VkSemaphore semaphore; ///< the streamer's
    uint64_t signal_value; ///< 0: never submitted
};

/** Facts about a frame at submission. */
struct view_frame {
    double host_seconds; ///< time from begin to submission, without the needs pass
    SluiceVulkanStreamerStatistics statistics;
    uint64_t neural_bytes; ///< latents, pages and weights in GPU memory
};

struct view {
    struct view_request request;
    SluiceVulkanContext *context;          ///< owned
    SluiceVulkanStreamer *streamer;        ///< owned
    SluiceStreamedTextureManager *manager; ///< the streamer's
    SluiceRecorder *recorder;              ///< owned
    struct renderer renderer;              ///< its pipelines use the streamer's set layout
    struct slowness slowness;              ///< delays of the sources; the truth has none
    struct neural_view neural;             ///< the truth has none
    VkDescriptorPool descriptor_pool;
    struct renderer_surface *surfaces; ///< owned; floor, wall, pictures
    struct needs_id *texture_ids;      ///< owned; ids of all textures, in the order of creation
    SluiceImageSource **sources;       ///< owned; sources of these textures
    uint32_t texture_count;
    struct view_slot slots[VIEW_FRAMES_IN_FLIGHT];
    struct needs_pass needs;
    VkQueryPool timestamps; ///< two per slot
    uint32_t frame_index;   ///< index of the next frame
    struct predict predict; ///< only with --predict
    SluiceCameraMotion motion;
    bool looks_ahead; ///< true: the recorded frame predicts from `now` to `ahead`
    struct camera now, ahead;
};

struct picture_list;
/** Counts the textures of a view with all pictures. */
uint32_t view_texture_count(const struct picture_list *pictures);
/** Reports errors on stderr. Leaves out pictures that cannot be streamed or find no room.
 * `record_path` may be NULL. */
bool view_create(const struct view_request *request, const char *record_path, struct view *view);
/** Ends the recording. Accepts a zeroed struct. Returns false if the recording could not be
 * written. */
bool view_destroy(struct view *view);

/**
 * Records and submits one frame in slot frame_index % VIEW_FRAMES_IN_FLIGHT. Waits for the slot's
 * previous frame. `time_stamp` is in microseconds.
 */
bool view_draw(struct view *view, const struct camera *camera, uint64_t time_stamp,
               struct view_frame *frame);

/** Waits for the frame in a slot. Its pixels and counts can be read afterwards. */
bool view_wait(const struct view *view, uint32_t slot);
const uint8_t *view_pixels(const struct view *view, uint32_t slot);
struct GalleryCounts view_counts(const struct view *view, uint32_t slot);
/** GPU time of a frame that has finished. */
double view_gpu_seconds(const struct view *view, uint32_t slot);

/** Waits for all pending loads, so that the next frame has everything it requested. */
bool view_settle(struct view *view);

/** Tiles of all textures: the memory of full residency. */
uint64_t view_tile_count(const struct view *view);

#endif /* SAMPLES_STREAMING_VIEW_H */
