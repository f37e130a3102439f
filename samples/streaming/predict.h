/**
 * Asks for tiles before they are needed: draws feedback, and nothing else, from where the camera
 * will be (camera_motion.h), small and with a depth test of its own, in the same frame as the
 * picture. The marks go where those of the picture go; Sluice knows no difference.
 */
#ifndef SAMPLES_STREAMING_PREDICT_H
#define SAMPLES_STREAMING_PREDICT_H

#include "renderer.h"

#define PREDICT_SLOTS 3   ///< frames in flight
#define PREDICT_SHRINKS 4 ///< width and height of the picture are so many times as large

struct predict_slot {
    struct gpu_buffer frame;
    VkDescriptorSet set;
};

struct predict {
    const struct renderer *renderer; ///< borrowed
    struct target target;
    VkPipeline streamed, hiding; ///< surfaces with textures; what only hides them
    VkDescriptorPool pool;
    struct predict_slot slots[PREDICT_SLOTS];
};

/** `picture`: what the frames are drawn to. Says on stderr what is wrong. */
bool predict_create(const struct renderer *renderer, const struct target *picture,
                    struct predict *predict);
/** A zeroed struct is fine. */
void predict_destroy(struct predict *predict);

/**
 * Outside a render pass, between the begin and the end of a streaming frame, whose set is
 * `streamer_set`. `frame` is that of the picture but for the camera, `frame->eye` and
 * `viewProjection` are those of the camera ahead; surfaces as for renderer_draw.
 */
void predict_record(const struct predict *predict, VkCommandBuffer commands,
                    VkDescriptorSet streamer_set, uint32_t slot, const struct GalleryFrame *frame,
                    const struct renderer_surface *surfaces);

#endif /* SAMPLES_STREAMING_PREDICT_H */
