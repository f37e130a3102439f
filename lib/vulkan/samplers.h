/** Samplers for streamed textures: one per kind in use. */
#ifndef SLC_VULKAN_SAMPLERS_H
#define SLC_VULKAN_SAMPLERS_H

#include "vulkan/dispatch.h"

struct slc_sampler_kind {
    VkSamplerAddressMode modes[2];
    float max_anisotropy; ///< 1: none
    bool nearest;         ///< NEAREST between texels and levels, for formats without linear filters
    bool integer;         ///< border colors are integers
};

struct slc_sampler {
    struct slc_sampler_kind kind;
    VkSampler sampler;
};

/** Samplers made so far. Zeroed: none. */
struct slc_samplers {
    struct slc_sampler *list; ///< owned, [count]
    uint32_t count, capacity;
};

/** Finds or makes a sampler. Its `*index` never changes. Errors: OUT_OF_HOST_MEMORY,
 *  OUT_OF_DEVICE_MEMORY, VULKAN. */
SluiceResult slc_samplers_get(struct slc_samplers *samplers, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb,
                              const struct slc_sampler_kind *kind, uint32_t *index);
void slc_samplers_finish(struct slc_samplers *samplers, const struct slc_vk *vk,
                         const SluiceAllocationCallbacks *cb);

#endif /* SLC_VULKAN_SAMPLERS_H */
