/**
 * Requests tiles before they are needed. Draws feedback from the camera's future position
 * (camera_motion.h), at a small size, with its own depth test, in the same frame as the picture.
 * The feedback goes to the same buffers as that of the picture.
 */
#ifndef SAMPLES_STREAMING_PREDICT_H
#define SAMPLES_STREAMING_PREDICT_H

#include "renderer.h"

#define PREDICT_SLOTS 3   ///< frames in flight
#define PREDICT_SHRINKS 4 ///< factor by which the feedback is narrower and lower than the picture

struct predict_slot {
    struct gpu_buffer frame;
    VkDescriptorSet set;
};

struct predict {
    const struct renderer *renderer; ///< borrowed
    struct target target;
    VkPipeline streamed,
        hiding; ///< pipelines for surfaces with textures, and for those that only occlude
    VkDescriptorPool pool;
    struct predict_slot slots[PREDICT_SLOTS];
};

/** `picture`: target of the frames. Reports errors on stderr. */
bool predict_create(const struct renderer *renderer, const struct target *picture,
                    struct predict *predict);
/** A zeroed struct is allowed. */
void predict_destroy(struct predict *predict);

/**
 * Records the pass. Call outside a render pass, between the begin and the end of a streaming frame,
 * whose set is `streamer_set`. `frame`: that of the picture, with `eye` and `viewProjection` of the
 * future camera. `surfaces`: as for renderer_draw.
 */
void predict_record(const struct predict *predict, VkCommandBuffer commands,
                    VkDescriptorSet streamer_set, uint32_t slot, const struct GalleryFrame *frame,
                    const struct renderer_surface *surfaces);

#endif /* SAMPLES_STREAMING_PREDICT_H */
