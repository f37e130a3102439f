/** Four textures on a fake device, for tests of texture state and control. */
#ifndef TESTS_VULKAN_CONTROL_STAGE_H
#define TESTS_VULKAN_CONTROL_STAGE_H

#include "vulkan/fake_vulkan.h"

#include "support/failing_allocator.h"
#include "support/fault_source.h"
#include "support/test.h"

#include <sluice/vulkan_control.h>

enum { TEXTURES = 4, SIZE = 1024, TILES = SIZE / 128, TAIL = 3 };

struct stage {
    struct fake_vulkan fake;
    struct failing_allocator memory;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *source;
    struct fault_source faults; ///< source of the textures; wraps `source`
    SluiceVulkanTexture textures[TEXTURES];
    uint64_t time;
    uint8_t seen[TEXTURES][TILES * TILES]; ///< levels that shaders mark
    char last[256];                        ///< last message
};

/** Job system of the next stages. NULL: threads of the context. */
extern const SluiceJobSystem *stage_job_system;

/** Creates the only stage. Sets structSize, maxTextureCount and maxRegionCount of the settings. */
struct stage *stage_init(const SluiceVulkanStreamerCreateInfo *settings);
void stage_finish(struct stage *s);
/** Runs frames. Each begins after the previous one's binds and reads are complete. */
void frames(struct stage *s, uint32_t count);

void set_control(struct stage *s, uint32_t texture, SluiceVulkanTextureControl control);
SluiceVulkanStreamerStatistics statistics(const struct stage *s);

/** Tests in control_explain.c. */
void each_step_of_a_load_is_told(void **state);
void what_the_application_decides_is_told(void **state);
void what_nobody_sees_is_told(void **state);
void memory_that_is_short_is_told(void **state);
void failed_loads_are_told(void **state);
void fades_are_told(void **state);
void followers_are_explained_by_their_primary(void **state);
void feedback_is_written_as_shaders_marked_it(void **state);
void stages_of_loads_are_counted_in_frames(void **state);
void explanations_agree_with_the_state_of_each_tile(void **state);

#endif /* TESTS_VULKAN_CONTROL_STAGE_H */
