/**
 * Times a streamer's calls to the driver. Pass driver_calls_get to it instead of
 * vkGetInstanceProcAddr. One device at a time, and calls from one thread.
 */
#ifndef BENCH_VULKAN_DRIVER_CALLS_H
#define BENCH_VULKAN_DRIVER_CALLS_H

#include <vulkan/vulkan.h>

#include <stdint.h>

struct driver_calls {
    uint64_t count, ns;
};

/** Unknown functions that commands or queues may be used with are refused, so that none is missed.
 */
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL driver_calls_get(VkInstance instance, const char *name);

/** Since the last time. */
struct driver_calls driver_calls_take(void);

/** Nanoseconds of a call that are not part of the timed part: reading the clock, and the detour. */
double driver_calls_overhead(void);

#endif /* BENCH_VULKAN_DRIVER_CALLS_H */
