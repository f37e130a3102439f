#include "support/test.h"
#include "vulkan/fake_functions.h"
#include "vulkan/fake_objects.h"

static VKAPI_ATTR VkResult VKAPI_CALL
create_DescriptorSetLayout(VkDevice device, const VkDescriptorSetLayoutCreateInfo *info,
                           const VkAllocationCallbacks *cb, VkDescriptorSetLayout *layout)
{
    (void)cb;
    FAKE_MAY_FAIL(device);
    struct fake_object *object = fake_make(fake_of(device), 0);
    object->first_image = UINT32_MAX;
    for (uint32_t i = info->bindingCount; i-- > 0;)
        if (info->pBindings[i].descriptorType != VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)
            object->first_image = info->pBindings[i].binding;
    *layout = (VkDescriptorSetLayout)object;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_DescriptorSetLayout(VkDevice device,
                                                              VkDescriptorSetLayout layout,
                                                              const VkAllocationCallbacks *cb)
{
    (void)cb;
    fake_drop(fake_of(device), layout);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_DescriptorPool(VkDevice device,
                                                            const VkDescriptorPoolCreateInfo *info,
                                                            const VkAllocationCallbacks *cb,
                                                            VkDescriptorPool *pool)
{
    (void)info, (void)cb;
    FAKE_MAY_FAIL(device);
    *pool = fake_make(fake_of(device), 0);
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_DescriptorPool(VkDevice device, VkDescriptorPool pool,
                                                         const VkAllocationCallbacks *cb)
{
    (void)cb;
    struct fake_vulkan *fake = fake_of(device);
    for (uint32_t i = 0; i < FAKE_SETS; i++) {
        if (!pool || fake->sets[i].pool != pool)
            continue;
        fake->sets[i].pool = VK_NULL_HANDLE;
        fake->set_count--;
    }
    fake_drop(fake, pool);
}

static void update_set(const VkWriteDescriptorSet *write)
{
    struct fake_set *set = (struct fake_set *)write->dstSet;
    set->write_count++;
    for (uint32_t i = 0; i < write->descriptorCount; i++) {
        if (write->descriptorType == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)
            set->buffers[write->dstBinding + i] = write->pBufferInfo[i].buffer;
        else if (write->dstArrayElement + i < FAKE_SET_IMAGES)
            set->images[write->dstBinding - set->first_image][write->dstArrayElement + i] =
                write->pImageInfo[i];
    }
}

static VKAPI_ATTR void VKAPI_CALL update_sets(VkDevice device, uint32_t write_count,
                                              const VkWriteDescriptorSet *writes,
                                              uint32_t copy_count,
                                              const VkCopyDescriptorSet *copies)
{
    (void)copy_count, (void)copies;
    if ((void *)writes[0].dstSet != fake_of(device)) {
        for (uint32_t i = 0; i < write_count; i++)
            update_set(&writes[i]);
        return;
    }
    if (fake_of(device)->no_resolve)
        return;
    fake_of(device)->table = FAKE_OBJECT(writes[0].pBufferInfo[2].buffer);
    fake_of(device)->readback = FAKE_OBJECT(writes[0].pBufferInfo[4].buffer);
}

static VKAPI_ATTR VkResult VKAPI_CALL allocate_sets(VkDevice device,
                                                    const VkDescriptorSetAllocateInfo *info,
                                                    VkDescriptorSet *sets)
{
    FAKE_MAY_FAIL(device);
    struct fake_vulkan *fake = fake_of(device);
    for (uint32_t i = 0; i < info->descriptorSetCount; i++)
        sets[i] = (VkDescriptorSet)fake; /* sets of passes are never examined */
    if (FAKE_OBJECT(info->pSetLayouts[0])->first_image == UINT32_MAX)
        return VK_SUCCESS;
    assert_in_range(fake->set_count, 0, FAKE_SETS - 1);
    struct fake_set *set = fake->sets;
    while (set->pool)
        set++;
    *set = (struct fake_set){.pool = info->descriptorPool,
                             .first_image = FAKE_OBJECT(info->pSetLayouts[0])->first_image};
    fake->set_count++;
    sets[0] = (VkDescriptorSet)set;
    return VK_SUCCESS;
}

const struct fake_function fake_descriptor_functions[] = {
    FAKE_FUNCTION(AllocateDescriptorSets, allocate_sets),
    FAKE_FUNCTION(CreateDescriptorPool, create_DescriptorPool),
    FAKE_FUNCTION(CreateDescriptorSetLayout, create_DescriptorSetLayout),
    FAKE_FUNCTION(DestroyDescriptorPool, destroy_DescriptorPool),
    FAKE_FUNCTION(DestroyDescriptorSetLayout, destroy_DescriptorSetLayout),
    FAKE_FUNCTION(UpdateDescriptorSets, update_sets),
    {NULL, NULL},
};
