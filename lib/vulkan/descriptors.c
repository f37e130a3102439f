#include "vulkan/descriptors.h"

#include "base/checked.h"
#include "base/log.h"

#include <assert.h>
#include <sluice/shared/bindings.h>

#define MAX_BINDINGS (SLC_DESCRIPTOR_BUFFERS + 1 + SLC_TEXTURE_ARRAY_BINDINGS)
#define WRITES_AT_ONCE 64u

/* Makes a layout binding for all stages: the library does not know which stage samples. */
static VkDescriptorSetLayoutBinding binding_of(uint32_t binding, VkDescriptorType type,
                                               uint32_t count)
{
    return (VkDescriptorSetLayoutBinding){.binding = binding,
                                          .descriptorType = type,
                                          .descriptorCount = count,
                                          .stageFlags = VK_SHADER_STAGE_ALL};
}

static SluiceResult create_layout(struct slc_descriptors *d, const struct slc_vk *vk,
                                  const VkDescriptorSetLayoutBinding *bindings, uint32_t count)
{
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = count,
                                            .pBindings = bindings};
    SluiceResult result =
        slc_vk_result(vk, vk->CreateDescriptorSetLayout(vk->device, &info, NULL, &d->layout),
                      "vkCreateDescriptorSetLayout");
    if (result != SLUICE_SUCCESS)
        d->layout = VK_NULL_HANDLE;
    return result;
}

static SluiceResult create_pool(struct slc_descriptors *d, const struct slc_vk *vk,
                                const VkDescriptorSetLayoutBinding *bindings, uint32_t count,
                                uint32_t set_count)
{
    VkDescriptorPoolSize sizes[MAX_BINDINGS];
    for (uint32_t i = 0; i < count; i++)
        sizes[i] = (VkDescriptorPoolSize){bindings[i].descriptorType,
                                          bindings[i].descriptorCount * set_count};
    VkDescriptorPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = set_count,
                                       .poolSizeCount = count,
                                       .pPoolSizes = sizes};
    SluiceResult result = slc_vk_result(
        vk, vk->CreateDescriptorPool(vk->device, &info, NULL, &d->pool), "vkCreateDescriptorPool");
    if (result != SLUICE_SUCCESS)
        d->pool = VK_NULL_HANDLE;
    return result;
}

static SluiceResult allocate_set(struct slc_descriptors *d, const struct slc_vk *vk,
                                 const struct slc_descriptors_create_info *info,
                                 VkDescriptorSet *set)
{
    VkDescriptorSetAllocateInfo set_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = d->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &d->layout};
    SluiceResult result = slc_vk_result(vk, vk->AllocateDescriptorSets(vk->device, &set_info, set),
                                        "vkAllocateDescriptorSets");
    if (result != SLUICE_SUCCESS)
        return result;
    VkDescriptorBufferInfo buffers[SLC_DESCRIPTOR_BUFFERS];
    for (uint32_t i = 0; i < info->buffer_count; i++)
        buffers[i] = (VkDescriptorBufferInfo){info->buffers[i], 0, VK_WHOLE_SIZE};
    /* One write may continue in the next bindings, since all have equal types and stages. */
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = *set,
                                  .descriptorCount = info->buffer_count,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = buffers};
    vk->UpdateDescriptorSets(vk->device, 1, &write, 0, NULL);
    return SLUICE_SUCCESS;
}

/* Checks the limits per stage. Combined image samplers take a sampler each, separate images only
 * the array of samplers. */
static SluiceResult check_limits(const struct slc_vk *vk, const struct slc_caps *caps,
                                 const struct slc_descriptors_create_info *info)
{
    const struct slc_texture_array *textures = info->textures;
    bool separate = textures->kind == SLUICE_TEXTURE_ARRAY_SEPARATE;
    uint64_t images = (uint64_t)info->page_count + textures->count + textures->cube_count;
    uint64_t samplers = separate ? (uint64_t)info->page_count + SLUICE_SAMPLER_COUNT : images;
    if (images <= caps->max_stage_images && samplers <= caps->max_stage_samplers)
        return SLUICE_SUCCESS;
    slc_log(&vk->log, SLUICE_LOG_ERROR,
            "textureArray with maxTextureCount %u and %u pages needs %llu images and %llu samplers "
            "per shader stage; %s has %u and %u",
            textures->count, info->page_count, (unsigned long long)images,
            (unsigned long long)samplers, caps->public.deviceName, caps->max_stage_images,
            caps->max_stage_samplers);
    return SLUICE_ERROR_LIMIT_EXCEEDED;
}

SluiceResult slc_descriptors_init(struct slc_descriptors *descriptors, const struct slc_vk *vk,
                                  const struct slc_caps *caps,
                                  const struct slc_descriptors_create_info *info)
{
    struct slc_descriptors *d = descriptors;
    assert(info->buffer_count <= SLC_DESCRIPTOR_BUFFERS && info->set_count <= SLC_DESCRIPTOR_SETS);
    assert(info->array_count <= SLC_DESCRIPTOR_ARRAY && !(info->array_count && info->textures));
    *d = (struct slc_descriptors){.page_binding = info->buffer_count,
                                  .page_count = info->page_count,
                                  .array_count = info->array_count};
    if (info->textures && info->textures->count) {
        SluiceResult result = check_limits(vk, caps, info);
        if (result != SLUICE_SUCCESS)
            return result;
    } else if (info->page_count > caps->max_stage_samplers) {
        return SLUICE_SUCCESS;
    }
    VkDescriptorSetLayoutBinding bindings[MAX_BINDINGS];
    uint32_t count = 0;
    for (; count < info->buffer_count; count++)
        bindings[count] = binding_of(count, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1);
    bindings[count] =
        binding_of(count, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, info->page_count);
    count++;
    if (info->textures)
        count += slc_texture_array_bindings(info->textures, count, &bindings[count]);
    if (info->array_count) {
        bindings[count] = binding_of(count, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, info->array_count);
        count++;
    }
    SluiceResult result = create_layout(d, vk, bindings, count);
    if (result == SLUICE_SUCCESS)
        result = create_pool(d, vk, bindings, count, info->set_count);
    for (uint32_t i = 0; i < info->set_count && result == SLUICE_SUCCESS; i++)
        result = allocate_set(d, vk, info, &d->sets[i].set);
    return result;
}

void slc_descriptors_finish(struct slc_descriptors *descriptors, const struct slc_vk *vk)
{
    if (descriptors->pool)
        vk->DestroyDescriptorPool(vk->device, descriptors->pool, NULL);
    if (descriptors->layout)
        vk->DestroyDescriptorSetLayout(vk->device, descriptors->layout, NULL);
    *descriptors = (struct slc_descriptors){0};
}

static void write_pages(const struct slc_descriptors *d, const struct slc_vk *vk,
                        VkDescriptorSet set, const struct slc_page_views *pages)
{
    VkDescriptorImageInfo images[WRITES_AT_ONCE];
    for (uint32_t done = 0, count; done < d->page_count; done += count) {
        count = slc_min_u32(d->page_count - done, WRITES_AT_ONCE);
        for (uint32_t i = 0; i < count; i++)
            images[i] = (VkDescriptorImageInfo){pages->sampler, pages->views[done + i],
                                                VK_IMAGE_LAYOUT_GENERAL};
        VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                      .dstSet = set,
                                      .dstBinding = d->page_binding,
                                      .dstArrayElement = done,
                                      .descriptorCount = count,
                                      .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                      .pImageInfo = images};
        vk->UpdateDescriptorSets(vk->device, 1, &write, 0, NULL);
    }
}

static void update_pages(const struct slc_descriptors *d, const struct slc_vk *vk,
                         struct slc_descriptor_set *set, const struct slc_page_views *shown)
{
    if (set->page_generation == shown->generation)
        return;
    assert(d->page_count <= shown->count);
    write_pages(d, vk, set->set, shown);
    set->page_generation = shown->generation;
}

VkDescriptorSet slc_descriptors_update(struct slc_descriptors *descriptors, const struct slc_vk *vk,
                                       uint32_t index, const struct slc_page_views *pages,
                                       const struct slc_texture_array *textures)
{
    struct slc_descriptor_set *set = &descriptors->sets[index];
    if (!set->set)
        return VK_NULL_HANDLE;
    update_pages(descriptors, vk, set, pages);
    if (textures && set->texture_generation != textures->generation) {
        slc_texture_array_write(textures, vk, set->set, descriptors->page_binding + 1,
                                set->texture_generation);
        set->texture_generation = textures->generation;
    }
    return set->set;
}

void slc_descriptors_update_array(struct slc_descriptors *descriptors, const struct slc_vk *vk,
                                  uint32_t index, const struct slc_buffer_array *array)
{
    struct slc_descriptor_set *set = &descriptors->sets[index];
    VkDescriptorBufferInfo buffers[SLC_DESCRIPTOR_ARRAY];
    if (!set->set || !descriptors->array_count || set->array_generation == array->generation)
        return;
    for (uint32_t i = 0; i < descriptors->array_count; i++)
        buffers[i] = (VkDescriptorBufferInfo){array->buffers[i], 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = set->set,
                                  .dstBinding = descriptors->page_binding + 1,
                                  .descriptorCount = descriptors->array_count,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = buffers};
    vk->UpdateDescriptorSets(vk->device, 1, &write, 0, NULL);
    set->array_generation = array->generation;
}

SluiceResult slc_descriptors_get_layout(const struct slc_descriptors *descriptors,
                                        const struct slc_vk *vk, const struct slc_caps *caps,
                                        VkDescriptorSetLayout *layout)
{
    *layout = descriptors->layout;
    if (*layout)
        return SLUICE_SUCCESS;
    slc_log(&vk->log, SLUICE_LOG_ERROR,
            "maxPageChunkCount is %u: there are no descriptor sets, because %s has only %u "
            "samplers per shader stage",
            descriptors->page_count, caps->public.deviceName, caps->max_stage_samplers);
    return SLUICE_ERROR_UNSUPPORTED;
}
