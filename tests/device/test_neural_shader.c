/*
 * Compares texels decoded by neural.glsl with sluiceDecodeNeuralTexels, bit by bit: sets of random
 * numbers of every network and latent shape, slices of them, and files.
 */
#include "device/conform.h"

#include "base/checked.h"
#include "neural/decoded.h"
#include "neural/neural_files.h"
#include "neural/worked_example.h"
#include "support/roll.h"
#include "support/test.h"

#include "neural_comp.h"
#include "neural_dot_comp.h"
#include "neural_hlsl.h"
#include "neural_schema1_comp.h"
#include "neural_schema3_comp.h"
#include "neural_shared.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TEXELS = 1 << 16, LATENT_SIZE = 1 << 22, WEIGHT_SIZE = 1 << 15, WEIGHT_ROOM = 17024 };
enum variant { ANY, HLSL, DOT, SCHEMA_1, SCHEMA_3, VARIANTS };

struct rig {
    struct harness *h;
    struct harness_buffer sets, latents, weights, outputs;
    struct conform_set set;
    VkPipeline pipelines[VARIANTS]; ///< some devices lack some
};

static bool has_dot; /* set once in main, before any test */

/* Creates the rig once for all tests, because pipelines take long to compile. */
static struct rig *rig_init(struct rig *rig)
{
    struct harness *h = rig->h;
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (rig->pipelines[ANY])
        return rig;
    harness_buffer_init(h, &rig->sets, 2 * sizeof(SluiceNeuralConstants), storage);
    harness_buffer_init(h, &rig->latents, LATENT_SIZE, storage);
    harness_buffer_init(h, &rig->weights, WEIGHT_SIZE, storage);
    harness_buffer_init(h, &rig->outputs, TEXELS * sizeof(struct NeuralOutput), storage);
    conform_create_set(h, 4, 0, sizeof(struct NeuralParams), &rig->set);
    conform_write_buffers(h, &rig->set, 4,
                          (const struct harness_buffer *const[]){&rig->sets, &rig->latents,
                                                                 &rig->weights, &rig->outputs});
    VkShaderModule modules[VARIANTS] = {[ANY] = conform_module(h, neural_comp, sizeof neural_comp),
                                        [HLSL] =
                                            conform_module(h, neural_hlsl, sizeof neural_hlsl)};
    if (has_dot)
        modules[DOT] = conform_module(h, neural_dot_comp, sizeof neural_dot_comp);
    if (!harness_is_software(h)) { /* lavapipe unrolls all loops, and compiles for seconds */
        modules[SCHEMA_1] = conform_module(h, neural_schema1_comp, sizeof neural_schema1_comp);
        modules[SCHEMA_3] = conform_module(h, neural_schema3_comp, sizeof neural_schema3_comp);
    }
    for (uint32_t i = 0; i < VARIANTS; i++)
        if (modules[i])
            rig->pipelines[i] = conform_compute_pipeline(h, rig->set.layout, modules[i], NULL);
    return rig;
}

static void rig_finish(struct rig *rig)
{
    for (uint32_t i = 0; i < VARIANTS; i++)
        rig->h->DestroyPipeline(rig->h->device, rig->pipelines[i], NULL);
    conform_destroy_set(rig->h, &rig->set);
    harness_buffer_finish(rig->h, &rig->sets);
    harness_buffer_finish(rig->h, &rig->latents);
    harness_buffer_finish(rig->h, &rig->weights);
    harness_buffer_finish(rig->h, &rig->outputs);
}

static void upload(struct rig *rig, const struct decodable *d)
{
    assert_true(d->latent_size <= LATENT_SIZE && d->weight_size <= WEIGHT_SIZE);
    memset(rig->sets.mapped, 0xEE, sizeof d->constants); /* set 0 is another set */
    memcpy((uint8_t *)rig->sets.mapped + sizeof d->constants, &d->constants, sizeof d->constants);
    memcpy(rig->latents.mapped, d->latents, (size_t)d->latent_size);
    memcpy(rig->weights.mapped, d->weights, (size_t)d->weight_size);
}

static const struct NeuralOutput *decode(struct rig *rig, enum variant variant,
                                         struct NeuralParams params)
{
    assert_true(params.width * params.height <= TEXELS);
    params.set = 1;
    memset(rig->outputs.mapped, 0xEE, params.width * params.height * sizeof(struct NeuralOutput));
    conform_run_job(rig->h, &(struct conform_job){.set = &rig->set,
                                                  .stage = CONFORM_STAGE_COMPUTE,
                                                  .pipeline = rig->pipelines[variant],
                                                  .count = params.width * params.height,
                                                  .push = &params,
                                                  .push_size = sizeof params});
    return rig->outputs.mapped;
}

/* Compares all texels of a rectangle. Returns the number of resident ones. */
static uint32_t compare(struct rig *rig, const struct decodable *d, struct NeuralParams params)
{
    static float expected[TEXELS][16];
    static bool resident[TEXELS];
    uint32_t count = params.width * params.height, there = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t x = (uint32_t)params.x + i % params.width;
        uint32_t y = (uint32_t)params.y + i / params.width;
        SluiceNeuralDecodeInfo info = {.structSize = sizeof info,
                                       .pConstants = &d->constants,
                                       .pLatents = d->latents,
                                       .latentSize = d->latent_size,
                                       .pWeights = d->weights,
                                       .weightSize = d->weight_size,
                                       .mip = params.mip,
                                       .x = x,
                                       .y = y,
                                       .width = 1,
                                       .height = 1,
                                       .channelCount = 16,
                                       .pTexels = expected[i]};
        SluiceResult result = sluiceDecodeNeuralTexels(&info);
        assert_true(result == SLUICE_SUCCESS || result == SLUICE_NOT_READY);
        resident[i] = result == SLUICE_SUCCESS;
        there += resident[i];
        if (!resident[i])
            memset(expected[i], 0, sizeof expected[i]);
    }
    for (uint32_t v = 0; v < VARIANTS; v++) {
        if (!rig->pipelines[v] || (v == SCHEMA_1 && d->constants.schema == 3) ||
            (v == SCHEMA_3 && d->constants.schema == 1))
            continue;
        const struct NeuralOutput *out = decode(rig, (enum variant)v, params);
        for (uint32_t i = 0; i < count; i++)
            if (out[i].resident != resident[i] ||
                memcmp(out[i].channels, expected[i], sizeof expected[i]) != 0)
                fail_msg("variant %u, schema %u, %u inputs, mip %u, texel %u %u: %u %.9g %.9g, not "
                         "%u %.9g %.9g",
                         v, d->constants.schema, d->constants.inputCount, params.mip,
                         (uint32_t)params.x + i % params.width,
                         (uint32_t)params.y + i / params.width, out[i].resident,
                         (double)out[i].channels[0], (double)out[i].channels[1], resident[i],
                         (double)expected[i][0], (double)expected[i][1]);
        assert_int_equal(out[0].mipCount, d->constants.mipCount);
        assert_int_equal(out[0].size, slc_mip_size(d->constants.width, params.mip) |
                                          slc_mip_size(d->constants.height, params.mip) << 16);
    }
    return there;
}

static uint32_t pick(uint32_t from, uint32_t to)
{
    return from + (uint32_t)roll() % (to - from + 1);
}

/* Makes weights: bytes, then scales and biases that bring sums to about -3 to 3. */
static uint32_t make_weights(uint8_t *bytes, uint32_t schema, uint32_t inputs)
{
    const uint32_t ones[5] = {inputs, 64, 64, 64, 16}, threes[5] = {48, 64, 48, 32, 16};
    const uint32_t *sizes = schema == 1 ? ones : threes;
    uint32_t at = 0, outputs = 0;
    for (uint32_t i = 0; i < 4; i++) {
        for (uint32_t k = 0; k < sizes[i] * sizes[i + 1]; k++)
            bytes[at++] = (uint8_t)roll();
        outputs += sizes[i + 1];
    }
    for (uint32_t k = 0; k < outputs; k++, at += 4) {
        float scale = (float)pick(1, 1000) / (1000.0f * 16384.0f);
        memcpy(bytes + at, &scale, 4);
    }
    for (uint32_t k = 0; k < outputs; k++, at += 4) {
        int32_t bias = (int32_t)pick(0, 60000) - 30000;
        memcpy(bytes + at, &bias, 4);
    }
    return at;
}

/* Makes a slice of a grid; every second one is whole. */
static void make_slice(SluiceNeuralSlice *slice, uint32_t offset, bool whole, bool wraps)
{
    uint32_t width = pick(1, 40), height = pick(1, 40), w = whole ? width : pick(1, width);
    uint32_t h = whole ? height : pick(1, height), x = pick(0, wraps ? width - 1 : width - w);
    uint32_t y = pick(0, wraps ? height - 1 : height - h);
    *slice = (SluiceNeuralSlice){.dataOffset = offset,
                                 .gridSize = width | height << 16,
                                 .origin = whole ? 0 : x | y << 16,
                                 .sliceSize = w | h << 16};
}

static void make_set(struct decodable *d, uint32_t i)
{
    SluiceNeuralConstants *k = &d->constants;
    bool is_one = i % 2 == 0, whole = i % 4 < 2;
    *k = (SluiceNeuralConstants){.schema = is_one ? 1 : 3,
                                 .width = pick(1, 50),
                                 .height = pick(1, 50),
                                 .mipCount = 3,
                                 .channelCount = 16,
                                 .validChannels = 0xFFFF,
                                 .networkFeatures = is_one ? 4 * pick(1, 4) : 16,
                                 .highBits = is_one ? 1u << pick(0, 3) : 4,
                                 .lowFeatures = 4 * pick(1, 4),
                                 .lowBits = is_one ? 1u << pick(0, 3) : 4,
                                 .residentMipCount = 3};
    k->inputCount = is_one ? 32 + 4 * k->networkFeatures : 48;
    k->highFeatures = is_one ? 4 * pick(1, k->networkFeatures / 4) : k->lowFeatures;
    for (uint32_t s = 0; s < 16; s++)
        make_slice(&k->slices[s], 65536 * s + 4 * pick(0, 100), whole, !is_one);
    for (uint32_t m = 0; m < 16; m++)
        k->mips[m] = (SluiceNeuralMipConstants){.firstSlice = m,
                                                .lodCode = (int32_t)pick(0, 255) - 128,
                                                .positionScale =
                                                    m == 2 ? 0.1875f : (float)pick(1, 999) / 700};
    k->slices[15].sliceSize = 0;
    if (i % 8 == 7)
        k->mips[1].firstSlice = 14; /* its second slice is missing */
    d->latent_size = 1 << 21;
    for (uint32_t b = 0; b < d->latent_size; b++)
        d->latents[b] = (uint8_t)roll();
    d->weight_size = make_weights(d->weights, k->schema, k->inputCount);
}

static void sets_of_random_numbers_decode_to_the_same_bits(void **state)
{
    struct decodable d = {.latents = malloc(1 << 21), .weights = malloc(WEIGHT_ROOM)};
    uint32_t there = 0, count = 0;
    roll_seed(1);
    assert_true(d.latents && d.weights);
    struct rig *rig = rig_init(*state);
    for (uint32_t i = 0; i < 32; i++) {
        make_set(&d, i);
        upload(rig, &d);
        for (uint32_t mip = 0; mip < 3; mip++) {
            struct NeuralParams params = {.mip = mip,
                                          .width = slc_mip_size(d.constants.width, mip),
                                          .height = slc_mip_size(d.constants.height, mip)};
            there += compare(rig, &d, params);
            count += params.width * params.height;
        }
    }
    print_message("# %u of %u texels are resident%s\n", there, count,
                  has_dot ? ", also with integer dot products" : "");
    assert_true(there > count / 4 && there < count);
    free_decodable(&d);
}

static void texels_that_do_not_exist_are_not_there(void **state)
{
    struct decodable d = {.latents = malloc(1 << 21), .weights = malloc(WEIGHT_ROOM)};
    roll_seed(2);
    assert_true(d.latents && d.weights);
    struct rig *rig = rig_init(*state);
    make_set(&d, 0);
    upload(rig, &d);
    int32_t width = (int32_t)d.constants.width, height = (int32_t)d.constants.height;
    const struct NeuralParams params[] = {
        {.x = -1, .width = 1, .height = 1},    {.y = -1, .width = 1, .height = 1},
        {.x = width, .width = 1, .height = 1}, {.y = height, .width = 1, .height = 1},
        {.mip = 3, .width = 1, .height = 1},   {.mip = 1u << 31, .width = 1, .height = 1}};
    for (uint32_t i = 0; i < 6; i++) {
        const struct NeuralOutput *out = decode(rig, ANY, params[i]);
        assert_int_equal(out->resident, 0);
        for (uint32_t c = 0; c < 16; c++)
            assert_true(out->channels[c] == 0.0f);
    }
    free_decodable(&d);
}

static void compare_set(struct rig *rig, const SluiceNeuralSet *set)
{
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    struct decodable d;
    uint32_t texels = 0;
    CHECK_OK(sluiceGetNeuralSetInfo(set, &info));
    read_decodable(set, NULL, SLUICE_NEURAL_WEIGHTS_INT8, &d);
    upload(rig, &d);
    for (uint32_t mip = 0; mip < info.mipCount; mip++) {
        struct NeuralParams params = {.mip = mip,
                                      .width = slc_mip_size(info.width, mip),
                                      .height = slc_mip_size(info.height, mip)};
        texels += params.width * params.height;
        assert_int_equal(compare(rig, &d, params), params.width * params.height);
    }
    free_decodable(&d);
    for (uint32_t i = 0; i < 8 && info.width > 8; i++) { /* slices */
        SluiceNeuralRequest request = {.firstMip = i % 2, .mipCount = 2};
        uint32_t width = slc_mip_size(info.width, i % 2), height = slc_mip_size(info.height, i % 2);
        request.width = pick(1, 24);
        request.height = pick(1, 24);
        request.x = pick(0, width - request.width);
        request.y = pick(0, height - request.height);
        read_decodable(set, &request, SLUICE_NEURAL_WEIGHTS_INT8, &d);
        upload(rig, &d);
        struct NeuralParams params = {.mip = request.firstMip,
                                      .x = (int32_t)request.x,
                                      .y = (int32_t)request.y,
                                      .width = request.width,
                                      .height = request.height};
        assert_int_equal(compare(rig, &d, params), request.width * request.height);
        params.x = params.y = 0; /* mostly missing */
        params.width = slc_min_u32(width, 48);
        params.height = slc_min_u32(height, 48);
        compare(rig, &d, params);
        free_decodable(&d);
    }
    print_message("# schema %u, %u x %u: %u texels of %u mips\n", info.schema, info.width,
                  info.height, texels, info.mipCount);
}

static void the_worked_example_decodes_to_the_same_bits(void **state)
{
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    SluiceNeuralSet *set;
    roll_seed(3);
    struct rig *rig = rig_init(*state);
    CHECK_OK(open_neural_bytes(bytes, write_worked_example(bytes), NULL, &set));
    compare_set(rig, set);
    sluiceDestroyNeuralSet(set);
}

static void files_decode_to_the_same_bits(void **state)
{
    static const char *const names[] = {"v7_64_g.ntc", "v9_64_g.ntc", "v9_300x200.ntc"};
    char path[512];
    for (uint32_t i = 0; i < 3; i++)
        if (!find_neural_sample(names[i], path, sizeof path))
            SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    roll_seed(4);
    struct rig *rig = rig_init(*state);
    for (uint32_t i = 0; i < 3; i++) {
        assert_true(find_neural_sample(names[i], path, sizeof path));
        SluiceNeuralSet *set = open_neural_sample(path);
        compare_set(rig, set);
        sluiceDestroyNeuralSet(set);
    }
}

/* Converts the 16 channels of a texel that decodes to noise. */
static void channels_become_linear(void **state)
{
    struct decodable d = {.latents = malloc(1 << 21), .weights = malloc(WEIGHT_ROOM)};
    roll_seed(5);
    assert_true(d.latents && d.weights);
    struct rig *rig = rig_init(*state);
    make_set(&d, 0);
    upload(rig, &d);
    for (uint32_t space = SLUICE_NEURAL_COLOR_SRGB; space <= SLUICE_NEURAL_COLOR_HLG; space++) {
        struct NeuralParams params = {.width = d.constants.width, .height = d.constants.height};
        static struct NeuralOutput codes[TEXELS];
        uint32_t count = params.width * params.height;
        memcpy(codes, decode(rig, ANY, params), count * sizeof *codes);
        params.colorSpace = space;
        const struct NeuralOutput *out = decode(rig, ANY, params);
        for (uint32_t i = 0; i < count * 16; i++) {
            double code = (double)codes[i / 16].channels[i % 16];
            double linear = (double)sluiceConvertNeuralColor(
                (float)code, (SluiceNeuralColorSpace)space, SLUICE_NEURAL_COLOR_LINEAR);
            if (fabs(code) < 1.2)
                assert_true(fabs((double)out[i / 16].channels[i % 16] - linear) <=
                            2e-5 * fmax(1, fabs(linear)));
        }
    }
    free_decodable(&d);
}

static int init(struct harness *h)
{
    static const char *const extensions[] = {VK_KHR_SHADER_INTEGER_DOT_PRODUCT_EXTENSION_NAME};
    VkPhysicalDeviceShaderIntegerDotProductFeaturesKHR features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_INTEGER_DOT_PRODUCT_FEATURES_KHR,
        .shaderIntegerDotProduct = VK_TRUE};
    int status = harness_init_with(h, extensions, 1, &features);
    has_dot = status == 0;
    return status == 77 ? harness_init(h) : status;
}

int main(void)
{
    struct harness h;
    struct rig rig = {.h = &h};
    int status = init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_of_random_numbers_decode_to_the_same_bits),
        cmocka_unit_test(texels_that_do_not_exist_are_not_there),
        cmocka_unit_test(the_worked_example_decodes_to_the_same_bits),
        cmocka_unit_test(files_decode_to_the_same_bits),
        cmocka_unit_test(channels_become_linear),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &rig;
    status = RUN_TESTS(tests);
    if (rig.pipelines[ANY])
        rig_finish(&rig);
    return harness_finish(&h, status);
}
