/** A buffer with memory of its own. */
#ifndef SLC_VULKAN_BUFFER_H
#define SLC_VULKAN_BUFFER_H

#include "vulkan/caps.h"
#include "vulkan/memory.h"

enum slc_buffer_kind {
    SLC_BUFFER_DEVICE,   ///< device-local
    SLC_BUFFER_UPLOAD,   ///< written by the host, mapped, coherent
    SLC_BUFFER_STAGING,  ///< like UPLOAD; device-local if the host can map all device memory
    SLC_BUFFER_TABLE,    ///< small, written by the host, mapped, coherent; device-local if possible
    SLC_BUFFER_READBACK, ///< read by the host, mapped; cached if there is such memory
};

struct slc_buffer {
    VkBuffer buffer;
    struct slc_memory memory;
    uint64_t size;
    void *mapped;            ///< NULL for DEVICE
    VkDeviceAddress address; ///< 0: no address
};

/** True if the host reads STAGING buffers slowly: they are device-local, and not cached. */
bool slc_staging_is_uncached(const struct slc_caps *caps);

/** Creates a buffer. Storage buffers of kind DEVICE have an address if vk->GetBufferDeviceAddress
 * is set. Finishing a zeroed buffer does nothing. Errors: OUT_OF_DEVICE_MEMORY, VULKAN, ... */
SluiceResult slc_buffer_init(struct slc_buffer *buffer, const struct slc_vk *vk,
                             const struct slc_caps *caps, uint64_t size, VkBufferUsageFlags usage,
                             enum slc_buffer_kind kind);
/** Names a buffer for debuggers. Default: a name by its kind. */
void slc_buffer_set_name(const struct slc_buffer *buffer, const struct slc_vk *vk,
                         const char *name);
void slc_buffer_finish(struct slc_buffer *buffer, const struct slc_vk *vk);

#endif /* SLC_VULKAN_BUFFER_H */
