#include "vulkan/fake_objects.h"

#include "support/test.h"
#include "vulkan/fake_functions.h"

#include <stdlib.h>

VkResult fake_next_call(struct fake_vulkan *fake)
{
    uint64_t call = ++fake->calls, failing = fake->failing_call;
    bool fails = call == failing || (fake->fails_on && failing > 0 && call > failing);
    return fails ? fake->failure : VK_SUCCESS;
}

void *fake_make(struct fake_vulkan *fake, uint64_t size)
{
    struct fake_object *object = calloc(1, sizeof *object);
    assert_non_null(object);
    object->size = size;
    fake->live_objects++;
    return object;
}

void *fake_make_shown(struct fake_vulkan *fake, uint64_t size)
{
    struct fake_object *object = fake_make(fake, size);
    object->needs_name = true;
    fake->unnamed_objects++;
    return object;
}

void fake_drop(struct fake_vulkan *fake, void *object)
{
    if (object) {
        const struct fake_object *o = object;
        fake->live_objects--;
        fake->unnamed_objects -= o->needs_name && !o->has_name;
    }
    free(object);
}

static VKAPI_ATTR VkResult VKAPI_CALL set_name(VkDevice device,
                                               const VkDebugUtilsObjectNameInfoEXT *info)
{
    struct fake_object *object = (struct fake_object *)info->objectHandle;
    struct fake_vulkan *fake = fake_of(device);
    assert_memory_equal(info->pObjectName, "sluice: ", 8);
    if (object->needs_name && !object->has_name) {
        fake->unnamed_objects--;
        fake->named_count++;
    }
    object->has_name = true;
    return VK_SUCCESS;
}

/* Pairs of functions that make and drop objects of which nothing is asked. */
#define PLAIN_OBJECT(name, info_type)                                                              \
    static VKAPI_ATTR VkResult VKAPI_CALL create_##name(                                           \
        VkDevice device, const info_type *info, const VkAllocationCallbacks *cb, Vk##name *out)    \
    {                                                                                              \
        (void)info;                                                                                \
        (void)cb;                                                                                  \
        FAKE_MAY_FAIL(device);                                                                     \
        *out = fake_make(fake_of(device), 0);                                                      \
        return VK_SUCCESS;                                                                         \
    }                                                                                              \
    static VKAPI_ATTR void VKAPI_CALL destroy_##name(VkDevice device, Vk##name object,             \
                                                     const VkAllocationCallbacks *cb)              \
    {                                                                                              \
        (void)cb;                                                                                  \
        fake_drop(fake_of(device), object);                                                        \
    }

PLAIN_OBJECT(Sampler, VkSamplerCreateInfo)

static VKAPI_ATTR VkResult VKAPI_CALL note_sampler(VkDevice device, const VkSamplerCreateInfo *info,
                                                   const VkAllocationCallbacks *cb, VkSampler *out)
{
    struct fake_vulkan *fake = fake_of(device);
    fake->newest_sampler = *info;
    fake->newest_sampler.pNext = NULL;
    fake->sampler_count++;
    return create_Sampler(device, info, cb, out);
}

PLAIN_OBJECT(PipelineCache, VkPipelineCacheCreateInfo)
PLAIN_OBJECT(PipelineLayout, VkPipelineLayoutCreateInfo)
PLAIN_OBJECT(ShaderModule, VkShaderModuleCreateInfo)

const struct fake_function fake_object_functions[] = {
    FAKE_FUNCTION(CreatePipelineCache, create_PipelineCache),
    FAKE_FUNCTION(CreatePipelineLayout, create_PipelineLayout),
    FAKE_FUNCTION(CreateSampler, note_sampler),
    FAKE_FUNCTION(CreateShaderModule, create_ShaderModule),
    FAKE_FUNCTION(DestroyPipelineCache, destroy_PipelineCache),
    FAKE_FUNCTION(DestroyPipelineLayout, destroy_PipelineLayout),
    FAKE_FUNCTION(DestroySampler, destroy_Sampler),
    FAKE_FUNCTION(DestroyShaderModule, destroy_ShaderModule),
    FAKE_FUNCTION(SetDebugUtilsObjectNameEXT, set_name),
    {NULL, NULL},
};
