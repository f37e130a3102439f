/* Repair of masks that damage left inexact. The test counts errors by decoding, not by the report
 * of the repair. */
#include "neural/decoded.h"
#include "neural/made_file.h"
#include "support/failing_allocator.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 5, MASK = 3 };

/* A set of random numbers, and its expected texels: those before the damage. */
struct masked {
    struct made_file file;
    SluiceNeuralSet *set;
    struct decodable decodable;
    float *mips[SLUICE_NEURAL_MAX_MIPS];
    SluiceNeuralMaskInfo info;
};

static size_t texels_of(const struct masked *m, uint32_t mip)
{
    const uint32_t width = m->decodable.constants.width >> mip;
    const uint32_t height = m->decodable.constants.height >> mip;
    return (size_t)(width ? width : 1) * (height ? height : 1);
}

static float *decode_now(const struct masked *m, uint32_t mip)
{
    const uint32_t width = m->decodable.constants.width >> mip;
    const uint32_t height = m->decodable.constants.height >> mip;
    struct decodable five = m->decodable;
    five.constants.channelCount = CHANNELS;
    float *texels = malloc(texels_of(m, mip) * CHANNELS * sizeof *texels);
    assert_non_null(texels);
    CHECK_OK(decode_rectangle(&five, mip, 0, 0, width ? width : 1, height ? height : 1, texels));
    return texels;
}

static float clamp(float value)
{
    return fmaxf(fminf(value, 1.0f), 0.0f);
}

/* Scales of the last layer, so that about half of all outputs are beyond 0 and 1. */
static void calm_outputs(struct made_parts *parts, float scale)
{
    SluiceNeuralConstants *k = &parts->constants;
    const uint32_t weights = k->schema == 3 ? 8192 : k->inputCount * 64 + 2 * 64 * 64 + 64 * 16;
    const uint32_t outputs = k->schema == 3 ? 160 : 208;
    for (uint32_t o = outputs - 16; o < outputs; o++)
        memcpy(parts->int8_weights + weights + (size_t)4 * o, &scale, 4);
}

static void open_masked(struct masked *m, const struct made_shape *shape, uint32_t seed)
{
    struct made_parts parts;
    *m = (struct masked){0};
    make_parts(&parts, shape, seed);
    calm_outputs(&parts, 1.0f / 65536.0f);
    CHECK_OK(write_made_file(&parts, &m->file));
    free_made_parts(&parts);
    const SluiceInput input = {
        .structSize = sizeof input, .pBytes = m->file.bytes, .size = m->file.size};
    const SluiceNeuralSetCreateInfo create = {.structSize = sizeof create, .pInput = &input};
    CHECK_OK(sluiceOpenNeuralSet(&create, &m->set));
    read_decodable(m->set, NULL, SLUICE_NEURAL_WEIGHTS_INT8, &m->decodable);
    for (uint32_t mip = 0; mip < m->decodable.constants.mipCount; mip++) {
        m->mips[mip] = decode_now(m, mip);
        for (size_t i = 0; i < texels_of(m, mip) * CHANNELS; i++)
            m->mips[mip][i] = clamp(m->mips[mip][i]);
    }
    m->info = (SluiceNeuralMaskInfo){.structSize = sizeof m->info,
                                     .pConstants = &m->decodable.constants,
                                     .pLatents = m->decodable.latents,
                                     .latentSize = m->decodable.latent_size,
                                     .pInt8Weights = m->decodable.weights,
                                     .weightSize = m->decodable.weight_size,
                                     .channelCount = CHANNELS,
                                     .maskChannels = 1u << MASK,
                                     .clampedChannels = (1u << CHANNELS) - 1,
                                     .ppMips = (const float *const *)m->mips};
}

static void close_masked(struct masked *m)
{
    for (uint32_t mip = 0; mip < m->decodable.constants.mipCount; mip++)
        free(m->mips[mip]);
    free_decodable(&m->decodable);
    sluiceDestroyNeuralSet(m->set);
    free(m->file.bytes);
}

/* Counts texels with a wrong mask among those whose mask must be 0 or 1. `*certain`: number of the
 * latter. */
static uint64_t count_wrong(const struct masked *m, uint64_t *certain)
{
    uint64_t wrong = 0;
    *certain = 0;
    for (uint32_t mip = 0; mip < m->decodable.constants.mipCount; mip++) {
        float *decoded = decode_now(m, mip);
        for (size_t i = 0; i < texels_of(m, mip); i++) {
            const float wanted = m->mips[mip][i * CHANNELS + MASK];
            const bool is_certain = wanted == 0.0f || wanted == 1.0f;
            *certain += is_certain;
            wrong += is_certain && clamp(decoded[i * CHANNELS + MASK]) != wanted;
        }
        free(decoded);
    }
    return wrong;
}

/* Changes one code in sixty by up to two. */
static void damage(struct masked *m)
{
    roll_seed(3);
    for (uint64_t i = 0; i < m->decodable.latent_size; i++)
        if (roll() % 30 == 0)
            m->decodable.latents[i] ^= (uint8_t)(1 + roll() % 3);
}

static void check_shape(const struct made_shape *shape)
{
    struct masked m;
    SluiceNeuralMaskReport report = {.structSize = sizeof report};
    uint64_t certain;
    open_masked(&m, shape, 7);
    assert_int_equal(count_wrong(&m, &certain), 0);
    damage(&m);
    const uint64_t before = count_wrong(&m, &certain);
    CHECK_OK(sluiceRepairNeuralMasks(&m.info, &report));
    const uint64_t after = count_wrong(&m, &certain);
    print_message("# schema %u, %u x %u: of %llu texels %llu were wrong, %llu are\n", shape->schema,
                  shape->width, shape->height, (unsigned long long)certain,
                  (unsigned long long)before, (unsigned long long)after);
    assert_true(before > 0);
    assert_int_equal(report.texelCount, certain);
    assert_int_equal(report.wrongBefore, before);
    assert_int_equal(report.wrongAfter, after);
    assert_int_equal(after, 0);
    close_masked(&m);
}

/* Wrapped and clamped grids, sizes that are no powers of two, grids of one texel. */
static void damaged_masks_become_exact(void **state)
{
    static const struct made_shape shapes[] = {
        {3, 32, 32, 4, 8, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3},
        {3, 19, 23, 2, 4, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3},
        {1, 24, 16, 2, 4, 4, 8, 2, SLUICE_NEURAL_NETWORK_SMALL},
    };
    (void)state;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        check_shape(&shapes[i]);
}

static const struct made_shape small = {3, 16, 16, 4, 4, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3};

static void exact_masks_and_hopeless_ones_are_left_alone(void **state)
{
    struct masked m;
    SluiceNeuralMaskReport report = {.structSize = sizeof report};
    (void)state;
    open_masked(&m, &small, 7);
    uint8_t *kept = malloc((size_t)m.decodable.latent_size);
    assert_non_null(kept);
    memcpy(kept, m.decodable.latents, (size_t)m.decodable.latent_size);
    CHECK_OK(sluiceRepairNeuralMasks(&m.info, &report));
    assert_int_equal(report.wrongBefore, 0);
    assert_true(report.texelCount > 0);
    assert_memory_equal(kept, m.decodable.latents, (size_t)m.decodable.latent_size);
    damage(&m);
    uint64_t certain;
    m.info.maxWrongCount = count_wrong(&m, &certain) - 1;
    memcpy(kept, m.decodable.latents, (size_t)m.decodable.latent_size);
    CHECK_OK(sluiceRepairNeuralMasks(&m.info, &report));
    assert_int_equal(report.wrongAfter, m.info.maxWrongCount + 1); /* too many */
    assert_memory_equal(kept, m.decodable.latents, (size_t)m.decodable.latent_size);
    m.info.maxWrongCount = 0;
    m.info.maskChannels = 0; /* nothing to keep exact */
    memcpy(kept, m.decodable.latents, (size_t)m.decodable.latent_size);
    CHECK_OK(sluiceRepairNeuralMasks(&m.info, NULL));
    assert_memory_equal(kept, m.decodable.latents, (size_t)m.decodable.latent_size);
    free(kept);
    close_masked(&m);
}

static char message[256];

static void on_log(void *user, SluiceLogSeverity severity, const char *text)
{
    (void)user, (void)severity;
    snprintf(message, sizeof message, "%s", text);
}

static void check_refused(const struct masked *m, const SluiceNeuralConstants *constants,
                          const char *said)
{
    SluiceNeuralMaskInfo info = m->info;
    info.pConstants = constants;
    info.log = (SluiceLogCallback){NULL, on_log};
    CHECK_RESULT(sluiceRepairNeuralMasks(&info, NULL), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_string_equal(message, said);
}

static void wrong_arguments_are_named(void **state)
{
    struct masked m;
    (void)state;
    open_masked(&m, &small, 7);
    SluiceNeuralConstants k = m.decodable.constants;
    k.mipCount = 0;
    check_refused(&m, &k, "mipCount is 0, must be 1 to 16");
    k = m.decodable.constants;
    k.height = SLUICE_NEURAL_MAX_SIZE + 1;
    check_refused(&m, &k, "mip 0 has 16 x 32769 texels, must have 1 to 32768 each way");
    k = m.decodable.constants;
    k.mips[1].firstSlice = 15;
    check_refused(&m, &k, "mips[1].firstSlice is 15, must be 0 to 14");
    k = m.decodable.constants;
    k.mips[1].firstSlice = 1;
    check_refused(&m, &k, "mips[1].firstSlice is 1 after 0: must be equal or at least 2 more");
    k = m.decodable.constants;
    k.slices[1].sliceSize--;
    check_refused(&m, &k, "slices[1] is no whole grid");
    k = m.decodable.constants;
    m.info.channelCount = 17;
    check_refused(&m, &k, "channelCount is 17, must be 1 to 16");
    m.info.channelCount = CHANNELS;
    m.info.latentSize = 8;
    check_refused(&m, &k, "latentSize of a decode is 8, which does not fit");
    m.info.latentSize = m.decodable.latent_size;
    const float *some[SLUICE_NEURAL_MAX_MIPS], numberless[CHANNELS] = {0.0f, 0.0f, 0.0f, NAN};
    memcpy(some, m.mips, sizeof some);
    some[k.mipCount - 1] = numberless;
    m.info.ppMips = some;
    check_refused(&m, &k, "channel 3 of texel 0, 0 of mip 4 is not finite");
    memcpy(some, m.mips, sizeof some);
    some[2] = NULL;
    m.info.ppMips = some;
    CHECK_RESULT(sluiceRepairNeuralMasks(&m.info, NULL), SLUICE_ERROR_NULL_POINTER);
    close_masked(&m);
}

static void every_refused_allocation_is_survived(void **state)
{
    struct failing_allocator allocator;
    struct masked m;
    uint64_t refused = 0;
    (void)state;
    open_masked(&m, &small, 7);
    damage(&m);
    for (SluiceResult result = SLUICE_NOT_READY; result != SLUICE_SUCCESS; refused++) {
        failing_allocator_init(&allocator, refused);
        m.info.pAllocator = &allocator.callbacks;
        result = sluiceRepairNeuralMasks(&m.info, NULL);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(allocator.live_bytes, 0);
    }
    assert_true(refused > 7); /* five mips, two buffers, one group at least */
    close_masked(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged_masks_become_exact),
        cmocka_unit_test(exact_masks_and_hopeless_ones_are_left_alone),
        cmocka_unit_test(wrong_arguments_are_named),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    return RUN_TESTS(tests);
}
