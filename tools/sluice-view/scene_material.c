#include "scene_material.h"

void scene_material_init(struct scene_material *material)
{
    *material = (struct scene_material){.color = {1, 1, 1, 1},
                                        .roughness = 1,
                                        .normal_scale = 1,
                                        .occlusion = 1,
                                        .cutoff = 0.5f,
                                        .double_sided = true};
    for (int i = 0; i < SLOT_COUNT; i++)
        material->slots[i] = (struct scene_slot){SCENE_NO_IMAGE, 0, {1, 0, 0, 1, 0, 0}};
}
