#include "vulkan/samplers.h"

#include "base/alloc.h"

#define FIRST_CAPACITY 4u

/* Requirements of sample.glsl: no LOD bias, every level, the texture's address modes. */
static SluiceResult create(const struct slc_vk *vk, const struct slc_sampler_kind *kind,
                           VkSampler *sampler)
{
    VkFilter filter = kind->nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = filter,
                                .minFilter = filter,
                                .mipmapMode = kind->nearest ? VK_SAMPLER_MIPMAP_MODE_NEAREST
                                                            : VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                .addressModeU = kind->modes[0],
                                .addressModeV = kind->modes[1],
                                .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .anisotropyEnable = kind->max_anisotropy > 1.0f,
                                .maxAnisotropy = kind->max_anisotropy,
                                .maxLod = VK_LOD_CLAMP_NONE,
                                .borderColor = kind->integer
                                                   ? VK_BORDER_COLOR_INT_TRANSPARENT_BLACK
                                                   : VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK};
    return slc_vk_result(vk, vk->CreateSampler(vk->device, &info, NULL, sampler),
                         "vkCreateSampler");
}

static SluiceResult grow(struct slc_samplers *samplers, const SluiceAllocationCallbacks *cb)
{
    uint32_t capacity = samplers->capacity ? 2 * samplers->capacity : FIRST_CAPACITY;
    struct slc_sampler *list =
        slc_regrow(cb, samplers->list, samplers->capacity, capacity, sizeof *list);
    if (!list)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    samplers->list = list;
    samplers->capacity = capacity;
    return SLUICE_SUCCESS;
}

SluiceResult slc_samplers_get(struct slc_samplers *samplers, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb,
                              const struct slc_sampler_kind *kind, uint32_t *index)
{
    for (uint32_t i = 0; i < samplers->count; i++) {
        const struct slc_sampler_kind *known = &samplers->list[i].kind;
        if (known->modes[0] == kind->modes[0] && known->modes[1] == kind->modes[1] &&
            known->max_anisotropy == kind->max_anisotropy && known->nearest == kind->nearest &&
            known->integer == kind->integer) {
            *index = i;
            return SLUICE_SUCCESS;
        }
    }
    SluiceResult result =
        samplers->count < samplers->capacity ? SLUICE_SUCCESS : grow(samplers, cb);
    VkSampler sampler = VK_NULL_HANDLE;
    if (result == SLUICE_SUCCESS)
        result = create(vk, kind, &sampler);
    if (result != SLUICE_SUCCESS)
        return result;
    samplers->list[samplers->count] = (struct slc_sampler){*kind, sampler};
    *index = samplers->count++;
    return SLUICE_SUCCESS;
}

void slc_samplers_finish(struct slc_samplers *samplers, const struct slc_vk *vk,
                         const SluiceAllocationCallbacks *cb)
{
    for (uint32_t i = 0; i < samplers->count; i++)
        vk->DestroySampler(vk->device, samplers->list[i].sampler, NULL);
    slc_free(cb, samplers->list, samplers->capacity, sizeof *samplers->list);
    *samplers = (struct slc_samplers){0};
}
