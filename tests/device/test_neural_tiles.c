/* Tiles that the GPU decodes from neural sets, compared with the decoder in C. */
#include "device/scene.h"
#include "neural/decoded.h"
#include "neural/neural_files.h"

#include "base/checked.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/vulkan_control.h>
#include <sluice/vulkan_neural.h>

#include <math.h>
#include <stdlib.h>

#define SMALL "v9_64_g.ntc" /* mip tail only */
#define LARGE "v9_300x200.ntc"
#define OLD "v7_64_g.ntc" /* schema 1 */
#define TILE 128u         /* texels of LARGE along a side, in RGBA8 */

struct rig {
    struct scene scene;
    SluiceNeuralSet *set;
    SluiceNeuralSetInfo info;
    struct decodable decodable;
    SluiceVulkanNeuralDecoder *decoder;
    uint32_t texture;
    SluiceVulkanNeuralOutput output;
    bool hlg;      ///< true: values are codes of HLG, stored as linear values
    bool requests; ///< true: the application requests all tiles
    SluiceTextureRequestId request;
};

static SluiceVulkanNeuralDecoderCreateInfo decoder_info(const struct rig *rig,
                                                        SluiceVulkanContext *context)
{
    return (SluiceVulkanNeuralDecoderCreateInfo){.structSize =
                                                     sizeof(SluiceVulkanNeuralDecoderCreateInfo),
                                                 .context = context,
                                                 .pConstants = &rig->decodable.constants,
                                                 .pLatents = rig->decodable.latents,
                                                 .latentSize = rig->decodable.latent_size,
                                                 .pWeights = rig->decodable.weights,
                                                 .weightSize = rig->decodable.weight_size};
}

static void open_set(struct rig *rig, const char *sample)
{
    char path[512];
    *rig = (struct rig){.info = {.structSize = sizeof rig->info}};
    assert_true(find_neural_sample(sample, path, sizeof path));
    rig->set = open_neural_sample(path);
    CHECK_OK(sluiceGetNeuralSetInfo(rig->set, &rig->info));
    read_decodable(rig->set, NULL, SLUICE_NEURAL_WEIGHTS_INT8, &rig->decodable);
}

static void close_set(struct rig *rig)
{
    free_decodable(&rig->decodable);
    sluiceDestroyNeuralSet(rig->set);
}

/* Rigs with decoders that tests share, because pipelines take long to compile. */
static struct rig small_rig, large_rig;

static void rig_init(struct rig *rig, struct harness *h, const char *sample)
{
    if (rig->decoder)
        return;
    open_set(rig, sample);
    SluiceVulkanNeuralDecoderCreateInfo info = decoder_info(rig, h->context);
    info.scratchSize = 65536; /* a tile, or a few levels of the mip tail */
    CHECK_OK(sluiceCreateVulkanNeuralDecoder(&info, &rig->decoder));
}

/* Requests all tiles, without feedback from shaders. */
static void request_all(struct rig *rig)
{
    const SluiceVulkanTextureRequest all = {.structSize = sizeof all, .until = UINT64_MAX};
    CHECK_OK(sluiceRequestVulkanTexture(rig->scene.streamer,
                                        rig->scene.textures[rig->texture].texture.textureId, &all,
                                        &rig->request));
}

/* Shows a set. Values are stored as the network gives them. One corner of LARGE is visible. */
static void show(struct rig *rig, struct harness *h, SluiceFormat format, uint32_t first,
                 uint32_t count)
{
    static const struct scene_aim corner = {0.87, 0.65, 0.12, 0.34, 0, 1, 0, 0};
    const SluiceTileProducer *producer;
    scene_init(
        &rig->scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
    rig->output = (SluiceVulkanNeuralOutput){.structSize = sizeof rig->output,
                                             .format = format,
                                             .firstChannel = first,
                                             .channelCount = count};
    for (uint32_t c = 0; c < count && rig->hlg; c++)
        rig->output.from[c] = SLUICE_NEURAL_COLOR_HLG;
    CHECK_OK(sluiceAddVulkanNeuralOutput(rig->decoder, &rig->output, &producer));
    rig->texture = scene_add_produced(&rig->scene, producer);
    if (rig->requests)
        request_all(rig);
    else
        scene_aim(&rig->scene, rig->texture, 64, &corner);
    scene_settle(&rig->scene, 60);
}

/* Destroys the streamer, so the decoder is unused. */
static void hide(struct rig *rig)
{
    struct harness *h = rig->scene.h;
    scene_finish(&rig->scene);
    CHECK_OK(h->DeviceWaitIdle(h->device) == VK_SUCCESS ? SLUICE_SUCCESS : SLUICE_ERROR_VULKAN);
}

static void rig_finish(struct rig *rig)
{
    sluiceDestroyVulkanNeuralDecoder(rig->decoder);
    if (rig->set)
        close_set(rig);
}

struct fetch {
    struct rig *rig;
    uint32_t count, texel_count;
    const float *texels; ///< texels of the level
    uint32_t level;
    double squares, worst, largest;
};

static void record_fetch(void *user, VkCommandBuffer commands)
{
    struct fetch *f = user;
    struct scene *scene = &f->rig->scene;
    prober_record(&scene->prober, commands, scene->textures[f->rig->texture].probe, 0, f->count,
                  PROBE_FETCH);
}

static void flush(struct fetch *f)
{
    const struct rig *rig = f->rig;
    uint32_t width = slc_mip_size(rig->info.width, f->level);
    harness_run(rig->scene.h, record_fetch, f);
    for (uint32_t i = 0; i < f->count; i++) {
        const struct ProbeInput *in = &prober_inputs(&f->rig->scene.prober)[i];
        const float *color = prober_outputs(&rig->scene.prober)[i].color;
        size_t at = (size_t)in->uv[1] * width + (size_t)in->uv[0];
        for (uint32_t c = 0; c < rig->output.channelCount; c++) {
            float code = f->texels[at * rig->info.channelCount + rig->output.firstChannel + c];
            double v =
                (double)sluiceConvertNeuralColor(code, rig->output.from[c], rig->output.to[c]);
            /* 16-bit floats have 11 bits. */
            double d = rig->output.format == SLUICE_FORMAT_R16G16B16A16_SFLOAT
                           ? fabs(v - (double)color[c]) / fmax(fabs(v), 1e-3)
                           : fabs(fmin(fmax(v, 0), 1) - (double)color[c]);
            f->squares += d * d;
            f->worst = fmax(f->worst, d);
            f->largest = fmax(f->largest, (double)color[c]);
        }
        f->texel_count += rig->output.channelCount;
    }
    f->count = 0;
}

/* Compares the last tile of levels 0 and 1, and all levels from 2 on. */
static struct fetch compare(struct rig *rig)
{
    struct fetch f = {.rig = rig};
    for (f.level = 0; f.level < rig->info.mipCount; f.level++) {
        float *texels = decode_mip(rig->set, SLUICE_NEURAL_WEIGHTS_INT8, f.level);
        f.texels = texels;
        uint32_t width = slc_mip_size(rig->info.width, f.level);
        uint32_t height = slc_mip_size(rig->info.height, f.level);
        for (uint32_t y = height > TILE ? TILE : 0; y < height; y++)
            for (uint32_t x = width > TILE ? width / TILE * TILE : 0; x < width; x++) {
                prober_inputs(&rig->scene.prober)[f.count++] =
                    (struct ProbeInput){.uv = {(float)x, (float)y}, .lodBias = (float)f.level};
                if (f.count == PROBE_CAPACITY)
                    flush(&f);
            }
        flush(&f);
        free(texels);
    }
    return f;
}

static void texels_are_those_of_the_decoder_in_C(void **state)
{
    struct rig *rig = &large_rig;
    rig_init(rig, *state, LARGE);
    show(rig, *state, SLUICE_FORMAT_R8G8B8A8_UNORM, 1, 3);
    struct fetch f = compare(rig);
    if (!(f.texel_count > 30000 && f.worst <= 0.5 / 255 + 1e-6))
        fail_msg("%u values, the worst is off by %.9g", f.texel_count, f.worst);
    hide(rig);
}

static void texels_of_schema_1_are_those_of_the_decoder_in_C(void **state)
{
    struct rig rig = {.decoder = NULL};
    rig_init(&rig, *state, OLD);
    show(&rig, *state, SLUICE_FORMAT_R8G8B8A8_UNORM, 0, 4);
    struct fetch f = compare(&rig);
    if (!(f.texel_count > 16000 && f.worst <= 0.5 / 255 + 1e-6))
        fail_msg("%u values, the worst is off by %.9g", f.texel_count, f.worst);
    hide(&rig);
    rig_finish(&rig);
}

/* Treats the numbers of the sample as codes of HLG. */
static void codes_of_hlg_become_linear_floats(void **state)
{
    struct rig *rig = &small_rig;
    rig_init(rig, *state, SMALL);
    rig->hlg = true;
    show(rig, *state, SLUICE_FORMAT_R16G16B16A16_SFLOAT, 0, 4);
    struct fetch f = compare(rig);
    if (!(f.texel_count > 16000 && f.worst <= 1.0 / 1024 && f.largest > 2))
        fail_msg("%u values up to %g, the worst is off by %.9g of itself", f.texel_count, f.largest,
                 f.worst);
    hide(rig);
    rig->hlg = false;
}

/* Decodes on load, before anything is drawn. */
static void a_whole_texture_becomes_blocks_when_it_is_requested(void **state)
{
    struct rig *rig = &large_rig;
    SluiceVulkanRequestProgress progress = {.structSize = sizeof progress};
    rig_init(rig, *state, LARGE);
    rig->requests = true;
    show(rig, *state, SLUICE_FORMAT_BC7_UNORM_BLOCK, 0, 4);
    CHECK_OK(sluiceGetVulkanRequestProgress(rig->scene.streamer, rig->request, &progress));
    assert_true(progress.ready && progress.tileCount >= 2);
    struct fetch f = compare(rig);
    double psnr = -10 * log10(f.squares / f.texel_count);
    print_message("# %u tiles: %.2f dB\n", progress.tileCount, psnr);
    if (!(psnr >= 36))
        fail_msg("%.2f dB", psnr);
    hide(rig);
    rig->requests = false;
}

static void blocks_are_near_to_them(void **state)
{
    static const struct {
        SluiceFormat format;
        uint32_t channels;
        double least; ///< dB
    } formats[] = {{SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, 3, 35.0},
                   {SLUICE_FORMAT_BC4_UNORM_BLOCK, 1, 38.5},
                   {SLUICE_FORMAT_BC5_UNORM_BLOCK, 2, 40.5},
                   {SLUICE_FORMAT_BC7_UNORM_BLOCK, 4, 36.4}};
    struct rig *rig = &small_rig;
    rig_init(rig, *state, SMALL);
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        show(rig, *state, formats[i].format, 0, formats[i].channels);
        struct fetch f = compare(rig);
        double psnr = -10 * log10(f.squares / f.texel_count);
        print_message("# format %d: %.2f dB\n", (int)formats[i].format, psnr);
        if (!(psnr >= formats[i].least))
            fail_msg("format %d: %.2f dB", (int)formats[i].format, psnr);
        hide(rig);
    }
}

static void wrong_decoders_are_refused(void **state)
{
    struct harness *h = *state;
    struct rig rig;
    SluiceVulkanNeuralDecoder *decoder = NULL;
    open_set(&rig, SMALL);
    SluiceVulkanNeuralDecoderCreateInfo info = decoder_info(&rig, h->context), wrong;
    h->quiet = true;
    wrong = info;
    wrong.latentSize -= 4;
    CHECK_RESULT(sluiceCreateVulkanNeuralDecoder(&wrong, &decoder), SLUICE_ERROR_INVALID_ARGUMENT);
    wrong = info;
    wrong.weightSize -= 4;
    CHECK_RESULT(sluiceCreateVulkanNeuralDecoder(&wrong, &decoder), SLUICE_ERROR_INVALID_ARGUMENT);
    wrong = info;
    wrong.scratchSize = 4;
    CHECK_RESULT(sluiceCreateVulkanNeuralDecoder(&wrong, &decoder), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceNeuralConstants constants = rig.decodable.constants;
    wrong = info;
    wrong.pConstants = &constants;
    constants.mips[2].firstSlice = 15;
    CHECK_RESULT(sluiceCreateVulkanNeuralDecoder(&wrong, &decoder), SLUICE_ERROR_INVALID_ARGUMENT);
    constants = rig.decodable.constants;
    constants.residentMipCount--;
    CHECK_RESULT(sluiceCreateVulkanNeuralDecoder(&wrong, &decoder), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_null(decoder);
    h->quiet = false;
    close_set(&rig);
}

/* Constants that the decoder in C refuses. A shader would access memory outside the latents or
 * inputs. */
static void constants_that_contradict_themselves_are_refused(void **state)
{
    struct harness *h = *state;
    struct rig rig;
    SluiceVulkanNeuralDecoder *decoder = NULL;
    open_set(&rig, SMALL);
    enum { LATENTS = 1 << 20 };
    void *latents = calloc(1, LATENTS);
    assert_non_null(latents);
    h->quiet = true;
    for (int wrong = 0; wrong < 5; wrong++) {
        SluiceNeuralConstants constants = rig.decodable.constants;
        SluiceVulkanNeuralDecoderCreateInfo info = decoder_info(&rig, h->context);
        SluiceNeuralSlice *slice = &constants.slices[constants.mips[0].firstSlice];
        info.pConstants = &constants;
        info.pLatents = latents;
        info.latentSize = LATENTS;
        switch (wrong) {
        case 0: constants.networkFeatures = 8; break;
        case 1: constants.lowFeatures = constants.highFeatures == 4 ? 8 : 4; break;
        case 2: constants.highBits = constants.lowBits = 2; break;
        case 3: slice->gridSize = slice->sliceSize = 32769 | 1 << 16; break;
        default: slice->gridSize = slice->sliceSize = 1u | 40000u << 16;
        }
        SluiceResult result = sluiceCreateVulkanNeuralDecoder(&info, &decoder);
        if (result != SLUICE_ERROR_INVALID_ARGUMENT)
            fail_msg("%d: %s", wrong, sluiceGetResultName(result));
    }
    h->quiet = false;
    free(latents);
    close_set(&rig);
}

static void buffers_beyond_the_range_of_the_device_are_refused(void **state)
{
    struct harness *h = *state;
    struct rig rig;
    SluiceVulkanNeuralDecoder *decoder = NULL;
    VkPhysicalDeviceProperties properties;
    h->GetPhysicalDeviceProperties(h->physical_device, &properties);
    const uint32_t most = properties.limits.maxStorageBufferRange;
    if (most >= 256u << 20)
        SKIP_TEST("the largest scratch buffer is within the device's range");
    open_set(&rig, SMALL);
    SluiceVulkanNeuralDecoderCreateInfo info = decoder_info(&rig, h->context);
    info.scratchSize = most + 1ull;
    h->quiet = true;
    CHECK_RESULT(sluiceCreateVulkanNeuralDecoder(&info, &decoder), SLUICE_ERROR_LIMIT_EXCEEDED);
    h->quiet = false;
    close_set(&rig);
}

static void wrong_outputs_are_refused(void **state)
{
    struct harness *h = *state;
    struct rig *rig = &small_rig;
    const SluiceTileProducer *producer = NULL;
    rig_init(rig, h, SMALL);
    SluiceVulkanNeuralOutput output = {
        .structSize = sizeof output, .format = SLUICE_FORMAT_R16_SFLOAT, .channelCount = 1};
    h->quiet = true;
    CHECK_RESULT(sluiceAddVulkanNeuralOutput(rig->decoder, &output, &producer),
                 SLUICE_ERROR_UNSUPPORTED);
    output.format = SLUICE_FORMAT_BC5_UNORM_BLOCK;
    output.channelCount = 3;
    CHECK_RESULT(sluiceAddVulkanNeuralOutput(rig->decoder, &output, &producer),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    output.channelCount = 2;
    output.firstChannel = rig->info.channelCount - 1;
    CHECK_RESULT(sluiceAddVulkanNeuralOutput(rig->decoder, &output, &producer),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    output = (SluiceVulkanNeuralOutput){
        .structSize = sizeof output, .format = SLUICE_FORMAT_BC7_SRGB_BLOCK, .channelCount = 3};
    CHECK_RESULT(sluiceAddVulkanNeuralOutput(rig->decoder, &output, &producer),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_null(producer);
    h->quiet = false;
}

static void every_refused_allocation_is_survived(void **state)
{
    struct harness *h = *state;
    struct rig rig;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint32_t allowed = 0;
    open_set(&rig, SMALL);
    for (; result != SLUICE_SUCCESS; allowed++) {
        struct failing_allocator allocator;
        const SluiceTileProducer *producer = NULL;
        const SluiceVulkanNeuralOutput output = {.structSize = sizeof output,
                                                 .format = SLUICE_FORMAT_BC4_UNORM_BLOCK,
                                                 .channelCount = 1};
        SluiceVulkanNeuralDecoderCreateInfo info = decoder_info(&rig, h->context);
        failing_allocator_init(&allocator, allowed);
        info.pAllocator = &allocator.callbacks;
        rig.decoder = NULL;
        result = sluiceCreateVulkanNeuralDecoder(&info, &rig.decoder);
        if (result == SLUICE_SUCCESS)
            result = sluiceAddVulkanNeuralOutput(rig.decoder, &output, &producer);
        if (result != SLUICE_SUCCESS)
            assert_int_equal(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        sluiceDestroyVulkanNeuralDecoder(rig.decoder);
        assert_int_equal(allocator.live_count, 0);
    }
    assert_true(allowed > 2);
    close_set(&rig);
}

int main(void)
{
    struct harness h;
    int status = need_neural_samples((const char *const[]){SMALL, LARGE, OLD, NULL});
    if (status == 0)
        status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_those_of_the_decoder_in_C),
        cmocka_unit_test(texels_of_schema_1_are_those_of_the_decoder_in_C),
        cmocka_unit_test(codes_of_hlg_become_linear_floats),
        cmocka_unit_test(a_whole_texture_becomes_blocks_when_it_is_requested),
        cmocka_unit_test(blocks_are_near_to_them),
        cmocka_unit_test(wrong_decoders_are_refused),
        cmocka_unit_test(constants_that_contradict_themselves_are_refused),
        cmocka_unit_test(buffers_beyond_the_range_of_the_device_are_refused),
        cmocka_unit_test(wrong_outputs_are_refused),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    status = RUN_TESTS(tests);
    rig_finish(&small_rig);
    rig_finish(&large_rig);
    return harness_finish(&h, status);
}
