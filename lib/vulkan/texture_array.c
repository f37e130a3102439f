#include "vulkan/texture_array.h"

#include "base/alloc.h"

#include <assert.h>
#include <sluice/shared/bindings.h>

#define WRITES_AT_ONCE 64u

static SluiceResult create_empty(struct slc_texture_array *array, const struct slc_vk *vk,
                                 VkImage image)
{
    VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = image,
                                  .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                  .format = VK_FORMAT_R8G8B8A8_UNORM,
                                  .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    SluiceResult result = slc_vk_result(
        vk, vk->CreateImageView(vk->device, &info, NULL, &array->empty), "vkCreateImageView");
    if (result != SLUICE_SUCCESS)
        array->empty = VK_NULL_HANDLE;
    return result;
}

SluiceResult slc_texture_array_init(struct slc_texture_array *array, const struct slc_vk *vk,
                                    const SluiceAllocationCallbacks *cb, SluiceTextureArray kind,
                                    uint32_t count, VkImage image, VkSampler sampler,
                                    const struct slc_samplers *samplers)
{
    *array = (struct slc_texture_array){.kind = kind,
                                        .count = kind == SLUICE_TEXTURE_ARRAY_NONE ? 0 : count,
                                        .generation = 1,
                                        .empty_sampler = sampler,
                                        .samplers = samplers};
    if (array->count == 0)
        return SLUICE_SUCCESS;
    array->elements = slc_calloc(cb, count, sizeof *array->elements);
    if (!array->elements)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = create_empty(array, vk, image);
    for (uint32_t i = 0; i < count; i++)
        array->elements[i] = (struct slc_texture_element){array->empty, sampler, 1};
    return result;
}

void slc_texture_array_finish(struct slc_texture_array *array, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb)
{
    if (array->empty)
        vk->DestroyImageView(vk->device, array->empty, NULL);
    slc_free(cb, array->elements, array->count, sizeof *array->elements);
    *array = (struct slc_texture_array){0};
}

void slc_texture_array_set(struct slc_texture_array *array, uint32_t index, VkImageView view,
                           VkSampler sampler)
{
    if (array->count == 0)
        return;
    assert(index < array->count);
    array->elements[index] = (struct slc_texture_element){view, sampler, ++array->generation};
}

void slc_texture_array_clear(struct slc_texture_array *array, uint32_t index)
{
    slc_texture_array_set(array, index, array->empty, array->empty_sampler);
}

static VkDescriptorType type_of(const struct slc_texture_array *array)
{
    return array->kind == SLUICE_TEXTURE_ARRAY_SEPARATE ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE
                                                        : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

uint32_t slc_texture_array_bindings(const struct slc_texture_array *array, uint32_t binding,
                                    VkDescriptorSetLayoutBinding bindings[])
{
    if (array->count == 0)
        return 0;
    bindings[0] = (VkDescriptorSetLayoutBinding){.binding = binding,
                                                 .descriptorType = type_of(array),
                                                 .descriptorCount = array->count,
                                                 .stageFlags = VK_SHADER_STAGE_ALL};
    if (array->kind != SLUICE_TEXTURE_ARRAY_SEPARATE)
        return 1;
    bindings[1] = (VkDescriptorSetLayoutBinding){.binding = binding + 1,
                                                 .descriptorType = VK_DESCRIPTOR_TYPE_SAMPLER,
                                                 .descriptorCount = SLUICE_SAMPLER_COUNT,
                                                 .stageFlags = VK_SHADER_STAGE_ALL};
    return 2;
}

static void write_run(const struct slc_vk *vk, VkDescriptorSet set, uint32_t binding,
                      VkDescriptorType type, uint32_t first, uint32_t count,
                      const VkDescriptorImageInfo *images)
{
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = set,
                                  .dstBinding = binding,
                                  .dstArrayElement = first,
                                  .descriptorCount = count,
                                  .descriptorType = type,
                                  .pImageInfo = images};
    if (count)
        vk->UpdateDescriptorSets(vk->device, 1, &write, 0, NULL);
}

static void write_samplers(const struct slc_texture_array *array, const struct slc_vk *vk,
                           VkDescriptorSet set, uint32_t binding)
{
    VkDescriptorImageInfo samplers[SLUICE_SAMPLER_COUNT];
    for (uint32_t i = 0; i < SLUICE_SAMPLER_COUNT; i++)
        samplers[i] = (VkDescriptorImageInfo){.sampler = i < array->samplers->count
                                                             ? array->samplers->list[i].sampler
                                                             : array->empty_sampler};
    write_run(vk, set, binding, VK_DESCRIPTOR_TYPE_SAMPLER, 0, SLUICE_SAMPLER_COUNT, samplers);
}

void slc_texture_array_write(const struct slc_texture_array *array, const struct slc_vk *vk,
                             VkDescriptorSet set, uint32_t binding, uint64_t generation)
{
    VkDescriptorImageInfo images[WRITES_AT_ONCE];
    uint32_t first = 0, count = 0;
    for (uint32_t i = 0; i < array->count; i++) {
        const struct slc_texture_element *element = &array->elements[i];
        if (element->generation <= generation)
            continue;
        if (count == WRITES_AT_ONCE || first + count != i) {
            write_run(vk, set, binding, type_of(array), first, count, images);
            first = i;
            count = 0;
        }
        images[count++] =
            (VkDescriptorImageInfo){element->sampler, element->view, VK_IMAGE_LAYOUT_GENERAL};
    }
    write_run(vk, set, binding, type_of(array), first, count, images);
    if (array->kind == SLUICE_TEXTURE_ARRAY_SEPARATE)
        write_samplers(array, vk, set, binding + 1);
}
