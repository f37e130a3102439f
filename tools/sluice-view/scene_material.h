/** Materials of a scene: factors, and five slots for images. */
#ifndef SLUICE_VIEW_SCENE_MATERIAL_H
#define SLUICE_VIEW_SCENE_MATERIAL_H

#include <stdbool.h>
#include <stdint.h>

#define SCENE_NO_IMAGE UINT32_MAX

/** Slots of a material. shaders/scene_material.glsl has the same order. */
enum scene_slot_kind {
    SLOT_COLOR,
    SLOT_ROUGHNESS, ///< green: roughness, blue: metalness
    SLOT_NORMAL,
    SLOT_OCCLUSION, ///< red
    SLOT_EMISSIVE,
    SLOT_COUNT
};

enum scene_alpha { ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND };

/** An image of the scene, sampled at (m[0] u + m[1] v + m[4], m[2] u + m[3] v + m[5]) for a
 * vertex's (u, v). */
struct scene_slot {
    uint32_t image;  ///< SCENE_NO_IMAGE: none
    uint32_t uv_set; ///< 0 or 1
    float m[6];
};

struct scene_material {
    float color[4], emissive[3];
    float metalness, roughness, normal_scale, occlusion, cutoff;
    int alpha; ///< enum scene_alpha
    bool double_sided;
    bool missing; ///< the color image is missing; a checkerboard is shown
    struct scene_slot slots[SLOT_COUNT];
};

/** Initializes a material: white, rough, without images. */
void scene_material_init(struct scene_material *material);

#endif /* SLUICE_VIEW_SCENE_MATERIAL_H */
