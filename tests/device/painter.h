/** Draws the picture of shaders/picture.frag into a prober's outputs: one per pixel. */
#ifndef TESTS_DEVICE_PAINTER_H
#define TESTS_DEVICE_PAINTER_H

#include "device/probe.h"

struct painter {
    struct prober *prober;
    struct probe_texture texture;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipeline pipeline; ///< the harness's
    uint32_t frame;      ///< counts; the seed and the phase of the lattice
    bool lattice;
    uint32_t layer; ///< PAINTER_LAYER: that is drawn
};

/** Source of the feedback's level. */
enum painter_feedback {
    PAINTER_COMPUTE,    ///< the formula
    PAINTER_QUERY,      ///< textureQueryLod before all else
    PAINTER_QUERY_LATE, ///< textureQueryLod behind branches
    PAINTER_LAYER,      ///< the formula; the picture is of shaders/array.frag, see prober_layer
};

void painter_init(struct painter *p, struct prober *prober, struct probe_texture texture);
void painter_init_as(struct painter *p, struct prober *prober, struct probe_texture texture,
                     enum painter_feedback feedback);
void painter_finish(struct painter *p);

/** For harness_frame; user is the painter. */
void painter_record(void *user, VkCommandBuffer commands);

#endif /* TESTS_DEVICE_PAINTER_H */
