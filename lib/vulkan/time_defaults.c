#include "vulkan/time_defaults.h"

#include "base/log.h"

#define CHECKED_FRAMES 256u
#define SHORTEST_FRAME 1000u /* ns */

uint64_t slc_time_stamps(const SluiceVulkanStreamerCreateInfo *info, uint64_t milliseconds)
{
    uint64_t product = milliseconds * info->ticksPerSecond; /* at most 10^18 */
    return product / 1000 + (product % 1000 != 0);
}

static void set_default(uint64_t *value, uint64_t otherwise)
{
    if (*value == 0)
        *value = otherwise;
}

SluiceResult slc_fill_in_times(SluiceVulkanStreamerCreateInfo *info, const SluiceLogCallback *log)
{
    if (info->ticksPerSecond > SLC_MAX_TIME_STAMPS_PER_SECOND)
        return slc_log_refusal(log, "ticksPerSecond is %llu; it must be at most 10^12",
                               (unsigned long long)info->ticksPerSecond);
    if (info->newestFeedbackMapOnly && info->feedbackTimeoutTicks)
        return slc_log_refusal(log,
                               "feedbackTimeoutTicks is %llu; with newestFeedbackMapOnly it must "
                               "be 0",
                               (unsigned long long)info->feedbackTimeoutTicks);
    if (info->noStandbyTiles && info->numExtraStandbyTiles)
        return slc_log_refusal(log, "numExtraStandbyTiles is %u; with noStandbyTiles it must be 0",
                               info->numExtraStandbyTiles);
    set_default(&info->ticksPerSecond, 1000000000);
    if (!info->newestFeedbackMapOnly)
        set_default(&info->feedbackTimeoutTicks, slc_time_stamps(info, 1000));
    set_default(&info->retryDelayTicks, slc_time_stamps(info, 250));
    set_default(&info->givenUpRetryDelayTicks, slc_time_stamps(info, 30000));
    if (!info->noStandbyTiles && info->numExtraStandbyTiles == 0)
        info->numExtraStandbyTiles = SLC_DEFAULT_STANDBY_TILES;
    return SLUICE_SUCCESS;
}

void slc_time_check_frame(struct slc_time_check *check, const SluiceLogCallback *log,
                          uint64_t time_stamp)
{
    if (!check->on)
        return;
    if (check->frame_count++ == 0)
        check->first = time_stamp;
    if (check->frame_count <= CHECKED_FRAMES)
        return;
    check->on = false;
    uint64_t passed = time_stamp - check->first;
    if (passed < CHECKED_FRAMES * SHORTEST_FRAME)
        slc_log(log, SLUICE_LOG_WARNING,
                "%u frames took %llu ns by their time stamps: set ticksPerSecond, or give time "
                "stamps in nanoseconds",
                CHECKED_FRAMES, (unsigned long long)passed);
}
