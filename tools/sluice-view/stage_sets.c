#include "stage_sets.h"

#include <string.h>

#define SLOT_SECOND_UV 1u
#define SLOT_WRITES 2u
#define SLOT_WRITES_ALONE 4u
#define SLOT_IMAGE_SHIFT 8
#define MATERIAL_MISSING 1u

/* Same layout as in shaders/scene_material.glsl. */
struct gpu_slot {
    float turn[4], offset[2];
    uint32_t table_index, flags;
};
struct gpu_material {
    float color[4], emissive[3], cutoff;
    float metalness, roughness, normal_scale, occlusion;
    uint32_t flags, unused[3];
    struct gpu_slot slots[SLOT_COUNT];
};
_Static_assert(sizeof(struct gpu_material) == 224, "as in scene_material.glsl");

/* Returns the feedback flag of a slot. A slot that equals an earlier one writes none. A follower
 * writes only while sets are off. */
static uint32_t writes(const struct scene_data *scene, const struct scene_material *material, int k)
{
    const struct scene_slot *slot = &material->slots[k];
    for (int i = 0; i < k; i++)
        if (memcmp(&material->slots[i], slot, sizeof *slot) == 0)
            return 0;
    return scene->images[slot->image].primary != SCENE_NO_IMAGE ? SLOT_WRITES_ALONE : SLOT_WRITES;
}

static struct gpu_material pack(const struct scene_data *scene,
                                const struct scene_material *material, const uint32_t *tables)
{
    struct gpu_material to = {.cutoff = material->alpha == ALPHA_MASK ? material->cutoff : -1.0f,
                              .metalness = material->metalness,
                              .roughness = material->roughness,
                              .normal_scale = material->normal_scale,
                              .occlusion = material->occlusion,
                              .flags = material->missing ? MATERIAL_MISSING : 0u};
    memcpy(to.color, material->color, sizeof to.color);
    memcpy(to.emissive, material->emissive, sizeof to.emissive);
    if (material->alpha == ALPHA_OPAQUE)
        to.color[3] = 1.0f;
    for (int k = 0; k < SLOT_COUNT; k++) {
        const struct scene_slot *slot = &material->slots[k];
        memcpy(to.slots[k].turn, slot->m, sizeof to.slots[k].turn);
        memcpy(to.slots[k].offset, slot->m + 4, sizeof to.slots[k].offset);
        to.slots[k].table_index = UINT32_MAX;
        if (slot->image == SCENE_NO_IMAGE)
            continue;
        to.slots[k].table_index = tables[slot->image];
        to.slots[k].flags = (slot->uv_set ? SLOT_SECOND_UV : 0u) | writes(scene, material, k) |
                            slot->image << SLOT_IMAGE_SHIFT;
    }
    return to;
}

static bool create_buffers(struct stage_sets *s, const struct scene_data *scene,
                           const uint32_t *tables, size_t mark_size)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (!gpu_create_buffer(s->gpu, (scene->material_count + 1u) * sizeof(struct gpu_material),
                           usage, &s->materials))
        return false;
    struct gpu_material *to = s->materials.mapped;
    for (uint32_t i = 0; i < scene->material_count; i++)
        to[i] = pack(scene, &scene->materials[i], tables);
    for (int i = 0; i < FRAMES_SLOTS; i++)
        if (!gpu_create_buffer(s->gpu, mark_size, usage, &s->marks[i]))
            return false;
    return true;
}

static bool create_layout(struct stage_sets *s)
{
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL}};
    const VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 2,
        .pBindings = bindings};
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * FRAMES_SLOTS};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = FRAMES_SLOTS,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
    return gpu_check(vkCreateDescriptorSetLayout(s->gpu->device, &layout, NULL, &s->layout),
                     "vkCreateDescriptorSetLayout") &&
           gpu_check(vkCreateDescriptorPool(s->gpu->device, &pool, NULL, &s->pool),
                     "vkCreateDescriptorPool");
}

static bool create_set(struct stage_sets *s, int slot)
{
    const VkDescriptorSetAllocateInfo set = {.sType =
                                                 VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = s->pool,
                                             .descriptorSetCount = 1,
                                             .pSetLayouts = &s->layout};
    if (!gpu_check(vkAllocateDescriptorSets(s->gpu->device, &set, &s->sets[slot]),
                   "vkAllocateDescriptorSets"))
        return false;
    const VkDescriptorBufferInfo buffers[] = {{s->materials.buffer, 0, VK_WHOLE_SIZE},
                                              {s->marks[slot].buffer, 0, VK_WHOLE_SIZE}};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = s->sets[slot],
                                        .descriptorCount = 2,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = buffers};
    vkUpdateDescriptorSets(s->gpu->device, 1, &write, 0, NULL);
    return true;
}

bool stage_sets_create(const struct gpu *gpu, const struct scene_data *scene,
                       const uint32_t *table_indices, size_t mark_size, struct stage_sets *s)
{
    *s = (struct stage_sets){.gpu = gpu};
    bool created = create_buffers(s, scene, table_indices, mark_size) && create_layout(s);
    for (int i = 0; created && i < FRAMES_SLOTS; i++)
        created = create_set(s, i);
    if (!created)
        stage_sets_destroy(s);
    return created;
}

void stage_sets_destroy(struct stage_sets *s)
{
    if (!s->gpu)
        return;
    vkDestroyDescriptorPool(s->gpu->device, s->pool, NULL);
    vkDestroyDescriptorSetLayout(s->gpu->device, s->layout, NULL);
    for (int i = 0; i < FRAMES_SLOTS; i++)
        gpu_destroy_buffer(s->gpu, &s->marks[i]);
    gpu_destroy_buffer(s->gpu, &s->materials);
    *s = (struct stage_sets){0};
}
