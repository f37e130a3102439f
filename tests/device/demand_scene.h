/**
 * Buffers and array images of demand loading, laid out by hand. Without a loader, tests can use any
 * texture with any resident pages, and every request belongs to a known sample.
 *
 * Texels have four bytes. Layers without a tile, and texels outside of the texture, are NaN or
 * magenta.
 */
#ifndef TESTS_DEVICE_DEMAND_SCENE_H
#define TESTS_DEVICE_DEMAND_SCENE_H

#include "device/conform.h"

#include <sluice/shared/demand.h>

#include "demand_probe_shared.h"

#define DEMAND_SAMPLES 2048u      ///< samples per run; also the limit of textures
#define DEMAND_PAGES (1u << 22)   ///< page ids; opening pages come first
#define DEMAND_BLOCKS_MAX 1024u   ///< block 0 is unused
#define DEMAND_LEVEL_WORDS 65536u ///< the first words are the parameters
#define DEMAND_LAYERS 128u        ///< layers of each array image
#define DEMAND_NO_PAGE UINT32_MAX

struct demand_texture {
    uint32_t width, height;
    uint32_t mode_u, mode_v; ///< VkSamplerAddressMode
    bool nearest, nearest_level, blocks;
    bool cubic, smart; ///< bicubic filter: always, or where magnified
    float anisotropy, bias;
    float base_color[4], border_color[4];
};

/** Shaders. Each sampling function is called in one of them. */
enum demand_shader {
    DEMAND_SHADER_COMPUTE,
    DEMAND_SHADER_PREVIEW,
    DEMAND_SHADER_CUBIC, ///< supports bicubic filters of textures
    DEMAND_SHADER_CUBIC_PREVIEW,
    DEMAND_SHADER_LOOP, ///< finds array images by a loop
    DEMAND_SHADER_HLSL, ///< DEMAND_SHADER_COMPUTE in HLSL, with a loop
    DEMAND_SHADER_FRAGMENT,
    DEMAND_SHADERS,
};

struct demand_scene {
    struct harness *h;
    VkFormat format; ///< R8G8B8A8_UNORM or R32_SFLOAT
    uint32_t tile_shift[2];
    struct harness_buffer textures, levels, directory, blocks, masks, requests, sections, inputs,
        outputs, staging;
    uint32_t texture_count, level_count, page_end, block_count;
    uint32_t layers[DEMAND_CHUNKS * DEMAND_LAYERS], layer_count; ///< shuffled; number of used ones
    VkImage images[DEMAND_CHUNKS], plain;
    VkDeviceMemory memories[DEMAND_CHUNKS], plain_memory;
    VkImageView views[DEMAND_CHUNKS], plain_view;
    VkSampler sampler, plain_sampler;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipeline pipelines[DEMAND_SHADERS];
    VkRenderPass pass;
    VkFramebuffer framebuffer;
};

/** `tile_width_log2` and `tile_height_log2`: at most 7. */
void demand_scene_init(struct demand_scene *s, struct harness *h, VkFormat format,
                       uint32_t tile_width_log2, uint32_t tile_height_log2);
/** Resets the scene, with other tiles. */
void demand_scene_reshape(struct demand_scene *s, VkFormat format, uint32_t tile_width_log2,
                          uint32_t tile_height_log2);
void demand_scene_finish(struct demand_scene *s);
/** Clears textures, resident pages and requests. Enables used bits. */
void demand_scene_clear(struct demand_scene *s);

/** Adds an open texture without resident pages. Returns its index. */
uint32_t demand_scene_add(struct demand_scene *s, const struct demand_texture *texture);
struct SluiceDemandTexture *demand_scene_entry(struct demand_scene *s, uint32_t index);
/** Returns the page of a texel, or DEMAND_NO_PAGE for the last level. */
uint32_t demand_scene_page(struct demand_scene *s, uint32_t index, uint32_t level, uint32_t x,
                           uint32_t y);

/** Makes a page resident with any words. Creates its block. */
void demand_scene_set_page(struct demand_scene *s, uint32_t page, uint32_t low, uint32_t high);
struct DemandInput *demand_inputs(struct demand_scene *s);
const struct DemandOutput *demand_outputs(const struct demand_scene *s);
/** Runs samples. Adds to the existing requests and used bits. */
void demand_scene_run(struct demand_scene *s, enum demand_shader shader, uint32_t count);

bool demand_resident(const struct demand_scene *s, uint32_t page);
bool demand_refused(const struct demand_scene *s, uint32_t page);
bool demand_used(const struct demand_scene *s, uint32_t page);
bool demand_has_block(const struct demand_scene *s, uint32_t page);
bool demand_requested(const struct demand_scene *s, uint32_t page);
/** Fails the test unless the bit of a section is set exactly if a page of it is requested. */
void demand_check_sections(const struct demand_scene *s);

#endif /* TESTS_DEVICE_DEMAND_SCENE_H */
