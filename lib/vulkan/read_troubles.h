/**
 * Says once that a source cannot be read, and once that it can be read again. Everything between is
 * counted in the statistics: a file with 182 damaged tiles is two lines, not hundreds.
 */
#ifndef SLC_VULKAN_READ_TROUBLES_H
#define SLC_VULKAN_READ_TROUBLES_H

#include <sluice/vulkan.h>

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

/** A read of the texture failed, and the manager was told. `tile` is one of those that it was for.
 */
void slc_read_trouble_failed(SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile,
                             SluiceResult result);
/** A read of the texture delivered `tile`. After a recovery other layers are tried again. */
void slc_read_trouble_delivered(SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile);

#endif /* SLC_VULKAN_READ_TROUBLES_H */
