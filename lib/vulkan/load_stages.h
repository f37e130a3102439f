/** How many frames tiles spend in each stage of their way from a shader's mark to the picture. */
#ifndef SLC_VULKAN_LOAD_STAGES_H
#define SLC_VULKAN_LOAD_STAGES_H

#include "vulkan/streamer.h"

/** A frame begins. */
void slc_load_stages_begin(SluiceVulkanStreamer *s);
/** Something left a stage that it had entered in frame `since`. */
void slc_load_stage_left(SluiceVulkanStreamer *s, SluiceLoadStage stage, uint64_t since);
/** The manager has just handed the tile out. */
void slc_load_stage_handed_out(SluiceVulkanStreamer *s, const SluiceTile *tile);
/** A unit takes up a tile that the manager has handed out. */
void slc_load_stage_taken(SluiceVulkanStreamer *s, struct slc_unit *unit, const SluiceTile *tile);
/** A unit left a stage, and enters the next one. Units of producers are not counted. */
void slc_load_stage_unit(SluiceVulkanStreamer *s, struct slc_unit *unit, SluiceLoadStage stage);

#endif /* SLC_VULKAN_LOAD_STAGES_H */
