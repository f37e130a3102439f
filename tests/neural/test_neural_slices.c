/* Slices of latents: rectangles decode from them as from the whole file, and they are small. */
#include "neural/decoded.h"
#include "neural/decoder.h"
#include "neural/made_file.h"
#include "neural/neural_files.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t mip_size(uint32_t size, uint32_t mip)
{
    return size >> mip ? size >> mip : 1;
}

static SluiceNeuralRequest roll_request(const SluiceNeuralConstants *k)
{
    SluiceNeuralRequest r = {.firstMip = (uint32_t)roll() % k->mipCount};
    uint32_t width = mip_size(k->width, r.firstMip), height = mip_size(k->height, r.firstMip);
    r.mipCount = 1 + (uint32_t)roll() % (k->mipCount - r.firstMip);
    r.width = 1 + (uint32_t)roll() % (width < 24 ? width : 24);
    r.height = 1 + (uint32_t)roll() % (height < 24 ? height : 24);
    r.x = (uint32_t)roll() % (width - r.width + 1);
    r.y = (uint32_t)roll() % (height - r.height + 1);
    return r;
}

/* Texels of a mip that lie under a rectangle, in one direction. */
static void scale_span(uint32_t from, uint32_t count, uint32_t size, uint32_t mip_texels,
                       uint32_t *first, uint32_t *texels)
{
    *first = (uint32_t)((uint64_t)from * mip_texels / size);
    *texels = (uint32_t)(((uint64_t)(from + count) * mip_texels + size - 1) / size) - *first;
}

/* The rectangle and what lies under it in coarser mips, at most 6 x 6 texels of each. */
static void check_request(const struct decodable *whole, const struct decodable *slice,
                          const SluiceNeuralRequest *r)
{
    const SluiceNeuralConstants *k = &whole->constants;
    float expected[36 * 16], texels[36 * 16];
    uint32_t x, y, width, height;
    for (uint32_t mip = r->firstMip; mip < r->firstMip + r->mipCount; mip++) {
        scale_span(r->x, r->width, mip_size(k->width, r->firstMip), mip_size(k->width, mip), &x,
                   &width);
        scale_span(r->y, r->height, mip_size(k->height, r->firstMip), mip_size(k->height, mip), &y,
                   &height);
        for (int corner = 0; corner < 2; corner++) { /* both ends of the rectangle */
            uint32_t w = width < 6 ? width : 6, h = height < 6 ? height : 6;
            uint32_t left = corner ? x + width - w : x, top = corner ? y + height - h : y;
            CHECK_OK(decode_rectangle(whole, mip, left, top, w, h, expected));
            CHECK_OK(decode_rectangle(slice, mip, left, top, w, h, texels));
            assert_memory_equal(expected, texels, sizeof(float) * w * h * k->channelCount);
        }
    }
}

static void check_requests(const SluiceNeuralSet *set, int count)
{
    struct decodable whole, slice;
    read_decodable(set, NULL, SLUICE_NEURAL_WEIGHTS_INT8, &whole);
    for (int i = 0; i < count; i++) {
        SluiceNeuralRequest request = roll_request(&whole.constants);
        uint32_t alignment = 1u << roll() % 4;
        uint64_t bound;
        request.x -= request.x % alignment;
        request.y -= request.y % alignment;
        read_decodable(set, &request, SLUICE_NEURAL_WEIGHTS_INT8, &slice);
        check_request(&whole, &slice, &request);
        CHECK_OK(sluiceBoundNeuralLatents(set, &request, alignment, &bound));
        assert_true(bound >= slice.latent_size);
        free_decodable(&slice);
    }
    free_decodable(&whole);
}

static void slices_decode_as_the_whole_file(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < MADE_SHAPE_COUNT; i++) {
        struct made_file file;
        SluiceNeuralSet *set = open_made_file(&made_shapes[i], i, &file);
        check_requests(set, 24);
        sluiceDestroyNeuralSet(set);
        free(file.bytes);
    }
}

static void bounds_hold_for_all_rectangles(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < MADE_SHAPE_COUNT; i++) {
        struct made_file file;
        SluiceNeuralSet *set = open_made_file(&made_shapes[i], i, &file);
        SluiceNeuralConstants k;
        uint64_t size = 0, bound, whole;
        CHECK_OK(sluiceReadNeuralLatents(set, NULL, &k, &whole, NULL));
        for (int n = 0; n < 3000; n++) {
            SluiceNeuralRequest request = roll_request(&k);
            uint32_t alignment = 1u << roll() % 5;
            request.x -= request.x % alignment;
            request.y -= request.y % alignment;
            CHECK_OK(sluiceReadNeuralLatents(set, &request, &k, &size, NULL));
            CHECK_OK(sluiceBoundNeuralLatents(set, &request, alignment, &bound));
            if (bound < size || bound > whole)
                fail_msg("shape %u, mips %u + %u, %u x %u at %u, %u of %u: %d bytes, bound %d", i,
                         request.firstMip, request.mipCount, request.width, request.height,
                         request.x, request.y, alignment, (int)size, (int)bound);
        }
        sluiceDestroyNeuralSet(set);
        free(file.bytes);
    }
}

/* Slices of NVIDIA's 0.7, in its own arithmetic: [first, count] of a grid of `grid` texels. */
static void cut_span(uint32_t from, uint32_t count, uint32_t step, uint32_t mip_texels,
                     uint32_t grid, uint32_t bits, uint32_t span[2])
{
    int left = (int)from >> step, right = (int)ceil((from + count) / exp2(step)) - 1;
    float g = (float)grid, c = (float)mip_texels;
    int first = (int)((float)left / c * g - 0.5f), last = (int)((float)(right + 1) / c * g - 0.5f);
    first = first < 0 ? 0 : first;
    last = last + 1 > (int)grid - 1 ? (int)grid - 1 : last + 1;
    int size = last - first + 1;
    if (bits & 4) {
        int end = first + size + 1;
        first -= first % 2;
        size = end - end % 2 > (int)grid ? (int)grid - first : end - end % 2 - first;
    }
    span[0] = (uint32_t)first;
    span[1] = (uint32_t)size;
}

/* Copies a slice from the file's own bytes, a bit at a time. */
static void cut_slice(const SluiceNeuralSet *set, uint32_t grid, const uint32_t x[2],
                      const uint32_t y[2], uint32_t width, uint32_t bits, uint8_t *out)
{
    uint64_t size = 0;
    CHECK_OK(sluiceReadNeuralLatentPart(set, grid / 2, grid % 2, &size, NULL));
    uint8_t *view = malloc((size_t)size);
    assert_non_null(view);
    CHECK_OK(sluiceReadNeuralLatentPart(set, grid / 2, grid % 2, &size, view));
    uint64_t to = 0;
    for (uint32_t row = y[0]; row < y[0] + y[1]; row++)
        for (uint64_t b = 0; b < (uint64_t)x[1] * bits; b++, to++) {
            uint64_t from = ((uint64_t)row * width + x[0]) * bits + b;
            out[to / 8] |= (uint8_t)((view[from / 8] >> from % 8 & 1) << to % 8);
        }
    free(view);
}

static void check_cut(const SluiceNeuralSet *set, const struct decodable *slice,
                      const SluiceNeuralRequest *r)
{
    const SluiceNeuralConstants *k = &slice->constants;
    uint8_t *expected = calloc((size_t)slice->latent_size, 1);
    uint64_t offset = 0;
    assert_non_null(expected);
    for (uint32_t mip = r->firstMip; mip < r->firstMip + r->mipCount; mip++) {
        if (mip + 1 < r->firstMip + r->mipCount &&
            k->mips[mip + 1].firstSlice == k->mips[mip].firstSlice)
            continue; /* the coarsest mip of each latent image */
        for (uint32_t g = k->mips[mip].firstSlice; g < k->mips[mip].firstSlice + 2; g++) {
            const SluiceNeuralSlice *s = &k->slices[g];
            uint32_t bits = g % 2 ? k->lowFeatures * k->lowBits : k->highFeatures * k->highBits;
            uint32_t x[2], y[2], step = mip - r->firstMip;
            cut_span(r->x, r->width, step, mip_size(k->width, mip), s->gridSize & 0xFFFF, bits, x);
            cut_span(r->y, r->height, step, mip_size(k->height, mip), s->gridSize >> 16,
                     x[1] * bits, y);
            assert_int_equal(s->dataOffset, offset);
            assert_int_equal(s->origin, x[0] | y[0] << 16);
            assert_int_equal(s->sliceSize, x[1] | y[1] << 16);
            cut_slice(set, g, x, y, s->gridSize & 0xFFFF, bits, expected + offset);
            offset += ((uint64_t)x[1] * y[1] * bits + 31) / 32 * 4;
        }
    }
    assert_int_equal(offset, slice->latent_size);
    assert_memory_equal(expected, slice->latents, slice->latent_size);
    free(expected);
}

static void slices_of_schema_1_are_cut_as_version_0_7_cuts_them(void **state)
{
    static const uint32_t SHAPES[] = {0, 1, 3}; /* powers of two */
    (void)state;
    for (uint32_t i = 0; i < 3; i++) {
        struct made_file file;
        struct decodable slice;
        SluiceNeuralSet *set = open_made_file(&made_shapes[SHAPES[i]], i, &file);
        SluiceNeuralConstants k;
        uint64_t size = 0;
        CHECK_OK(sluiceReadNeuralLatents(set, NULL, &k, &size, NULL));
        for (int n = 0; n < 300; n++) {
            SluiceNeuralRequest request = roll_request(&k);
            read_decodable(set, &request, SLUICE_NEURAL_WEIGHTS_INT8, &slice);
            check_cut(set, &slice, &request);
            free_decodable(&slice);
        }
        sluiceDestroyNeuralSet(set);
        free(file.bytes);
    }
}

/* A code of a grid, clamped or wrapped, from plain codes. */
static uint32_t code_at(const SluiceNeuralConstants *k, const uint8_t *codes, uint32_t g,
                        uint32_t features, int x, int y, uint32_t feature)
{
    int width = (int)(k->slices[g].gridSize & 0xFFFF), height = (int)(k->slices[g].gridSize >> 16);
    if (k->schema == 1) {
        x = x < 0 ? 0 : x >= width ? width - 1 : x;
        y = y < 0 ? 0 : y >= height ? height - 1 : y;
    } else {
        x = (x + width) % width;
        y = (y + height) % height;
    }
    return codes[((size_t)y * (size_t)width + (size_t)x) * features + feature];
}

struct place {
    int corner[2];
    long double fraction[2];
};

static struct place place_of(const SluiceNeuralConstants *k, uint32_t g, uint32_t mip, uint32_t x,
                             uint32_t y)
{
    struct place p;
    uint32_t grid[2] = {k->slices[g].gridSize & 0xFFFF, k->slices[g].gridSize >> 16};
    uint32_t texel[2] = {x, y}, size[2] = {mip_size(k->width, mip), mip_size(k->height, mip)};
    for (int i = 0; i < 2; i++) {
        /* (texel + 1 / 2) / size * grid - 1 / 2, as a fraction: a corner is no matter of rounding
         */
        long double numerator = (2 * (long double)texel[i] + 1) * grid[i] - size[i];
        p.corner[i] = (int)floorl(numerator / (2 * size[i]));
        p.fraction[i] = numerator / (2 * size[i]) - p.corner[i];
    }
    return p;
}

static long double weight_of(const struct place *p, int i)
{
    return (i % 2 ? p->fraction[0] : 1 - p->fraction[0]) *
           (i / 2 ? p->fraction[1] : 1 - p->fraction[1]);
}

/* Features of schema 3: floor(255 S - 128) of the mean S of code / 15. */
static void expect_features_3(const SluiceNeuralConstants *k, const uint8_t *const codes[16],
                              uint32_t mip, uint32_t x, uint32_t y, int expected[96])
{
    for (uint32_t n = 0; n < 2; n++) {
        uint32_t g = k->mips[mip].firstSlice + n;
        struct place p = place_of(k, g, mip, x, y);
        for (uint32_t f = 0; f < k->highFeatures; f++) {
            long double mean = 0;
            for (int i = 0; i < 4; i++)
                mean += weight_of(&p, i) * code_at(k, codes[g], g, k->highFeatures,
                                                   p.corner[0] + i % 2, p.corner[1] + i / 2, f);
            expected[16 * n + f] = (int)floorl(17 * mean - 128);
        }
    }
}

static int value_of(uint32_t code, uint32_t bits)
{
    static const long double MIDDLE[9] = {0, 0, 1, 0, 7, 0, 0, 0, 126},
                             STEP[9] = {0, 2 / 3.0L, 2 / 5.0L, 0, 2 / 17.0L, 0, 0, 0, 1 / 127.5L};
    return (int)lroundl(((long double)code - MIDDLE[bits]) * STEP[bits] * 127.5L);
}

static void expect_features_1(const SluiceNeuralConstants *k, const uint8_t *const codes[16],
                              uint32_t mip, uint32_t x, uint32_t y, int expected[96])
{
    uint32_t g = k->mips[mip].firstSlice;
    struct place p = place_of(k, g, mip, x, y), low = place_of(k, g + 1, mip, x, y);
    for (uint32_t f = 0; f < 16; f++) {
        int sum = 0;
        for (int i = 0; i < 4; i++) {
            int weight = (int)(weight_of(&p, i) * 256),
                low_weight = (int)(weight_of(&low, i) * 256);
            if (f < k->highFeatures)
                expected[(uint32_t)i * k->networkFeatures + f] =
                    (int)floorl(weight *
                                value_of(code_at(k, codes[g], g, k->highFeatures,
                                                 p.corner[0] + i % 2, p.corner[1] + i / 2, f),
                                         k->highBits) /
                                256.0L);
            if (f < k->lowFeatures)
                sum +=
                    low_weight * value_of(code_at(k, codes[g + 1], g + 1, k->lowFeatures,
                                                  low.corner[0] + i % 2, low.corner[1] + i / 2, f),
                                          k->lowBits);
        }
        expected[4 * k->networkFeatures + f] = (int)floorl(sum / 256.0L);
    }
}

static long double fraction_of(long double t)
{
    return t - floorl(t);
}

static void expect_position(const SluiceNeuralConstants *k, uint32_t mip, uint32_t x, uint32_t y,
                            int *expected)
{
    bool is_one = k->schema == 1;
    for (int i = 0; i < 12; i++) {
        long double t = (long double)(i % 2 ? y : x) * k->mips[mip].positionScale;
        t = t * exp2l(i / 4 - (is_one ? 3 : 0)) + (i % 4 >= 2 ? 0.25L : 0);
        long double e = is_one ? fabsl(4 * fraction_of(t) - 2) - 1 : 2 * fraction_of(t) - 1;
        expected[i] = is_one ? (int)(127.5L * e) : (int)fmaxl(floorl(127.5L * e - 0.5L), -127);
    }
    long double lod = 127.5L * k->mips[mip].positionLod;
    expected[12] = expected[13] = is_one ? (int)fminl(lod, 127) : (int)floorl(lod - 0.5L);
}

/* Every texel of every mip. Sizes that are no powers of two may be off by `tolerance`. */
static void check_inputs(const struct made_parts *parts, const struct decodable *d, int tolerance)
{
    const SluiceNeuralConstants *k = &d->constants;
    const uint8_t *codes[16], *next = parts->codes;
    for (uint32_t g = 0; g < 16; g++) {
        uint32_t features = k->schema == 1 && g % 2 ? k->lowFeatures : k->highFeatures;
        codes[g] = next;
        next += (size_t)(k->slices[g].gridSize & 0xFFFF) * (k->slices[g].gridSize >> 16) * features;
    }
    for (uint32_t mip = 0; mip < k->mipCount; mip++) {
        uint32_t first = k->mips[mip].firstSlice;
        struct slc_neural_mip_view view = {.constants = k,
                                           .mip = mip,
                                           .width = mip_size(k->width, mip),
                                           .height = mip_size(k->height, mip),
                                           .slices = {k->slices[first], k->slices[first + 1]},
                                           .codes = {d->latents + k->slices[first].dataOffset,
                                                     d->latents + k->slices[first + 1].dataOffset}};
        for (uint32_t i = 0; i < view.width * view.height; i++) {
            uint32_t x = i % view.width, y = i / view.width;
            int expected[96] = {0};
            int8_t inputs[96];
            (k->schema == 1 ? expect_features_1 : expect_features_3)(k, codes, mip, x, y, expected);
            expect_position(k, mip, x, y,
                            expected + (k->schema == 1 ? 4 * k->networkFeatures + 16 : 32));
            slc_neural_int8_inputs(&view, x, y, inputs);
            for (uint32_t n = 0; n < k->inputCount; n++)
                if (abs(inputs[n] - (int8_t)expected[n]) > tolerance) /* the low 8 bits */
                    fail_msg("%u x %u: mip %u, texel %u %u, input %u is %d, not %d", k->width,
                             k->height, mip, x, y, n, inputs[n], expected[n]);
        }
    }
}

/* Fractions of 1 / 256 are exact for powers of two, and off by as much elsewhere. */
static void inputs_are_those_of_long_doubles(void **state)
{
    static const int TOLERANCES[MADE_SHAPE_COUNT] = {0, 0, 3, 0, 3, 0, 2, 2, 0, 2};
    (void)state;
    for (uint32_t i = 0; i < MADE_SHAPE_COUNT; i++) {
        struct made_parts parts;
        struct made_file file = {0};
        struct decodable d;
        SluiceNeuralSet *set = NULL;
        make_parts(&parts, &made_shapes[i], i);
        CHECK_OK(write_made_file(&parts, &file));
        CHECK_OK(open_neural_bytes(file.bytes, file.size, NULL, &set));
        read_decodable(set, NULL, SLUICE_NEURAL_WEIGHTS_INT8, &d);
        check_inputs(&parts, &d, TOLERANCES[i]);
        free_decodable(&d);
        sluiceDestroyNeuralSet(set);
        free_made_parts(&parts);
        free(file.bytes);
    }
}

static void texels_that_are_not_there_are_not_decoded(void **state)
{
    struct made_file file;
    struct decodable d;
    float texels[64];
    (void)state;
    for (uint32_t i = 0; i < 6; i += 5) { /* one of each schema */
        SluiceNeuralSet *set = open_made_file(&made_shapes[i], i, &file);
        SluiceNeuralRequest request = {.mipCount = 1, .x = 8, .y = 8, .width = 8, .height = 8};
        read_decodable(set, &request, SLUICE_NEURAL_WEIGHTS_INT8, &d);
        CHECK_OK(decode_rectangle(&d, 0, 8, 8, 2, 2, texels));
        CHECK_RESULT(decode_rectangle(&d, 0, 0, 8, 2, 2, texels), SLUICE_NOT_READY);
        CHECK_RESULT(decode_rectangle(&d, 0, 8, 24, 2, 2, texels), SLUICE_NOT_READY);
        CHECK_RESULT(decode_rectangle(&d, 5, 0, 0, 1, 1, texels), SLUICE_NOT_READY);
        CHECK_RESULT(decode_rectangle(&d, 0, 63, 0, 2, 1, texels), SLUICE_ERROR_INVALID_ARGUMENT);
        CHECK_RESULT(decode_rectangle(&d, 7, 0, 0, 1, 1, texels), SLUICE_ERROR_INVALID_ARGUMENT);
        d.latent_size -= 4;
        CHECK_RESULT(decode_rectangle(&d, 0, 8, 8, 2, 2, texels), SLUICE_ERROR_INVALID_ARGUMENT);
        free_decodable(&d);
        sluiceDestroyNeuralSet(set);
        free(file.bytes);
    }
}

static void rectangles_beyond_a_mip_are_refused(void **state)
{
    struct made_file file;
    SluiceNeuralConstants k;
    uint64_t size = 0;
    (void)state;
    SluiceNeuralSet *set = open_made_file(&made_shapes[0], 1, &file); /* 64 x 32 */
    static const SluiceNeuralRequest WRONG[] = {
        {.mipCount = 8},
        {.firstMip = 7},
        {.x = 64, .width = 1, .height = 1},
        {.x = 1, .width = 64, .height = 1},
        {.y = 31, .width = 1, .height = 2},
        {.width = 1},
        {.firstMip = 1, .x = 31, .width = 2, .height = 1},
        {.width = UINT32_MAX, .height = 1, .x = 2},
    };
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++)
        CHECK_RESULT(sluiceReadNeuralLatents(set, &WRONG[i], &k, &size, NULL),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    uint8_t byte;
    size = 1;
    CHECK_RESULT(sluiceReadNeuralLatents(set, NULL, &k, &size, &byte), SLUICE_ERROR_SIZE_MISMATCH);
    assert_true(size > 1);
    sluiceDestroyNeuralSet(set);
    free(file.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_decode_as_the_whole_file),
        cmocka_unit_test(bounds_hold_for_all_rectangles),
        cmocka_unit_test(slices_of_schema_1_are_cut_as_version_0_7_cuts_them),
        cmocka_unit_test(inputs_are_those_of_long_doubles),
        cmocka_unit_test(texels_that_are_not_there_are_not_decoded),
        cmocka_unit_test(rectangles_beyond_a_mip_are_refused),
    };
    return RUN_TESTS(tests);
}
