/** Health of a texture's reads, and the state of messages about them. */
#ifndef SLC_VULKAN_READ_HEALTH_H
#define SLC_VULKAN_READ_HEALTH_H

#include <stdbool.h>
#include <stdint.h>

enum slc_read_health {
    SLC_READS_WELL = 0,
    SLC_READS_FAIL,    ///< failed reads are tried again soon
    SLC_READS_GIVEN_UP ///< failed reads are tried again much later
};

/** Read failures of a texture. All layers of an array share one. */
struct slc_read_trouble {
    enum slc_read_health health, said; ///< `said`: health in the last message
    uint32_t texture, tile;            ///< tile whose read failed last; its success is a recovery
    uint64_t failed_count;             ///< failed reads since `health` was SLC_READS_WELL
    uint64_t time;                     ///< time of the last message
    bool has_spoken;
};

#endif /* SLC_VULKAN_READ_HEALTH_H */
