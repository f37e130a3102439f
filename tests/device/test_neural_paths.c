/*
 * Compares the faster decode paths of neural.glsl and neural_matrix.glsl with
 * sluiceDecodeNeuralTexels: bit by bit if sums are exact, otherwise by a minimum PSNR. Prints a
 * table of errors per path and mip, also against other decoders and the originals. Names and skips
 * paths that the device does not list.
 */
#include "device/conform.h"

#include "base/checked.h"
#include "neural/decoded.h"
#include "neural/neural_files.h"
#include "neural_vulkan/cooperative.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/neural_paths.h>

#include "neural_fp8_comp.h"
#include "neural_half_comp.h"
#include "neural_matrix.h"
#include "neural_shared.h"
#include "neural_vector_fp8.h"
#include "neural_vector_int8.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXELS = 1 << 16, LATENT_SIZE = 1 << 20, WEIGHT_SIZE = 1 << 16, CHANNELS = 16 };
enum path { FP8, HALF, VECTOR_INT8, VECTOR_FP8, MATRIX, PATHS };

static const struct {
    const char *name;
    SluiceNeuralWeightKind reference; ///< weights of the host's decode
    double least;                     ///< minimum dB to the host's decode; 0: equal bits
    uint32_t schema;                  ///< 0: all
} paths[PATHS] = {
    [FP8] = {"fp8", SLUICE_NEURAL_WEIGHTS_FP8, 0, 0},
    [HALF] = {"half", SLUICE_NEURAL_WEIGHTS_FP8, 30, 0},
    [VECTOR_INT8] = {"vector int8", SLUICE_NEURAL_WEIGHTS_INT8, 0, 3},
    [VECTOR_FP8] = {"vector fp8", SLUICE_NEURAL_WEIGHTS_FP8, 30, 3},
    [MATRIX] = {"matrix int8", SLUICE_NEURAL_WEIGHTS_INT8, 0, 0},
};

struct rig {
    struct harness *h;
    SluiceNeuralPaths there;
    SluiceNeuralPathFeatures features;
    struct harness_buffer sets, latents, weights, outputs;
    struct conform_set set;
    VkPipeline pipelines[PATHS]; ///< pipelines of supported paths
};

static void prepare(struct harness *h, VkDeviceCreateInfo *info,
                    VkPhysicalDeviceVulkan12Features *vulkan12, void *user)
{
    struct rig *rig = user;
    rig->there = (SluiceNeuralPaths){.structSize = sizeof rig->there};
    CHECK_OK(sluiceGetNeuralPaths(h->instance, h->physical_device, h->get, NULL, &rig->there));
    CHECK_OK(sluiceRequireNeuralPaths(&rig->there, vulkan12->pNext, vulkan12, &rig->features));
    vulkan12->pNext = rig->features.pNext;
    info->enabledExtensionCount = rig->features.extensionCount;
    info->ppEnabledExtensionNames = rig->features.extensions;
}

static void add_path(struct rig *rig, enum path path, const uint32_t *code, size_t size)
{
    const SluiceNeuralPaths *there = &rig->there;
    const VkSpecializationMapEntry entries[] = {{0, 0, 4}, {1, 4, 4}, {2, 8, 4}};
    const uint32_t shape[] = {there->matrixM, there->matrixN, there->matrixK};
    const VkSpecializationInfo constants = {3, entries, sizeof shape, shape};
    VkShaderModule module = conform_module(rig->h, code, size);
    rig->pipelines[path] =
        path == MATRIX ? conform_subgroup_pipeline(rig->h, rig->set.layout, module, &constants)
                       : conform_compute_pipeline(rig->h, rig->set.layout, module, NULL);
}

static void rig_init(struct rig *rig)
{
    struct harness *h = rig->h;
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    harness_buffer_init(h, &rig->sets, sizeof(SluiceNeuralConstants), storage);
    harness_buffer_init(h, &rig->latents, LATENT_SIZE, storage);
    harness_buffer_init(h, &rig->weights, WEIGHT_SIZE, storage);
    harness_buffer_init(h, &rig->outputs, TEXELS * sizeof(struct NeuralOutput), storage);
    conform_create_set(h, 4, 0, sizeof(struct NeuralParams), &rig->set);
    conform_write_buffers(h, &rig->set, 4,
                          (const struct harness_buffer *const[]){&rig->sets, &rig->latents,
                                                                 &rig->weights, &rig->outputs});
    add_path(rig, FP8, neural_fp8_comp, sizeof neural_fp8_comp);
    if (rig->there.half)
        add_path(rig, HALF, neural_half_comp, sizeof neural_half_comp);
    if (rig->there.vectorInt8)
        add_path(rig, VECTOR_INT8, neural_vector_int8, sizeof neural_vector_int8);
    if (rig->there.vectorFp8)
        add_path(rig, VECTOR_FP8, neural_vector_fp8, sizeof neural_vector_fp8);
    if (rig->there.matrix)
        add_path(rig, MATRIX, neural_matrix, sizeof neural_matrix);
    for (uint32_t p = 0; p < PATHS; p++)
        if (!rig->pipelines[p])
            print_message("# %s: the device does not list it\n", paths[p].name);
    assert_int_equal(rig->there.vectorInt8,
                     (rig->there.vectorStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0);
    if (rig->there.vectorInt8)
        print_message("# vectors in stages 0x%x\n", rig->there.vectorStages);
    if (rig->pipelines[MATRIX])
        print_message("# matrices of %u x %u x %u\n", rig->there.matrixM, rig->there.matrixN,
                      rig->there.matrixK);
}

static void rig_finish(struct rig *rig)
{
    for (uint32_t i = 0; i < PATHS; i++)
        rig->h->DestroyPipeline(rig->h->device, rig->pipelines[i], NULL);
    conform_destroy_set(rig->h, &rig->set);
    harness_buffer_finish(rig->h, &rig->sets);
    harness_buffer_finish(rig->h, &rig->latents);
    harness_buffer_finish(rig->h, &rig->weights);
    harness_buffer_finish(rig->h, &rig->outputs);
}

/* Uploads weights in the layout of a path's shader. */
static void upload_weights(struct rig *rig, enum path path, const SluiceNeuralSet *set,
                           const struct decodable *d)
{
    uint64_t size = WEIGHT_SIZE;
    memset(rig->weights.mapped, 0xEE, WEIGHT_SIZE);
    if (path == VECTOR_INT8 || path == VECTOR_FP8) {
        SluiceNeuralConvertInfo info = {.structSize = sizeof info,
                                        .device = rig->h->device,
                                        .pfnGetDeviceProcAddr = rig->h->GetDeviceProcAddr,
                                        .pConstants = &d->constants,
                                        .weightKind = d->kind,
                                        .pWeights = d->weights,
                                        .weightSize = d->weight_size};
        CHECK_OK(sluiceConvertNeuralWeights(&info, &size, rig->weights.mapped));
        return;
    }
    CHECK_OK(sluiceGetNeuralWeights(set, path == HALF ? SLUICE_NEURAL_WEIGHTS_HALF : d->kind, NULL,
                                    &size, rig->weights.mapped));
}

static const struct NeuralOutput *run(struct rig *rig, enum path path, uint32_t mip, uint32_t width,
                                      uint32_t height)
{
    struct NeuralParams params = {.mip = mip, .width = width, .height = height};
    assert_true(width * height <= TEXELS);
    memset(rig->outputs.mapped, 0xEE, width * height * sizeof(struct NeuralOutput));
    conform_run_job(rig->h, &(struct conform_job){.set = &rig->set,
                                                  .stage = CONFORM_STAGE_COMPUTE,
                                                  .pipeline = rig->pipelines[path],
                                                  .count = width * height,
                                                  .push = &params,
                                                  .push_size = sizeof params});
    return rig->outputs.mapped;
}

/* Returns the dB to the floats of NAME.KIND.mipNN.f32. NaN: there is no such file. */
static double psnr_to_file(const char *name, const char *kind, uint32_t mip, const float *texels,
                           size_t count)
{
    char file[128], path[512];
    size_t size;
    snprintf(file, sizeof file, "%s.%s.mip%02u.f32", name, kind, mip);
    if (!find_neural_sample(file, path, sizeof path))
        return NAN;
    uint8_t *bytes = read_neural_file(path, &size);
    assert_int_equal(size, count * sizeof *texels);
    double psnr = psnr_of(texels, (const float *)(const void *)bytes, count);
    free(bytes);
    return psnr;
}

/* Compares one mip by one path. Channels without a texture hold garbage, and must have equal bits,
 * too. */
static void compare(struct rig *rig, enum path path, const char *name, const struct decodable *d,
                    uint32_t mip)
{
    uint32_t width = slc_mip_size(d->constants.width, mip), channels = d->constants.channelCount;
    uint32_t height = slc_mip_size(d->constants.height, mip);
    size_t count = (size_t)width * height * channels;
    float *expected = malloc(count * sizeof *expected), *got = malloc(count * sizeof *got);
    assert_true(expected && got);
    CHECK_OK(decode_rectangle(d, mip, 0, 0, width, height, expected));
    const struct NeuralOutput *out = run(rig, path, mip, width, height);
    size_t differ = 0;
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(out[i / channels].resident, 1);
        got[i] = out[i / channels].channels[i % channels];
        differ += memcmp(&got[i], &expected[i], sizeof got[i]) != 0;
    }
    double psnr = psnr_of(got, expected, count);
    const char *kind = paths[path].reference ? "fp8" : "int8";
    print_message("# | %s | %s | %u | %.1f%% | %.2f | %.2f | %.2f |\n", name, paths[path].name, mip,
                  100.0 * (double)differ / (double)count, psnr,
                  psnr_to_file(name, kind, mip, got, count),
                  psnr_to_file(name, "ref", mip, got, count));
    assert_true(paths[path].least > 0 ? psnr >= paths[path].least : differ == 0);
    free(expected);
    free(got);
}

static void compare_file(struct rig *rig, const char *name)
{
    char file[64], path[512];
    snprintf(file, sizeof file, "%s.ntc", name);
    if (!find_neural_sample(file, path, sizeof path))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    SluiceNeuralSet *set = open_neural_sample(path);
    print_message("# | file | path | mip | differ from C | dB to C | to LibNTC | to original |\n");
    for (uint32_t p = 0; p < PATHS; p++) {
        struct decodable d;
        read_decodable(set, NULL, paths[p].reference, &d);
        assert_true(d.latent_size <= LATENT_SIZE);
        if (rig->pipelines[p] && (!paths[p].schema || paths[p].schema == d.constants.schema)) {
            memcpy(rig->sets.mapped, &d.constants, sizeof d.constants);
            memcpy(rig->latents.mapped, d.latents, (size_t)d.latent_size);
            upload_weights(rig, (enum path)p, set, &d);
            for (uint32_t mip = 0; mip < d.constants.mipCount; mip++)
                compare(rig, (enum path)p, name, &d, mip);
        }
        free_decodable(&d);
    }
    sluiceDestroyNeuralSet(set);
}

static void texels_of_schema_3_are_those_of_the_host(void **state)
{
    compare_file(*state, "v9_64_g");
}

static void texels_of_schema_1_are_those_of_the_host(void **state)
{
    compare_file(*state, "v7_64_g");
}

static void every_refused_allocation_is_survived(void **state)
{
    const struct rig *rig = *state;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint64_t allowed = 0;
    for (; result != SLUICE_SUCCESS; allowed++) {
        struct failing_allocator allocator;
        SluiceNeuralPaths found = {.structSize = sizeof found};
        failing_allocator_init(&allocator, allowed);
        result = sluiceGetNeuralPaths(rig->h->instance, rig->h->physical_device, rig->h->get,
                                      &allocator.callbacks, &found);
        if (result != SLUICE_SUCCESS) {
            assert_int_equal(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_false(found.half);
        } else {
            assert_memory_equal(&found, &rig->there, sizeof found);
        }
        assert_int_equal(allocator.live_count, 0);
    }
    assert_true(allowed > 1);
}

/* A driver whose layout is the source with all bits inverted, followed by three bytes. */
static VKAPI_ATTR VkResult VKAPI_CALL fake_convert(VkDevice device,
                                                   const struct slc_convert_info *info)
{
    size_t size = info->srcSize;
    assert_non_null(device);
    assert_int_equal(size, info->numRows * info->numColumns);
    assert_int_equal(info->srcStride, info->numColumns);
    assert_int_equal(info->srcComponentType, info->dstComponentType);
    for (size_t i = 0; info->dstData.hostAddress && i < size; i++)
        ((uint8_t *)info->dstData.hostAddress)[i] =
            (uint8_t) ~((const uint8_t *)info->srcData.hostAddress)[i];
    *info->pDstSize = size + 3;
    return VK_SUCCESS;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fake_get(VkDevice device, const char *name)
{
    (void)device;
    return strcmp(name, "vkConvertCooperativeVectorMatrixNV") == 0
               ? (PFN_vkVoidFunction)fake_convert
               : NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_nothing(VkDevice device, const char *name)
{
    (void)device, (void)name;
    return NULL;
}

static void layers_are_converted_one_by_one(void **state)
{
    const struct rig *rig = *state;
    const SluiceNeuralConstants constants = {.schema = 3, .inputCount = 48};
    static const uint32_t sizes[] = {48 * 64, 64 * 48, 48 * 32, 32 * 16};
    uint8_t weights[9472], made[16384];
    uint32_t offsets[4];
    uint64_t size = 0, again, read = 0;
    for (size_t i = 0; i < sizeof weights; i++)
        weights[i] = (uint8_t)(i * 7 + i / 256);
    SluiceNeuralConvertInfo info = {.structSize = sizeof info,
                                    .device = rig->h->device,
                                    .pfnGetDeviceProcAddr = fake_get,
                                    .pConstants = &constants,
                                    .pWeights = weights,
                                    .weightSize = sizeof weights};
    CHECK_OK(sluiceConvertNeuralWeights(&info, &size, NULL));
    assert_true(size <= sizeof made && size % 64 == 0);
    again = size - 1;
    CHECK_RESULT(sluiceConvertNeuralWeights(&info, &again, made), SLUICE_ERROR_SIZE_MISMATCH);
    assert_int_equal(again, size);
    CHECK_OK(sluiceConvertNeuralWeights(&info, &again, made));
    memcpy(offsets, made, sizeof offsets);
    for (int layer = 0; layer < 4; layer++) {
        assert_int_equal(offsets[layer] % 64, 0);
        for (uint32_t i = 0; i < sizes[layer]; i++)
            assert_int_equal(made[offsets[layer] + i], (uint8_t)~weights[read + i]);
        read += sizes[layer];
    }
    assert_memory_equal(made + 64, weights + read, sizeof weights - read); /* scales and biases */
    info.weightSize--;
    CHECK_RESULT(sluiceConvertNeuralWeights(&info, &size, NULL), SLUICE_ERROR_INVALID_ARGUMENT);
    info.weightSize++;
    info.pfnGetDeviceProcAddr = get_nothing;
    CHECK_RESULT(sluiceConvertNeuralWeights(&info, &size, NULL), SLUICE_ERROR_UNSUPPORTED);
}

int main(void)
{
    struct harness h;
    struct rig rig = {.h = &h};
    /* first version whose SPIR-V validation supports cooperative vectors */
    const struct harness_newer newer = {prepare, &rig, VK_MAKE_API_VERSION(0, 1, 4, 309)};
    int status = harness_init_newer(&h, &newer);
    if (status)
        return status;
    rig_init(&rig);
    struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_of_schema_3_are_those_of_the_host),
        cmocka_unit_test(texels_of_schema_1_are_those_of_the_host),
        cmocka_unit_test(every_refused_allocation_is_survived),
        cmocka_unit_test(layers_are_converted_one_by_one),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &rig;
    status = RUN_TESTS(tests);
    rig_finish(&rig);
    return harness_finish(&h, status);
}
