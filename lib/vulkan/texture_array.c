#include "vulkan/texture_array.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>
#include <sluice/shared/bindings.h>

#define WRITES_AT_ONCE 64u

#define FACES 6u

static SluiceResult create_empty(const struct slc_vk *vk, VkImage image, VkImageViewType type,
                                 VkImageView *view)
{
    VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = image,
                                  .viewType = type,
                                  .format = VK_FORMAT_R8G8B8A8_UNORM,
                                  .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    if (type == VK_IMAGE_VIEW_TYPE_CUBE)
        info.subresourceRange.layerCount = FACES;
    SluiceResult result =
        slc_vk_result(vk, vk->CreateImageView(vk->device, &info, NULL, view), "vkCreateImageView");
    if (result != SLUICE_SUCCESS)
        *view = VK_NULL_HANDLE;
    return result;
}

static uint32_t element_count(const struct slc_texture_array *array)
{
    return array->count + array->cube_count;
}

SluiceResult slc_texture_array_init(struct slc_texture_array *array, const struct slc_vk *vk,
                                    const SluiceAllocationCallbacks *cb, SluiceTextureArray kind,
                                    uint32_t count, VkImage image, VkSampler sampler,
                                    const struct slc_samplers *samplers)
{
    *array = (struct slc_texture_array){
        .kind = kind, .generation = 1, .empty_sampler = sampler, .samplers = samplers};
    if (kind == SLUICE_TEXTURE_ARRAY_NONE)
        return SLUICE_SUCCESS;
    array->count = count;
    array->cube_count = slc_div_up_u32(count, FACES);
    array->elements = slc_calloc(cb, element_count(array), sizeof *array->elements);
    if (!array->elements)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = create_empty(vk, image, VK_IMAGE_VIEW_TYPE_2D, &array->empty);
    if (result == SLUICE_SUCCESS)
        result = create_empty(vk, image, VK_IMAGE_VIEW_TYPE_CUBE, &array->empty_cube);
    for (uint32_t i = 0; i < element_count(array); i++)
        array->elements[i] =
            (struct slc_texture_element){i < count ? array->empty : array->empty_cube, sampler, 1};
    return result;
}

void slc_texture_array_finish(struct slc_texture_array *array, const struct slc_vk *vk,
                              const SluiceAllocationCallbacks *cb)
{
    if (array->empty)
        vk->DestroyImageView(vk->device, array->empty, NULL);
    if (array->empty_cube)
        vk->DestroyImageView(vk->device, array->empty_cube, NULL);
    slc_free(cb, array->elements, element_count(array), sizeof *array->elements);
    *array = (struct slc_texture_array){0};
}

static void set_element(struct slc_texture_array *array, uint32_t at, VkImageView view,
                        VkSampler sampler)
{
    assert(at < element_count(array));
    array->elements[at] = (struct slc_texture_element){view, sampler, ++array->generation};
}

void slc_texture_array_set(struct slc_texture_array *array, uint32_t index, VkImageView view,
                           VkImageView cube, VkSampler sampler)
{
    if (array->count == 0)
        return;
    set_element(array, index, view, sampler);
    if (cube)
        set_element(array, array->count + index / FACES, cube, sampler);
}

void slc_texture_array_clear(struct slc_texture_array *array, uint32_t index, bool cube)
{
    slc_texture_array_set(array, index, array->empty, cube ? array->empty_cube : VK_NULL_HANDLE,
                          array->empty_sampler);
}

static VkDescriptorType type_of(const struct slc_texture_array *array)
{
    return array->kind == SLUICE_TEXTURE_ARRAY_SEPARATE ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE
                                                        : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

static VkDescriptorSetLayoutBinding binding_of(uint32_t binding, VkDescriptorType type,
                                               uint32_t count)
{
    return (VkDescriptorSetLayoutBinding){.binding = binding,
                                          .descriptorType = type,
                                          .descriptorCount = count,
                                          .stageFlags = VK_SHADER_STAGE_ALL};
}

uint32_t slc_texture_array_bindings(const struct slc_texture_array *array, uint32_t binding,
                                    VkDescriptorSetLayoutBinding bindings[])
{
    uint32_t count = 0;
    if (array->count == 0)
        return 0;
    bindings[count++] = binding_of(binding, type_of(array), array->count);
    if (array->kind == SLUICE_TEXTURE_ARRAY_SEPARATE)
        bindings[count++] =
            binding_of(binding + 1, VK_DESCRIPTOR_TYPE_SAMPLER, SLUICE_SAMPLER_COUNT);
    bindings[count++] = binding_of(binding + 2, type_of(array), array->cube_count);
    return count;
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

/* Writes elements [begin, end) of one binding that changed after `generation`. */
static void write_elements(const struct slc_texture_array *array, const struct slc_vk *vk,
                           VkDescriptorSet set, uint32_t binding, uint32_t begin, uint32_t end,
                           uint64_t generation)
{
    VkDescriptorImageInfo images[WRITES_AT_ONCE];
    uint32_t first = begin, count = 0;
    for (uint32_t i = begin; i < end; i++) {
        const struct slc_texture_element *element = &array->elements[i];
        if (element->generation <= generation)
            continue;
        if (count == WRITES_AT_ONCE || first + count != i) {
            write_run(vk, set, binding, type_of(array), first - begin, count, images);
            first = i;
            count = 0;
        }
        images[count++] =
            (VkDescriptorImageInfo){element->sampler, element->view, VK_IMAGE_LAYOUT_GENERAL};
    }
    write_run(vk, set, binding, type_of(array), first - begin, count, images);
}

void slc_texture_array_write(const struct slc_texture_array *array, const struct slc_vk *vk,
                             VkDescriptorSet set, uint32_t binding, uint64_t generation)
{
    write_elements(array, vk, set, binding, 0, array->count, generation);
    write_elements(array, vk, set, binding + 2, array->count, element_count(array), generation);
    if (array->kind == SLUICE_TEXTURE_ARRAY_SEPARATE)
        write_samplers(array, vk, set, binding + 1);
}
