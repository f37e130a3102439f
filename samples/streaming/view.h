/**
 * The gallery seen through one streamer: its textures, its frames in flight, what came out of them.
 * Two of them draw the same room in a comparison: one streams, the other has everything.
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

/** What is the same for both views. */
struct view_request {
    const struct gpu *gpu;
    const struct room *room;
    const struct target *target;
    const struct settings *settings;
    const struct picture_list *pictures;
    SluiceImageSource *floor, *wall;
    SluiceResidencyMode mode;
    bool everything; ///< resident: the truth to compare with
    bool counting;   ///< count samples of what is not there
    bool needs;      ///< find out what each frame needs
};

/** One frame that may be on its way. */
struct view_slot {
    VkCommandBuffer commands;
    VkDescriptorSet frame_set;
    struct gpu_buffer frame, counts, pixels;
    struct needs_slot needs;
    VkSemaphore semaphore; ///< of the streamer
    uint64_t signal_value; ///< 0: never submitted
};

/** What is known of a frame when it was submitted. */
struct view_frame {
    double host_seconds; ///< from begin to submit, without the needs pass
    SluiceVulkanStreamerStatistics statistics;
    uint64_t neural_bytes; ///< of latents, pages and weights in GPU memory
};

struct view {
    struct view_request request;
    SluiceVulkanContext *context;          ///< owned
    SluiceVulkanStreamer *streamer;        ///< owned
    SluiceStreamedTextureManager *manager; ///< the streamer's
    SluiceRecorder *recorder;              ///< owned
    struct renderer renderer;              ///< its pipelines have the streamer's set layout
    struct slowness slowness;              ///< of its sources; the truth has none
    struct neural_view neural;             ///< the truth has none
    VkDescriptorPool descriptor_pool;
    struct renderer_surface *surfaces; ///< owned; floor, wall, pictures
    struct needs_id *texture_ids;      ///< owned; of all textures, in the order of their making
    SluiceImageSource **sources;       ///< owned; of the same
    uint32_t texture_count;
    struct view_slot slots[VIEW_FRAMES_IN_FLIGHT];
    struct needs_pass needs;
    VkQueryPool timestamps; ///< two per slot
    uint32_t frame_index;   ///< of the next frame
    struct predict predict; ///< only with --predict
    SluiceCameraMotion motion;
    bool looks_ahead; ///< the frame that is recorded, from `now` to `ahead`
    struct camera now, ahead;
};

struct picture_list;
/** Textures of a view, all pictures included. */
uint32_t view_texture_count(const struct picture_list *pictures);
/** Says on stderr what is wrong. Pictures that cannot be streamed, or for which there is no room,
 *  are left out. `record_path` may be NULL. */
bool view_create(const struct view_request *request, const char *record_path, struct view *view);
/** Ends the recording; a zeroed struct is fine. False if the recording could not be written. */
bool view_destroy(struct view *view);

/**
 * Records and submits one frame into slot frame_index % VIEW_FRAMES_IN_FLIGHT, once the earlier
 * frame there is over. `time_stamp` is in microseconds.
 */
bool view_draw(struct view *view, const struct camera *camera, uint64_t time_stamp,
               struct view_frame *frame);

/** Waits for the frame in a slot; then its pixels and counts can be read. */
bool view_wait(const struct view *view, uint32_t slot);
const uint8_t *view_pixels(const struct view *view, uint32_t slot);
struct GalleryCounts view_counts(const struct view *view, uint32_t slot);
/** Of a frame that was waited for. */
double view_gpu_seconds(const struct view *view, uint32_t slot);

/** Waits for every load under way, so that the next frame has all that was asked for. */
bool view_settle(struct view *view);

/** Of all textures: what everything resident would need. */
uint64_t view_tile_count(const struct view *view);

#endif /* SAMPLES_STREAMING_VIEW_H */
