/*
 * Measures a screen of decoded texels: a material of eight channels with one decode per pixel, and
 * the same material as trilinear textures in the same run.
 */
#include "commands.h"
#include "material.h"
#include "stopwatch.h"
#include "tiles.h"

#include "../../tools/common/shared_options.h"
#include "../manager/figures.h"

#include "neural_bench_shared.h"

#include "neural_bench_comp.h"
#include "neural_bench_dot_comp.h"
#include "neural_bench_fp8_comp.h"
#include "neural_bench_half_comp.h"
#include "neural_bench_half_uniform_comp.h"
#include "neural_bench_matrix.h"
#include "neural_bench_schema1_comp.h"
#include "neural_bench_schema1_dot_comp.h"
#include "neural_bench_schema1_dot_uniform_comp.h"
#include "neural_bench_schema1_uniform_comp.h"
#include "neural_bench_schema3_comp.h"
#include "neural_bench_schema3_dot_comp.h"
#include "neural_bench_schema3_dot_unhinted_comp.h"
#include "neural_bench_schema3_dot_uniform_comp.h"
#include "neural_bench_schema3_uniform_comp.h"
#include "neural_bench_textures_comp.h"
#include "neural_bench_vector_fp8.h"
#include "neural_bench_vector_int8.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BINDINGS = 7 };
enum textures { RGBA8, BC7 };

enum needs { NOTHING, DOT, HALF_FLOATS, VECTORS, MATRICES };

/* clang-format off */
#define CODE(name) name, sizeof name
static const struct path {
    const char *name;
    const uint32_t *words;
    size_t size;
    uint32_t schema; ///< 0: any
    enum needs needs;
    enum textures textures;
    enum weights weights;
} paths[] = {
    {"rgba8", CODE(neural_bench_textures_comp), 0, NOTHING, RGBA8, INT8},
    {"bc7", CODE(neural_bench_textures_comp), 0, NOTHING, BC7, INT8},
    {"int8", CODE(neural_bench_comp), 0, NOTHING, RGBA8, INT8},
    {"int8_dot", CODE(neural_bench_dot_comp), 0, DOT, RGBA8, INT8},
    {"int8_schema", CODE(neural_bench_schema1_comp), 1, NOTHING, RGBA8, INT8},
    {"int8_schema", CODE(neural_bench_schema3_comp), 3, NOTHING, RGBA8, INT8},
    {"int8_schema_dot", CODE(neural_bench_schema1_dot_comp), 1, DOT, RGBA8, INT8},
    {"int8_schema_dot", CODE(neural_bench_schema3_dot_comp), 3, DOT, RGBA8, INT8},
    {"int8_schema_dot_unhinted", CODE(neural_bench_schema3_dot_unhinted_comp), 3, DOT, RGBA8, INT8},
    {"int8_schema_uniform", CODE(neural_bench_schema1_uniform_comp), 1, NOTHING, RGBA8, INT8},
    {"int8_schema_uniform", CODE(neural_bench_schema3_uniform_comp), 3, NOTHING, RGBA8, INT8},
    {"int8_schema_dot_uniform", CODE(neural_bench_schema1_dot_uniform_comp), 1, DOT, RGBA8, INT8},
    {"int8_schema_dot_uniform", CODE(neural_bench_schema3_dot_uniform_comp), 3, DOT, RGBA8, INT8},
    {"fp8_schema", CODE(neural_bench_fp8_comp), 3, NOTHING, RGBA8, FP8},
    {"half_schema", CODE(neural_bench_half_comp), 3, HALF_FLOATS, RGBA8, HALF},
    {"half_schema_uniform", CODE(neural_bench_half_uniform_comp), 3, HALF_FLOATS, RGBA8, HALF},
    {"vector_int8", CODE(neural_bench_vector_int8), 3, VECTORS, RGBA8, VECTOR_INT8},
    {"vector_fp8", CODE(neural_bench_vector_fp8), 3, VECTORS, RGBA8, VECTOR_FP8},
    {"matrix_int8", CODE(neural_bench_matrix), 3, MATRICES, RGBA8, INT8},
};
/* clang-format on */
#define PATH_COUNT (sizeof paths / sizeof *paths)

struct bench {
    struct gpu gpu;
    struct material material;
    uint32_t size[2], repeats;
    double lod;
    bool all; ///< paths also on software devices
    struct gpu_buffer picture;
    VkSampler sampler;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet sets[2][WEIGHTS]; ///< by textures and weights
    struct stopwatch stopwatch;
    VkPipeline pipelines[PATH_COUNT];
    struct samples samples[PATH_COUNT];
};

static VkDescriptorType binding_type(uint32_t binding)
{
    return binding < 4    ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
           : binding == 4 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                          : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

static bool create_layout(struct bench *b)
{
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){i, binding_type(i), 1,
                                                     VK_SHADER_STAGE_COMPUTE_BIT, NULL};
    VkDescriptorSetLayoutCreateInfo set = {.sType =
                                               VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                           .bindingCount = BINDINGS,
                                           .pBindings = bindings};
    VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct NeuralBenchParams)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &b->set_layout,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    VkSamplerCreateInfo sampler = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                   .magFilter = VK_FILTER_LINEAR,
                                   .minFilter = VK_FILTER_LINEAR,
                                   .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                   .maxLod = VK_LOD_CLAMP_NONE};
    VkDevice device = b->gpu.device;
    return gpu_check(vkCreateDescriptorSetLayout(device, &set, NULL, &b->set_layout),
                     "vkCreateDescriptorSetLayout") &&
           gpu_check(vkCreatePipelineLayout(device, &layout, NULL, &b->layout),
                     "vkCreatePipelineLayout") &&
           gpu_check(vkCreateSampler(device, &sampler, NULL, &b->sampler), "vkCreateSampler");
}

static const struct gpu_buffer *set_buffer(const struct bench *b, uint32_t binding,
                                           enum weights weights)
{
    return binding == 0   ? &b->picture
           : binding < 3  ? &b->material.buffers[binding - 1]
           : binding == 3 ? &b->material.storage[weights]
                          : &b->material.uniform[weights];
}

static void write_set(struct bench *b, enum textures textures, enum weights weights)
{
    const struct gpu_image *images = textures == BC7 ? b->material.bc7 : b->material.rgba8;
    VkDescriptorBufferInfo buffers[BINDINGS];
    VkDescriptorImageInfo views[BINDINGS];
    VkWriteDescriptorSet writes[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; i++) {
        writes[i] = (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                           .dstSet = b->sets[textures][weights],
                                           .dstBinding = i,
                                           .descriptorCount = 1,
                                           .descriptorType = binding_type(i)};
        if (i < 5) {
            buffers[i] =
                (VkDescriptorBufferInfo){set_buffer(b, i, weights)->buffer, 0, VK_WHOLE_SIZE};
            writes[i].pBufferInfo = &buffers[i];
        } else {
            views[i] = (VkDescriptorImageInfo){b->sampler, images[i - 5].view,
                                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
            writes[i].pImageInfo = &views[i];
        }
    }
    vkUpdateDescriptorSets(b->gpu.device, BINDINGS, writes, 0, NULL);
}

static bool create_sets(struct bench *b)
{
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8 * WEIGHTS},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2 * WEIGHTS},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4 * WEIGHTS}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 2 * WEIGHTS,
                                       .poolSizeCount = 3,
                                       .pPoolSizes = sizes};
    if (!gpu_check(vkCreateDescriptorPool(b->gpu.device, &pool, NULL, &b->pool),
                   "vkCreateDescriptorPool"))
        return false;
    VkDescriptorSetLayout layouts[2 * WEIGHTS];
    for (uint32_t i = 0; i < 2 * WEIGHTS; i++)
        layouts[i] = b->set_layout;
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = b->pool,
                                        .descriptorSetCount = 2 * WEIGHTS,
                                        .pSetLayouts = layouts};
    if (!gpu_check(vkAllocateDescriptorSets(b->gpu.device, &info, b->sets[0]),
                   "vkAllocateDescriptorSets"))
        return false;
    for (int i = 0; i < WEIGHTS; i++)
        if (b->material.storage[i].buffer) {
            write_set(b, RGBA8, (enum weights)i);
            if (b->material.bc7[0].view)
                write_set(b, BC7, (enum weights)i);
        }
    return true;
}

static bool is_there(const SluiceNeuralPaths *paths_there, enum needs needs)
{
    switch (needs) {
    case NOTHING: return true;
    case DOT: return paths_there->integerDot;
    case HALF_FLOATS: return paths_there->half;
    case VECTORS: return paths_there->vectorInt8 || paths_there->vectorFp8;
    case MATRICES: return paths_there->matrix;
    }
    return false;
}

/* Compilers of software devices take many seconds for each decoder. */
static bool is_measured(const struct bench *b, const struct path *path)
{
    bool is_special = path->needs != NOTHING || path->schema != 0;
    if (path->textures == BC7 && !b->material.bc7[0].view)
        return false;
    return !(is_special && b->stopwatch.wall && !b->all) && is_there(&b->gpu.neural, path->needs) &&
           b->material.storage[path->weights].buffer &&
           (path->schema == 0 || path->schema == b->material.constants.schema);
}

static bool create_pipeline(struct bench *b, const struct path *path, VkPipeline *pipeline)
{
    const SluiceNeuralPaths *there = &b->gpu.neural;
    const VkSpecializationMapEntry entries[] = {{0, 0, 4}, {1, 4, 4}, {2, 8, 4}};
    const uint32_t shape[] = {there->matrixM, there->matrixN, there->matrixK};
    const VkSpecializationInfo constants = {3, entries, sizeof shape, shape};
    if (path->needs == MATRICES)
        return gpu_create_subgroup_pipeline(&b->gpu, b->layout, path->words, path->size, &constants,
                                            pipeline);
    return gpu_create_compute_pipeline(&b->gpu, b->layout, path->words, path->size, NULL, pipeline);
}

static bool create_pipelines(struct bench *b)
{
    for (size_t i = 0; i < PATH_COUNT; i++) {
        samples_init(&b->samples[i], b->repeats);
        if (is_measured(b, &paths[i]) && !create_pipeline(b, &paths[i], &b->pipelines[i]))
            return false;
    }
    return true;
}

static void record(const struct bench *b, VkCommandBuffer commands, size_t i, uint32_t frame)
{
    const SluiceNeuralConstants *k = &b->material.constants;
    float texels = (float)exp2(b->lod);
    struct NeuralBenchParams params = {
        .width = b->size[0],
        .height = b->size[1],
        .frame = frame,
        .lod = (float)b->lod,
        .uvPerPixel = {texels / (float)k->width, texels / (float)k->height},
        .textureSize = {k->width, k->height}};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, b->pipelines[i]);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, b->layout, 0, 1,
                            &b->sets[paths[i].textures][paths[i].weights], 0, NULL);
    vkCmdPushConstants(commands, b->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof params, &params);
    stopwatch_start(&b->stopwatch, commands);
    vkCmdDispatch(commands, (b->size[0] + 7) / 8, (b->size[1] + 7) / 8, 1);
    stopwatch_stop(&b->stopwatch, commands);
}

static bool measure_path(struct bench *b, size_t i, uint32_t frame)
{
    VkCommandBuffer commands;
    double seconds;
    if (!commands_begin(&b->gpu, &commands))
        return false;
    record(b, commands, i, frame);
    if (!stopwatch_run(&b->stopwatch, &b->gpu, commands, &seconds))
        return false;
    if (frame > 0) /* the first one compiles and warms up */
        samples_add(&b->samples[i], seconds * 1e9);
    return true;
}

/* Measures the paths in turns, so that all run at the same clock of the device. */
static bool measure(struct bench *b)
{
    for (uint32_t frame = 0; frame <= b->repeats; frame++)
        for (size_t i = 0; i < PATH_COUNT; i++)
            if (b->pipelines[i] && !measure_path(b, i, frame))
                return false;
    return true;
}

static void report(struct bench *b)
{
    double pixels = (double)b->size[0] * b->size[1];
    figure("neural", "schema", b->material.constants.schema, "");
    figure("neural", "latents", (double)b->material.latent_size, "bytes");
    figure("neural", "weights", (double)b->material.weight_size, "bytes");
    figure("neural", "rgba8.size", (double)b->material.rgba8_size, "bytes");
    if (b->material.bc7[0].view)
        figure("neural", "bc7.size", (double)b->material.bc7_size, "bytes");
    for (size_t i = 0; i < PATH_COUNT; i++) {
        char name[64];
        if (!b->pipelines[i])
            continue;
        double ns = samples_quantile(&b->samples[i], 0.5);
        snprintf(name, sizeof name, "%s.time", paths[i].name);
        figure("neural", name, ns * 1e-6, "ms");
        snprintf(name, sizeof name, "%s.rate", paths[i].name);
        figure("neural", name, pixels / ns, "Gpixel/s");
    }
}

static void destroy(struct bench *b)
{
    VkDevice device = b->gpu.device;
    for (size_t i = 0; i < PATH_COUNT; i++) {
        vkDestroyPipeline(device, b->pipelines[i], NULL);
        samples_finish(&b->samples[i]);
    }
    stopwatch_destroy(&b->gpu, &b->stopwatch);
    vkDestroyDescriptorPool(device, b->pool, NULL);
    vkDestroySampler(device, b->sampler, NULL);
    vkDestroyPipelineLayout(device, b->layout, NULL);
    vkDestroyDescriptorSetLayout(device, b->set_layout, NULL);
    material_destroy(&b->material, &b->gpu);
    gpu_destroy_buffer(&b->gpu, &b->picture);
    gpu_destroy(&b->gpu);
}

struct arguments {
    const char *device, *file;
    uint32_t texture_size;
    bool json, list, validation;
};

static int run(struct bench *b, const struct arguments *a)
{
    struct gpu_request request = {
        .device = a->device,
        .validation = a->validation,
        .neural = true,
        .modes = {SLUICE_RESIDENCY_MODE_DENSE, SLUICE_RESIDENCY_MODE_DENSE}};
    bool unsupported;
    if (!gpu_create(&request, &b->gpu, &unsupported))
        return unsupported ? 77 : 1;
    const SluiceVulkanDeviceCapabilities *caps = &b->gpu.capabilities;
    bool wall = caps->deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU || !(caps->timestampPeriod > 0);
    fprintf(stderr, "%s, %s %s%s\n", caps->deviceName, caps->driverName, caps->driverInfo,
            wall ? ", wall time" : "");
    bool done = stopwatch_create(&b->gpu, wall, &b->stopwatch) &&
                gpu_create_device_buffer(&b->gpu, (VkDeviceSize)b->size[0] * b->size[1] * 8,
                                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &b->picture) &&
                material_create(&b->material, &b->gpu, a->file, a->texture_size) &&
                create_layout(b) && create_sets(b) && create_pipelines(b) && measure(b);
    if (done)
        report(b);
    done = done && material_time_host(&b->material) &&
           tiles_measure(&b->gpu, &b->material, &b->stopwatch, b->repeats);
    done = done && atomic_load(&b->gpu.validation_messages) == 0;
    destroy(b);
    return done ? 0 : 1;
}

int main(int argc, char **argv)
{
    static struct bench b = {.repeats = 50, .lod = 0.5};
    struct arguments a = {0};
    const struct option rows[] = {
        {OPTION_WORD, .operand = "FILE.ntc", .value = &a.file,
         .help = "a set of at least eight channels; default: random numbers"},
        option_device(&a.device),
        {OPTION_EXTENT, "size", "WxH", "3840x2160", b.size, "of the screen in pixels", 1, 16384},
        {OPTION_UINT, "texture-size", "N", "1024", &a.texture_size,
         "width and height of a set of random numbers in texels", 64, 8192},
        {OPTION_UINT, "screens", "N", "50", &b.repeats, "screens of each path", 1, 10000},
        {OPTION_REAL, "lod", "X", "0.5", &b.lod, "level of detail of all pixels", -4, 8},
        {OPTION_FLAG, "all", .value = &b.all, .help = "all paths, also on a software device"},
        option_validation(&a.validation),
        option_json(&a.json),
        option_list_devices(&a.list),
    };
    const struct option_table table = {"neural_figures",
                                       "usage: neural_figures [options] [FILE.ntc]\n"
                                       "Measures decoding of neural textures; a figure per line.\n",
                                       NULL, rows, sizeof rows / sizeof *rows};
    switch (options_parse(&table, argc, argv)) {
    case OPTIONS_HELP: return 0;
    case OPTIONS_ERROR: return 2;
    case OPTIONS_RUN: break;
    }
    if (a.list)
        return gpu_list_devices() > 0 ? 0 : 77;
    options.json = a.json;
    return run(&b, &a);
}
