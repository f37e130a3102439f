/** Whether the reads of a texture succeed, and what was said about it. */
#ifndef SLC_VULKAN_READ_HEALTH_H
#define SLC_VULKAN_READ_HEALTH_H

#include <stdbool.h>
#include <stdint.h>

enum slc_read_health {
    SLC_READS_WELL = 0,
    SLC_READS_FAIL,    ///< they are tried again soon
    SLC_READS_GIVEN_UP ///< they are tried again much later
};

/** Of a texture; of all layers of an array together. */
struct slc_read_trouble {
    enum slc_read_health health, said; ///< `said`: what the last message was about
    uint32_t texture, tile;            ///< whose read failed last: it will show a recovery
    uint64_t failed_count;             ///< reads since it was well
    uint64_t time;                     ///< of the last message
    bool has_spoken;
};

#endif /* SLC_VULKAN_READ_HEALTH_H */
