/** What a view's frames need, and what was read for them. */
#ifndef SAMPLES_STREAMING_VIEW_NEEDS_H
#define SAMPLES_STREAMING_VIEW_NEEDS_H

#include "view.h"

/** The pass that finds it out, if the view's request has it; for view_create. */
bool view_needs_create(struct view *view);

/** Of the view's pool. */
bool view_allocate_sets(const struct view *view, VkDescriptorSetLayout layout, uint32_t count,
                        VkDescriptorSet *sets);

/** Prepares to follow what the view's frames need. */
bool view_needs_begin(const struct view *view, struct needs *needs);
/** What a frame that was waited for needed, where the view finds it out. Frames in order. */
bool view_needs(struct view *view, uint32_t slot, struct needs *needs, struct needs_frame *frame);

/** What was read of the textures' sources. */
struct view_reads {
    uint32_t never;  ///< textures: nothing
    uint32_t packed; ///< textures: nothing but packed levels, which are loaded whatever is sampled
};

struct view_reads view_reads(const struct view *view);

#endif /* SAMPLES_STREAMING_VIEW_NEEDS_H */
