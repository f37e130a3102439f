/** Counts the frames that tiles spend in each stage, from a shader's mark to the picture. */
#ifndef SLC_VULKAN_LOAD_STAGES_H
#define SLC_VULKAN_LOAD_STAGES_H

#include "vulkan/streamer.h"

/** Notes the requests so far when a frame begins. */
void slc_load_stages_begin(SluiceVulkanStreamer *s);
/** Counts a tile that leaves a stage, which it entered in frame `since`. */
void slc_load_stage_left(SluiceVulkanStreamer *s, SluiceLoadStage stage, uint64_t since);
/** Counts a tile that the manager has just handed out. */
void slc_load_stage_handed_out(SluiceVulkanStreamer *s, const SluiceTile *tile);
/** Begins the count of a unit for a tile that the manager has handed out. */
void slc_load_stage_taken(SluiceVulkanStreamer *s, struct slc_unit *unit, const SluiceTile *tile);
/** Counts a unit that goes from a stage to the next one. Units of producers are not counted. */
void slc_load_stage_unit(SluiceVulkanStreamer *s, struct slc_unit *unit, SluiceLoadStage stage);

#endif /* SLC_VULKAN_LOAD_STAGES_H */
