/** Draws the picture of shaders/picture.frag into a prober's outputs: one per pixel. */
#ifndef TESTS_DEVICE_PAINTER_H
#define TESTS_DEVICE_PAINTER_H

#include "device/probe.h"

struct painter {
    struct prober *prober;
    struct probe_texture texture;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipeline pipeline;
    uint32_t frame; ///< counts; the seed and the phase of the lattice
    bool lattice;
};

void painter_init(struct painter *p, struct prober *prober, struct probe_texture texture);
/** The same, but the feedback is what textureQueryLod says. */
void painter_init_query(struct painter *p, struct prober *prober, struct probe_texture texture);
void painter_finish(struct painter *p);

/** For harness_frame; user is the painter. */
void painter_record(void *user, VkCommandBuffer commands);

#endif /* TESTS_DEVICE_PAINTER_H */
