#include "device/demand_scene.h"

#include "device/demand_images.h"

#include "base/checked.h"
#include "demand/tail_place.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#include "demand_probe_comp.h"
#include "demand_probe_frag.h"
#include "demand_probe_hlsl.h"
#include "demand_probe_loop_comp.h"

#define BUFFERS 9u
#define BINDINGS 11u

static void create_layout(struct demand_scene *s)
{
    struct harness *h = s->h;
    const VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i < BUFFERS ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                          : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .descriptorCount = i == BUFFERS ? DEMAND_CHUNKS : 1,
            .stageFlags = stages};
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = BINDINGS,
                                            .pBindings = bindings};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &info, NULL, &s->set_layout),
                     VK_SUCCESS);
    VkPushConstantRange push = {stages, 0, sizeof(uint32_t)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &s->set_layout,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &s->layout), VK_SUCCESS);
}

static void create_set(struct demand_scene *s)
{
    struct harness *h = s->h;
    VkDescriptorPoolSize sizes[2] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BUFFERS},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, DEMAND_CHUNKS + 1}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &s->pool), VK_SUCCESS);
    VkDescriptorSetAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = s->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &s->set_layout};
    assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &s->set), VK_SUCCESS);
    const struct harness_buffer *buffers[BUFFERS] = {&s->textures, &s->levels, &s->directory,
                                                     &s->blocks,   &s->masks,  &s->requests,
                                                     &s->sections, &s->inputs, &s->outputs};
    VkDescriptorBufferInfo infos[BUFFERS];
    for (uint32_t i = 0; i < BUFFERS; i++)
        infos[i] = (VkDescriptorBufferInfo){buffers[i]->buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = s->set,
                                  .descriptorCount = BUFFERS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = infos};
    h->UpdateDescriptorSets(h->device, 1, &write, 0, NULL);
}

static VkPipeline probe_pipeline(struct demand_scene *s, enum demand_shader shader)
{
    struct harness *h = s->h;
    VkBool32 values[2] = {shader == DEMAND_SHADER_PREVIEW || shader == DEMAND_SHADER_CUBIC_PREVIEW,
                          shader == DEMAND_SHADER_CUBIC || shader == DEMAND_SHADER_CUBIC_PREVIEW};
    VkSpecializationMapEntry entries[2] = {{0, 0, sizeof(VkBool32)},
                                           {1, sizeof(VkBool32), sizeof(VkBool32)}};
    VkSpecializationInfo special = {2, entries, sizeof values, values};
    return conform_compute_pipeline(
        h, s->layout, conform_module(h, demand_probe_comp, sizeof demand_probe_comp), &special);
}

/* Creates only the pipelines that are used: drivers take seconds to compile one. */
static VkPipeline create_pipeline(struct demand_scene *s, enum demand_shader shader)
{
    struct harness *h = s->h;
    if (shader == DEMAND_SHADER_LOOP)
        return conform_compute_pipeline(
            h, s->layout, conform_module(h, demand_probe_loop_comp, sizeof demand_probe_loop_comp),
            NULL);
    if (shader == DEMAND_SHADER_HLSL)
        return conform_compute_pipeline(
            h, s->layout, conform_module(h, demand_probe_hlsl, sizeof demand_probe_hlsl), NULL);
    if (shader == DEMAND_SHADER_FRAGMENT)
        return conform_graphics_pipeline(
            h, s->layout, s->pass, conform_vertex_module(h),
            conform_module(h, demand_probe_frag, sizeof demand_probe_frag), 0);
    return probe_pipeline(s, shader);
}

void demand_scene_init(struct demand_scene *s, struct harness *h, VkFormat format,
                       uint32_t tile_width_log2, uint32_t tile_height_log2)
{
    *s = (struct demand_scene){
        .h = h, .format = format, .tile_shift = {tile_width_log2, tile_height_log2}};
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const struct {
        struct harness_buffer *buffer;
        uint64_t size;
    } buffers[BUFFERS] = {
        {&s->textures, DEMAND_SAMPLES * sizeof(struct SluiceDemandTexture)},
        {&s->levels, DEMAND_LEVEL_WORDS * sizeof(uint32_t)},
        {&s->directory, DEMAND_PAGES / SLUICE_DEMAND_BLOCK_PAGES * sizeof(uint32_t)},
        {&s->blocks, DEMAND_BLOCKS_MAX * SLUICE_DEMAND_BLOCK_WORDS * sizeof(uint32_t)},
        {&s->masks, DEMAND_BLOCKS_MAX * sizeof(struct SluiceDemandBlockMasks)},
        {&s->requests, DEMAND_PAGES / 8},
        {&s->sections, DEMAND_PAGES / SLUICE_DEMAND_SECTION_PAGES / 8},
        {&s->inputs, DEMAND_SAMPLES * sizeof(struct DemandInput)},
        {&s->outputs, DEMAND_SAMPLES * sizeof(struct DemandOutput)}};
    for (uint32_t i = 0; i < BUFFERS; i++)
        harness_buffer_init(h, buffers[i].buffer, buffers[i].size, usage);
    create_layout(s);
    create_set(s);
    conform_create_target(h, &s->pass, &s->framebuffer);
    demand_images_init(s);
    demand_scene_clear(s);
    demand_images_upload(s);
}

void demand_scene_finish(struct demand_scene *s)
{
    struct harness *h = s->h;
    demand_images_finish(s);
    for (uint32_t i = 0; i < DEMAND_SHADERS; i++)
        if (s->pipelines[i])
            h->DestroyPipeline(h->device, s->pipelines[i], NULL);
    h->DestroyFramebuffer(h->device, s->framebuffer, NULL);
    h->DestroyRenderPass(h->device, s->pass, NULL);
    h->DestroyDescriptorPool(h->device, s->pool, NULL);
    h->DestroyPipelineLayout(h->device, s->layout, NULL);
    h->DestroyDescriptorSetLayout(h->device, s->set_layout, NULL);
    struct harness_buffer *buffers[BUFFERS] = {&s->textures, &s->levels, &s->directory,
                                               &s->blocks,   &s->masks,  &s->requests,
                                               &s->sections, &s->inputs, &s->outputs};
    for (uint32_t i = 0; i < BUFFERS; i++)
        harness_buffer_finish(h, buffers[i]);
}

void demand_scene_reshape(struct demand_scene *s, VkFormat format, uint32_t tile_width_log2,
                          uint32_t tile_height_log2)
{
    demand_images_finish(s);
    s->format = format;
    s->tile_shift[0] = tile_width_log2;
    s->tile_shift[1] = tile_height_log2;
    demand_images_init(s);
    demand_scene_clear(s);
    demand_images_upload(s);
}

static void zero(struct harness_buffer *buffer)
{
    memset(buffer->mapped, 0, buffer->size);
}

void demand_scene_clear(struct demand_scene *s)
{
    s->texture_count = 0;
    s->level_count = SLUICE_DEMAND_PARAMETER_COUNT;
    s->page_end = DEMAND_SAMPLES;
    s->block_count = 1;
    s->layer_count = 0;
    zero(&s->textures);
    zero(&s->levels);
    zero(&s->directory);
    memset(s->blocks.mapped, 0xa5, s->blocks.size); /* former content of blocks */
    memset(s->masks.mapped, 0xff, s->masks.size);
    zero(&s->requests);
    zero(&s->sections);
    ((uint32_t *)s->levels.mapped)[SLUICE_DEMAND_PARAMETER_TRACKING] = 1;
    demand_images_clear(s);
}

struct SluiceDemandTexture *demand_scene_entry(struct demand_scene *s, uint32_t index)
{
    return (struct SluiceDemandTexture *)s->textures.mapped + index;
}

static uint32_t allocate_pages(struct demand_scene *s, uint32_t count)
{
    uint32_t first = s->page_end;
    s->page_end += slc_div_up_u32(count, SLUICE_DEMAND_BLOCK_PAGES) * SLUICE_DEMAND_BLOCK_PAGES;
    assert_true(s->page_end <= DEMAND_PAGES);
    return first;
}

uint32_t demand_scene_add(struct demand_scene *s, const struct demand_texture *t)
{
    assert_true(s->texture_count < DEMAND_SAMPLES);
    const uint32_t tile[2] = {1u << s->tile_shift[0], 1u << s->tile_shift[1]};
    uint32_t levels = slc_mip_count(slc_max_u32(t->width, t->height));
    uint32_t regular = slc_demand_regular_count(t->width, t->height, tile[0], tile[1]);
    uint32_t components = s->format == VK_FORMAT_R32_SFLOAT ? 1 : 4;
    struct SluiceDemandTexture *e = demand_scene_entry(s, s->texture_count);
    *e = (struct SluiceDemandTexture){
        .state = SLUICE_DEMAND_TEXTURE_OPEN,
        .width = t->width,
        .height = t->height,
        .shape = s->tile_shift[0] | s->tile_shift[1] << SLUICE_DEMAND_TILE_HEIGHT_SHIFT |
                 levels << SLUICE_DEMAND_LEVEL_COUNT_SHIFT |
                 regular << SLUICE_DEMAND_REGULAR_SHIFT | t->mode_u << SLUICE_DEMAND_MODE_U_SHIFT |
                 t->mode_v << SLUICE_DEMAND_MODE_V_SHIFT |
                 components << SLUICE_DEMAND_COMPONENTS_SHIFT |
                 (t->nearest ? SLUICE_DEMAND_NEAREST : 0) |
                 (t->nearest_level ? SLUICE_DEMAND_NEAREST_LEVEL : 0) |
                 (t->blocks ? SLUICE_DEMAND_BLOCKS : 0) |
                 (t->cubic || t->smart ? SLUICE_DEMAND_SPLINE : 0) |
                 (t->smart ? SLUICE_DEMAND_SMART : 0),
        .levels = s->level_count,
        .maxAnisotropy = t->anisotropy,
        .lodBias = t->bias};
    memcpy(e->baseColor, t->base_color, sizeof e->baseColor);
    memcpy(e->borderColor, t->border_color, sizeof e->borderColor);
    assert_true(s->level_count + regular <= DEMAND_LEVEL_WORDS);
    for (uint32_t l = 0; l < regular; l++) {
        uint32_t count = slc_div_up_u32(slc_mip_size(t->width, l), tile[0]) *
                         slc_div_up_u32(slc_mip_size(t->height, l), tile[1]);
        ((uint32_t *)s->levels.mapped)[s->level_count++] = allocate_pages(s, count);
    }
    e->tailPage = allocate_pages(s, 1);
    return s->texture_count++;
}

static uint32_t bits(uint32_t word, uint32_t shift, uint32_t count)
{
    return word >> shift & ((1u << count) - 1);
}

uint32_t demand_scene_page(struct demand_scene *s, uint32_t index, uint32_t level, uint32_t x,
                           uint32_t y)
{
    const struct SluiceDemandTexture *e = demand_scene_entry(s, index);
    if (level + 1 == bits(e->shape, SLUICE_DEMAND_LEVEL_COUNT_SHIFT, 5))
        return DEMAND_NO_PAGE;
    if (level >= bits(e->shape, SLUICE_DEMAND_REGULAR_SHIFT, 5))
        return e->tailPage;
    uint32_t columns = slc_div_up_u32(slc_mip_size(e->width, level), 1u << s->tile_shift[0]);
    return ((const uint32_t *)s->levels.mapped)[e->levels + level] +
           (y >> s->tile_shift[1]) * columns + (x >> s->tile_shift[0]);
}

void demand_scene_set_page(struct demand_scene *s, uint32_t page, uint32_t low, uint32_t high)
{
    uint32_t *directory = s->directory.mapped, *blocks = s->blocks.mapped;
    struct SluiceDemandBlockMasks *masks = s->masks.mapped;
    uint32_t *block = &directory[page / SLUICE_DEMAND_BLOCK_PAGES];
    if (*block == SLUICE_DEMAND_NO_BLOCK) {
        assert_true(s->block_count < DEMAND_BLOCKS_MAX);
        *block = s->block_count++;
        masks[*block] = (struct SluiceDemandBlockMasks){0, 0};
    }
    uint32_t at = page % SLUICE_DEMAND_BLOCK_PAGES;
    blocks[*block * SLUICE_DEMAND_BLOCK_WORDS + at] = low;
    blocks[*block * SLUICE_DEMAND_BLOCK_WORDS + SLUICE_DEMAND_BLOCK_PAGES + at] = high;
    masks[*block].resident |= 1u << at;
}

struct DemandInput *demand_inputs(struct demand_scene *s)
{
    return s->inputs.mapped;
}

const struct DemandOutput *demand_outputs(const struct demand_scene *s)
{
    return s->outputs.mapped;
}

void demand_scene_run(struct demand_scene *s, enum demand_shader shader, uint32_t count)
{
    if (!s->pipelines[shader])
        s->pipelines[shader] = create_pipeline(s, shader);
    struct conform_set set = {s->set_layout, s->layout, s->pool, s->set};
    struct conform_job job = {.set = &set,
                              .stage = shader == DEMAND_SHADER_FRAGMENT ? CONFORM_STAGE_FRAGMENT
                                                                        : CONFORM_STAGE_COMPUTE,
                              .pipeline = s->pipelines[shader],
                              .pass = s->pass,
                              .framebuffer = s->framebuffer,
                              .count = count,
                              .push = &count,
                              .push_size = sizeof count};
    memset(s->outputs.mapped, 0xcc, s->outputs.size);
    conform_run_job(s->h, &job);
}

bool demand_has_block(const struct demand_scene *s, uint32_t page)
{
    return ((const uint32_t *)s->directory.mapped)[page / SLUICE_DEMAND_BLOCK_PAGES] !=
           SLUICE_DEMAND_NO_BLOCK;
}

static bool mask_bit(const struct demand_scene *s, uint32_t page, bool used)
{
    uint32_t block = ((const uint32_t *)s->directory.mapped)[page / SLUICE_DEMAND_BLOCK_PAGES];
    const struct SluiceDemandBlockMasks *masks =
        (const struct SluiceDemandBlockMasks *)s->masks.mapped + block;
    return block != SLUICE_DEMAND_NO_BLOCK &&
           (used ? masks->used : masks->resident) >> page % SLUICE_DEMAND_BLOCK_PAGES & 1;
}

static uint32_t word_of(const struct demand_scene *s, uint32_t page)
{
    uint32_t block = ((const uint32_t *)s->directory.mapped)[page / SLUICE_DEMAND_BLOCK_PAGES];
    return ((const uint32_t *)s->blocks
                .mapped)[block * SLUICE_DEMAND_BLOCK_WORDS + page % SLUICE_DEMAND_BLOCK_PAGES];
}

bool demand_refused(const struct demand_scene *s, uint32_t page)
{
    return mask_bit(s, page, false) && word_of(s, page) == SLUICE_DEMAND_PAGE_REFUSED;
}

bool demand_resident(const struct demand_scene *s, uint32_t page)
{
    return mask_bit(s, page, false) && word_of(s, page) < SLUICE_DEMAND_PAGE_REFUSED;
}

bool demand_used(const struct demand_scene *s, uint32_t page)
{
    return mask_bit(s, page, true);
}

bool demand_requested(const struct demand_scene *s, uint32_t page)
{
    return ((const uint32_t *)s->requests.mapped)[page / 32] >> page % 32 & 1;
}

void demand_check_sections(const struct demand_scene *s)
{
    const uint32_t *requests = s->requests.mapped, *sections = s->sections.mapped;
    const uint32_t words = SLUICE_DEMAND_SECTION_PAGES / 32;
    for (uint32_t i = 0; i < DEMAND_PAGES / SLUICE_DEMAND_SECTION_PAGES; i++) {
        uint32_t any = 0;
        for (uint32_t j = 0; j < words; j++)
            any |= requests[i * words + j];
        assert_int_equal(sections[i / 32] >> i % 32 & 1, any != 0);
    }
}
