/** Descriptor sets of a stage's shaders: materials, and marks of tiles for each frame in flight. */
#ifndef SLUICE_VIEW_STAGE_SETS_H
#define SLUICE_VIEW_STAGE_SETS_H

#include "frames.h"
#include "scene_data.h"

struct stage_sets {
    const struct gpu *gpu; ///< borrowed
    struct gpu_buffer materials;
    struct gpu_buffer marks[FRAMES_SLOTS]; ///< words of tile_marks.h
    VkDescriptorSetLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet sets[FRAMES_SLOTS];
};

/** Creates the sets. `table_indices`: index of each image in the texture table. `mark_size`: bytes.
 *  False, with a line on stderr, on failure. */
bool stage_sets_create(const struct gpu *gpu, const struct scene_data *scene,
                       const uint32_t *table_indices, size_t mark_size, struct stage_sets *sets);
/** Destroys the sets. No frame may be in flight. A zeroed struct is allowed. */
void stage_sets_destroy(struct stage_sets *sets);

#endif /* SLUICE_VIEW_STAGE_SETS_H */
