/** Debug info of streamers that have every tile resident: the truth that others are compared with.
 */
#ifndef TESTS_SUPPORT_MAP_EVERYTHING_H
#define TESTS_SUPPORT_MAP_EVERYTHING_H

#include <sluice/vulkan.h>

static const SluiceVulkanStreamerDebugInfo map_everything = {
    .structSize = sizeof(SluiceVulkanStreamerDebugInfo), .mapEverything = true};

#endif /* TESTS_SUPPORT_MAP_EVERYTHING_H */
