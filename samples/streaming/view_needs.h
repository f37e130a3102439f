/** Counts the required tiles of a view's frames, and the reads from its sources. */
#ifndef SAMPLES_STREAMING_VIEW_NEEDS_H
#define SAMPLES_STREAMING_VIEW_NEEDS_H

#include "view.h"

/** Creates the counting pass if the view's request has `needs`. Called by view_create. */
bool view_needs_create(struct view *view);

/** Allocates sets from the view's pool. */
bool view_allocate_sets(const struct view *view, VkDescriptorSetLayout layout, uint32_t count,
                        VkDescriptorSet *sets);

/** Prepares to count the required tiles of the view's frames. */
bool view_needs_begin(const struct view *view, struct needs *needs);
/** Adds a frame that has finished. Requires request.needs. Add frames in order. */
bool view_needs(struct view *view, uint32_t slot, struct needs *needs, struct needs_frame *frame);

/** Textures by what was read from their sources. */
struct view_reads {
    uint32_t never;  ///< textures without any read
    uint32_t packed; ///< textures of which only packed levels were read; these are always loaded
};

struct view_reads view_reads(const struct view *view);

#endif /* SAMPLES_STREAMING_VIEW_NEEDS_H */
