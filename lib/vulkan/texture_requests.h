/**
 * Requests of the application. They reach the manager as feedback: each map of a texture is given
 * together with what is requested of it (decision 100).
 */
#ifndef SLC_VULKAN_TEXTURE_REQUESTS_H
#define SLC_VULKAN_TEXTURE_REQUESTS_H

#include "vulkan/streamer.h"
#include "vulkan/texture_rect.h"

#define SLC_MAX_TEXTURE_REQUESTS (1u << 20)

/** One that is not over, or the place of one. */
struct slc_texture_request {
    bool live;
    uint8_t level;       ///< at most the last one of its texture
    uint32_t generation; ///< of the last one that had the place; counts from 1
    uint32_t texture;
    uint32_t next; ///< place + 1 of another one of the texture, or of a free place; 0: none
    uint64_t until;
    struct slc_tile_rect regions, tiles; ///< of level 0
};

/** Frees memory. */
void slc_texture_requests_finish(struct slc_texture_requests *requests,
                                 const SluiceAllocationCallbacks *cb);

/** Ends what is over at the time of the frame that begins. */
void slc_texture_requests_expire(SluiceVulkanStreamer *s);
/** Ends all of a texture, which goes. */
void slc_texture_requests_drop(SluiceVulkanStreamer *s, struct slc_texture *texture);
/** Makes a map as fine as the requests of its texture. */
void slc_texture_requests_merge(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                                uint8_t *map);

#endif /* SLC_VULKAN_TEXTURE_REQUESTS_H */
