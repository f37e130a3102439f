/** The manager of a streamer, as an expression. */
#ifndef TESTS_SUPPORT_STREAMER_MANAGER_H
#define TESTS_SUPPORT_STREAMER_MANAGER_H

#include "support/test.h"

#include <sluice/vulkan.h>

static inline SluiceStreamedTextureManager *manager_of(SluiceVulkanStreamer *streamer)
{
    SluiceStreamedTextureManager *manager = NULL;
    CHECK_OK(sluiceGetVulkanStreamerManager(streamer, &manager));
    assert_non_null(manager);
    return manager;
}

#endif /* TESTS_SUPPORT_STREAMER_MANAGER_H */
