/**
 * Requests of the application. They reach the manager as feedback: requested levels are merged into
 * each map of their texture (decision 100).
 */
#ifndef SLC_VULKAN_TEXTURE_REQUESTS_H
#define SLC_VULKAN_TEXTURE_REQUESTS_H

#include "vulkan/streamer.h"
#include "vulkan/texture_rect.h"

#define SLC_MAX_TEXTURE_REQUESTS (1u << 20)

/** Request, or free element of the list. */
struct slc_texture_request {
    bool live;           ///< false: free element
    uint8_t level;       ///< at most the last level of the texture
    uint32_t generation; ///< generation of the last request of this element; counts from 1
    uint32_t texture;
    uint32_t next; ///< 1 + index of the texture's next request, or of a free element; 0: none
    uint64_t until;
    struct slc_tile_rect regions, tiles; ///< regions and tiles of level 0
};

/** Frees memory. */
void slc_texture_requests_finish(struct slc_texture_requests *requests,
                                 const SluiceAllocationCallbacks *cb);

/** Ends requests that have expired when a frame begins. */
void slc_texture_requests_expire(SluiceVulkanStreamer *s);
/** Ends all requests of a texture that is removed. */
void slc_texture_requests_drop(SluiceVulkanStreamer *s, struct slc_texture *texture);
/** Merges requests into a map of their texture: each region gets the finer level. */
void slc_texture_requests_merge(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                                uint8_t *map);

#endif /* SLC_VULKAN_TEXTURE_REQUESTS_H */
