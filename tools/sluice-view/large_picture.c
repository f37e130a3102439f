#include "large_picture.h"

#include "../../samples/common/png_file.h"
#include "../common/text.h"

#include <stdio.h>

void large_picture_drop(const struct gpu *gpu, struct large_picture *large)
{
    target_destroy(gpu, &large->target);
    gpu_destroy_buffer(gpu, &large->pixels);
    *large = (struct large_picture){.path = ""};
}

bool large_picture_begin(const struct gpu *gpu, uint32_t width, uint32_t height, const char *path,
                         struct large_picture *large)
{
    const uint32_t most = gpu->properties.limits.maxImageDimension2D;
    *large = (struct large_picture){.path = ""};
    if (width > most || height > most) {
        text_say("sluice-view: the device has no images of %u x %u; %u can be", width, height,
                 most);
        return false;
    }
    if (!target_create_encoding(gpu, width, height, &large->target) ||
        !gpu_create_buffer(gpu, (VkDeviceSize)width * height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           &large->pixels)) {
        large_picture_drop(gpu, large);
        return false;
    }
    snprintf(large->path, sizeof large->path, "%s", path);
    return true;
}

bool large_picture_end(struct frames *frames, struct large_picture *large)
{
    const bool written =
        frames_wait(frames) && png_file_write(large->path, large->pixels.mapped,
                                              large->target.width, large->target.height);
    large_picture_drop(frames->gpu, large);
    return written;
}
