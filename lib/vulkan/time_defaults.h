/** Times of the create-info, in the unit of the time stamps, with defaults in seconds. */
#ifndef SLC_VULKAN_TIME_DEFAULTS_H
#define SLC_VULKAN_TIME_DEFAULTS_H

#include <sluice/vulkan.h>

#define SLC_MAX_TIME_STAMPS_PER_SECOND 1000000000000ull
#define SLC_DEFAULT_STANDBY_TILES 1024u

/** Returns ceil(milliseconds * ticksPerSecond / 1000), at least 1. `milliseconds`: at most 10^6. */
uint64_t slc_time_stamps(const SluiceVulkanStreamerCreateInfo *info, uint64_t milliseconds);

/**
 * Fills in ticksPerSecond first, then every time that is 0, and numExtraStandbyTiles.
 * newestFeedbackMapOnly and noStandbyTiles set the feedback timeout and numExtraStandbyTiles to 0.
 * Errors, logged: INVALID_ARGUMENT.
 */
SluiceResult slc_fill_in_times(SluiceVulkanStreamerCreateInfo *info, const SluiceLogCallback *log);

/** Detects callers who count frames although time stamps are nanoseconds. */
struct slc_time_check {
    bool on; ///< ticksPerSecond has its default
    uint64_t first;
    uint32_t frame_count;
};

/** Logs one warning if 256 frames took less than 256 us by their time stamps. Call once per frame.
 */
void slc_time_check_frame(struct slc_time_check *check, const SluiceLogCallback *log,
                          uint64_t time_stamp);

#endif /* SLC_VULKAN_TIME_DEFAULTS_H */
