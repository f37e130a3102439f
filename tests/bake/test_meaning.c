/* Averages follow the meaning of the numbers. Expected values are computed here in double. */
#include "bake/baked.h"
#include "support/test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <vips/vips.h>
#include <string.h>

/* IEC 61966-2-1 */
static double decode(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static double encode(double v)
{
    return v <= 0.0031308 ? v * 12.92 : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

static uint32_t next_random(uint32_t *random)
{
    *random = *random * 1664525u + 1013904223u;
    return *random >> 8;
}

static uint8_t *random_bytes(size_t count, uint32_t seed)
{
    uint8_t *bytes = malloc(count);
    for (size_t i = 0; i < count; i++)
        bytes[i] = (uint8_t)next_random(&seed);
    return bytes;
}

struct fixture {
    struct bake_folder folder;
    char in[256], out[256];
};

static void fixture_init(struct fixture *fixture)
{
    bake_folder_init(&fixture->folder);
    bake_folder_file(&fixture->folder, "in.png", fixture->in);
    bake_folder_file(&fixture->folder, "out.store", fixture->out);
}

static SluiceStoreInfo store_info(const char *path)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    SluiceStoreInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetStoreInfo(source, &info));
    info.pSourceName = NULL; /* goes with the source */
    sluiceDestroyImageSource(source);
    return info;
}

/* Compares bytes of level 1 with the mean of the four texels above. */
static void check_means(const char *path, const uint8_t *samples, uint32_t width, uint32_t height,
                        uint32_t channels, double (*from)(double), double (*to)(double))
{
    size_t size;
    uint8_t *bytes = read_bytes(path, 1, &size);
    uint32_t stored = channels >= 3 ? 4 : channels;
    for (uint32_t y = 0; y < height / 2; y++)
        for (uint32_t x = 0; x < width / 2; x++)
            for (uint32_t c = 0; c < channels; c++) {
                double sum = 0;
                for (uint32_t i = 0; i < 4; i++)
                    sum += from(samples[((2 * y + i / 2) * width + 2 * x + i % 2) * channels + c] /
                                255.0);
                double expected = 255 * to(sum / 4);
                double got = bytes[(y * (width / 2) + x) * stored + c];
                if (fabs(got - expected) > 0.51)
                    fail_msg("(%u, %u) channel %u is %g, not %g", x, y, c, got, expected);
            }
    free(bytes);
}

static double same(double v)
{
    return v;
}

static void colors_are_averaged_as_light(void **state)
{
    (void)state;
    struct fixture f;
    fixture_init(&f);
    uint8_t *samples = random_bytes(200 * 140 * 3, 1);
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    write_png(f.in, samples, 200, 140, 3, false);
    bake_picture_file(f.in, f.out, &settings);
    assert_int_equal(store_info(f.out).layout.format, SLUICE_FORMAT_R8G8B8A8_SRGB);
    assert_int_equal(store_info(f.out).meaning, SLUICE_STORE_MEANING_COLOR);
    check_means(f.out, samples, 200, 140, 3, decode, encode);
    free(samples);
    bake_folder_finish(&f.folder);
}

static void data_are_averaged_as_they_are(void **state)
{
    (void)state;
    struct fixture f;
    fixture_init(&f);
    uint8_t *samples = random_bytes(200 * 140 * 3, 2);
    SluiceBakeSettings settings = {.structSize = sizeof settings,
                                   .transfer = SLUICE_BAKE_TRANSFER_LINEAR};
    write_png(f.in, samples, 200, 140, 3, false);
    bake_picture_file(f.in, f.out, &settings);
    assert_int_equal(store_info(f.out).layout.format, SLUICE_FORMAT_R8G8B8A8_UNORM);
    check_means(f.out, samples, 200, 140, 3, same, same);
    write_png(f.in, samples, 200, 140, 1, false);
    settings.transfer = SLUICE_BAKE_TRANSFER_AUTO;
    bake_picture_file(f.in, f.out, &settings);
    assert_int_equal(store_info(f.out).layout.format, SLUICE_FORMAT_R8_UNORM);
    assert_int_equal(store_info(f.out).meaning, SLUICE_STORE_MEANING_DATA);
    check_means(f.out, samples, 200, 140, 1, same, same);
    free(samples);
    bake_folder_finish(&f.folder);
}

static void bytes_of_the_picture_are_kept(void **state)
{
    (void)state;
    struct fixture f;
    fixture_init(&f);
    uint8_t *samples = random_bytes(301 * 203 * 4, 3);
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    size_t size;
    write_png(f.in, samples, 301, 203, 4, false);
    bake_picture_file(f.in, f.out, &settings);
    uint8_t *bytes = read_bytes(f.out, 0, &size);
    assert_int_equal(size, 301 * 203 * 4);
    assert_memory_equal(bytes, samples, size);
    free(bytes);
    free(samples);
    bake_folder_finish(&f.folder);
}

/* Where each of EXIF's eight orientations stores a texel of the upright picture. */
static void pictures_are_turned_as_exif_says(void **state)
{
    (void)state;
    enum { W = 5, H = 3 };
    struct fixture f;
    uint8_t samples[W * H * 3];
    fixture_init(&f);
    for (int i = 0; i < W * H * 3; i++)
        samples[i] = (uint8_t)(i * 5);
    assert_int_equal(VIPS_INIT("test"), 0);
    for (int o = 1; o <= 8; o++) {
        uint32_t width;
        char path[256];
        bake_folder_file(&f.folder, "turned.tif", path);
        VipsImage *image = vips_image_new_from_memory(samples, sizeof samples, W, H, 3,
                                                      VIPS_FORMAT_UCHAR),
                  *copy;
        assert_int_equal(vips_copy(image, &copy, "interpretation", VIPS_INTERPRETATION_sRGB, NULL),
                         0);
        vips_image_set_int(copy, VIPS_META_ORIENTATION, o);
        assert_int_equal(vips_image_write_to_file(copy, path, NULL), 0);
        g_object_unref(copy);
        g_object_unref(image);
        bake_picture_file(path, f.out, &(SluiceBakeSettings){sizeof(SluiceBakeSettings)});
        size_t size;
        uint8_t *texels = read_bytes(f.out, 0, &size);
        assert_int_equal(size, W * H * 4);
        width = o < 5 ? W : H;
        assert_int_equal(store_info(f.out).layout.width, width);
        for (uint32_t i = 0; i < W * H; i++) {
            uint32_t x = i % width, y = i / width, c = o < 5 ? x : y, r = o < 5 ? y : x;
            bool mirrors_columns = o == 2 || o == 3 || o == 7 || o == 8;
            bool mirrors_rows = o == 3 || o == 4 || o == 6 || o == 7;
            c = mirrors_columns ? W - 1 - c : c;
            r = mirrors_rows ? H - 1 - r : r;
            assert_memory_equal(texels + 4 * i, samples + 3 * (r * W + c), 3);
        }
        free(texels);
    }
    bake_folder_finish(&f.folder);
}

static void words_of_the_picture_are_kept(void **state)
{
    (void)state;
    struct fixture f;
    uint16_t samples[64 * 48];
    uint32_t random = 4, width, height;
    fixture_init(&f);
    for (size_t i = 0; i < 64 * 48; i++)
        samples[i] = (uint16_t)next_random(&random);
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    write_png(f.in, samples, 64, 48, 1, true);
    bake_picture_file(f.in, f.out, &settings);
    assert_int_equal(store_info(f.out).layout.format, SLUICE_FORMAT_R16_UNORM);
    float *level = read_level(f.out, 0, &width, &height);
    for (size_t i = 0; i < 64 * 48; i++)
        assert_true(fabs((double)level[4 * i] - samples[i] / 65535.0) < 1e-7);
    free(level);
    write_png(f.in, samples, 16, 16, 3, true);
    bake_picture_file(f.in, f.out, &settings);
    assert_int_equal(store_info(f.out).layout.format, SLUICE_FORMAT_R16G16B16A16_UNORM);
    level = read_level(f.out, 0, &width, &height);
    for (size_t i = 0; i < 16 * 16; i++)
        for (uint32_t c = 0; c < 3; c++) {
            double expected = decode(samples[3 * i + c] / 65535.0);
            assert_true(fabs((double)level[4 * i + c] - expected) <= 0.501 / 65535);
        }
    free(level);
    bake_folder_finish(&f.folder);
}

/* Checks that level 1 has colors weighted by alpha, or plain means without alpha. */
static void check_weighted(const float *texels, const float *level, uint32_t width, uint32_t height)
{
    for (uint32_t y = 0; y < height / 2; y++)
        for (uint32_t x = 0; x < width / 2; x++) {
            double sum[4] = {0}, plain[3] = {0};
            for (uint32_t i = 0; i < 4; i++) {
                const float *t = texels + 4 * ((2 * y + i / 2) * width + 2 * x + i % 2);
                for (uint32_t c = 0; c < 3; c++) {
                    sum[c] += (double)t[c] * t[3];
                    plain[c] += (double)t[c] / 4;
                }
                sum[3] += t[3];
            }
            const float *got = level + 4 * (y * (width / 2) + x);
            assert_true(fabs(got[3] - sum[3] / 4) < 1e-6);
            for (uint32_t c = 0; c < 3; c++) {
                double expected = sum[3] > 0 ? sum[c] / sum[3] : plain[c];
                if (fabs(got[c] - expected) > 1e-4)
                    fail_msg("(%u, %u) channel %u is %g, not %g", x, y, c, (double)got[c],
                             expected);
            }
        }
}

static float *random_floats(size_t count, uint32_t seed)
{
    float *floats = malloc(count * sizeof *floats);
    for (size_t i = 0; i < count; i++)
        floats[i] = (float)next_random(&seed) * 0x1p-24f;
    return floats;
}

static void colors_count_as_much_as_they_cover(void **state)
{
    (void)state;
    struct fixture f;
    uint32_t width, height;
    fixture_init(&f);
    float *texels = random_floats(4 * 60 * 80, 5);
    for (uint32_t i = 0; i < 60 * 80; i++) /* quads without alpha, and texels, among them */
        texels[4 * i + 3] = i / 8 % 3 == 0 || i % 5 == 0 ? 0.0f : texels[4 * i + 3];
    struct plain_source source;
    SluiceBakeSettings settings = {.structSize = sizeof settings,
                                   .alpha = SLUICE_BAKE_ALPHA_STRAIGHT};
    plain_source_init(&source, SLUICE_FORMAT_R32G32B32A32_SFLOAT, 80, 60, texels);
    bake_source(&source.base, f.out, &settings);
    assert_int_equal(store_info(f.out).meaning, SLUICE_STORE_MEANING_COLOR_ALPHA);
    float *level = read_level(f.out, 1, &width, &height);
    check_weighted(texels, level, 80, 60);
    free(level);
    free(texels);
    bake_folder_finish(&f.folder);
}

static void premultiplied_colors_are_averaged_as_they_are(void **state)
{
    (void)state;
    struct fixture f;
    uint32_t width, height;
    fixture_init(&f);
    float *texels = random_floats(4 * 32 * 32, 6);
    struct plain_source source;
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    plain_source_init(&source, SLUICE_FORMAT_R32G32B32A32_SFLOAT, 32, 32, texels);
    bake_source(&source.base, f.out, &settings);
    assert_int_equal(store_info(f.out).meaning, SLUICE_STORE_MEANING_COLOR_PREMULTIPLIED);
    float *level = read_level(f.out, 5, &width, &height);
    for (uint32_t c = 0; c < 4; c++) {
        double sum = 0;
        for (uint32_t i = 0; i < 32 * 32; i++)
            sum += texels[4 * i + c];
        assert_true(fabs(level[c] - sum / 1024) < 1e-6);
    }
    free(level);
    free(texels);
    bake_folder_finish(&f.folder);
}

/* Level 0 is unchanged. Below it all vectors have length 1, as nearly as bytes allow. */
static void normals_keep_their_length(void **state)
{
    (void)state;
    struct fixture f;
    uint32_t random = 7, width, height;
    uint8_t *samples = malloc(130 * 97 * 3);
    fixture_init(&f);
    for (uint32_t i = 0; i < 130 * 97; i++) {
        double angle = next_random(&random) * 0x1p-24 * 6.283, z = next_random(&random) * 0x1p-24;
        double r = sqrt(1 - z * z);
        samples[3 * i] = (uint8_t)lrint(127.5 * (r * cos(angle) + 1));
        samples[3 * i + 1] = (uint8_t)lrint(127.5 * (r * sin(angle) + 1));
        samples[3 * i + 2] = (uint8_t)lrint(127.5 * (z + 1));
    }
    SluiceBakeSettings settings = {.structSize = sizeof settings, .normalMap = true};
    write_png(f.in, samples, 130, 97, 3, false);
    bake_picture_file(f.in, f.out, &settings);
    assert_int_equal(store_info(f.out).layout.format, SLUICE_FORMAT_R8G8B8A8_UNORM);
    assert_int_equal(store_info(f.out).meaning, SLUICE_STORE_MEANING_NORMAL);
    for (uint32_t l = 1; l < 8; l++) {
        float *level = read_level(f.out, l, &width, &height);
        for (uint32_t i = 0; i < width * height; i++) {
            double length = 0;
            for (uint32_t c = 0; c < 3; c++)
                length += pow(2.0 * (double)level[4 * i + c] - 1, 2);
            /* half a step in each of three components */
            assert_true(fabs(sqrt(length) - 1) <= sqrt(3.0) / 255 + 1e-6);
        }
        free(level);
    }
    free(samples);
    bake_folder_finish(&f.folder);
}

static void normals_that_cancel_point_up(void **state)
{
    (void)state;
    struct fixture f;
    uint32_t width, height;
    const float texels[2][4] = {{1, 0, 0, 1}, {-1, 0, 0, 1}};
    struct plain_source source;
    SluiceBakeSettings settings = {.structSize = sizeof settings, .normalMap = true};
    fixture_init(&f);
    plain_source_init(&source, SLUICE_FORMAT_R32G32B32A32_SFLOAT, 2, 1, texels);
    bake_source(&source.base, f.out, &settings);
    float *level = read_level(f.out, 1, &width, &height);
    assert_true(level[0] == 0 && level[1] == 0 && level[2] == 1);
    free(level);
    bake_folder_finish(&f.folder);
}

/* Replacement of non-finite numbers as bake.h promises, in half and in 32-bit floats. */
static void numbers_that_are_none_become_some(void **state)
{
    (void)state;
    const float texels[8][4] = {{NAN, 1, 2, 1},        {INFINITY, 1, 2, 1}, {-INFINITY, 1, 2, 1},
                                {1e30f, 1, -1e30f, 1}, {1, 1, 1, NAN},      {FLT_MAX, 1, 1, 1},
                                {2, 2, 2, 1},          {3, 3, 3, 1}};
    const SluiceFormat formats[] = {SLUICE_FORMAT_R16G16B16A16_SFLOAT,
                                    SLUICE_FORMAT_R32G32B32A32_SFLOAT};
    for (int f = 0; f < 2; f++) {
        struct fixture fixture;
        struct plain_source source;
        uint32_t width, height;
        float limit = f ? 0x1p120f : 65504.0f, far = f ? 1e30f : 65504.0f;
        SluiceBakeSettings settings = {.structSize = sizeof settings, .format = formats[f]};
        SluiceBakerCreateInfo create = {.structSize = sizeof create, .threadCount = 1};
        SluiceBaker *baker;
        SluiceBakeReport report = {.structSize = sizeof report};
        fixture_init(&fixture);
        plain_source_init(&source, SLUICE_FORMAT_R32G32B32A32_SFLOAT, 8, 1, texels);
        SluiceBakeInfo info = {.structSize = sizeof info,
                               .source = &source.base,
                               .pOutputPath = fixture.out,
                               .pSettings = &settings};
        CHECK_OK(sluiceCreateBaker(&create, &baker));
        CHECK_OK(sluiceBakeFile(baker, &info, &report));
        sluiceDestroyBaker(baker);
        assert_int_equal(report.replacedTexelCount, f ? 4 : 6);
        assert_int_equal(report.nanTexelCount, 2);
        assert_int_equal(report.infiniteTexelCount, 2);
        assert_int_equal(report.clampedTexelCount, f ? 0 : 2);
        float *level = read_level(fixture.out, 0, &width, &height);
        const float expected[8][4] = {{0, 1, 2, 1},      {limit, 1, 2, 1},
                                      {-limit, 1, 2, 1}, {far, 1, -far, 1},
                                      {1, 1, 1, 0},      {f ? FLT_MAX : limit, 1, 1, 1},
                                      {2, 2, 2, 1},      {3, 3, 3, 1}};
        assert_memory_equal(level, expected, sizeof expected);
        free(level);
        for (uint32_t l = 1; l < 4; l++) {
            level = read_level(fixture.out, l, &width, &height);
            for (uint32_t i = 0; i < 4 * width; i++)
                assert_true(isfinite(level[i]) && (f || fabsf(level[i]) <= limit));
            free(level);
        }
        bake_folder_finish(&fixture.folder);
    }
}

/* Returns numbers of any size and sign. Every third is near the largest float. */
static float extreme_number(uint32_t *random)
{
    static const float most[] = {FLT_MAX, 0x1.fp127f, 0x1.8p126f, 0x1p121f};
    uint32_t bits = next_random(random);
    float value = bits % 3 ? ldexpf((float)(bits >> 4), (int)(bits % 240) - 140)
                           : most[bits / 3 % (sizeof most / sizeof most[0])];
    return bits & 8 ? -value : value;
}

/* Mean along one axis of the area that texel `i` of the level below covers. */
static long double mean_along(const float *values, uint32_t size, uint32_t i)
{
    uint32_t below = size > 1 ? size / 2 : 1;
    long double first = (long double)i * size / below, end = (long double)(i + 1) * size / below;
    long double sum = 0;
    for (uint32_t k = (uint32_t)first; k < size && (long double)k < end; k++) {
        long double from = first > k ? first : k, to = end < k + 1 ? end : k + 1;
        sum += (to - from) * (long double)values[4 * (size_t)k];
    }
    return sum * below / size;
}

static long double mean_of_texel(const float *above, uint32_t width, uint32_t height, uint32_t x,
                                 uint32_t y, uint32_t c, long double *size)
{
    uint32_t below = height > 1 ? height / 2 : 1;
    long double first = (long double)y * height / below,
                end = (long double)(y + 1) * height / below;
    long double sum = 0;
    *size = 0;
    for (uint32_t k = (uint32_t)first; k < height && (long double)k < end; k++) {
        long double from = first > k ? first : k, to = end < k + 1 ? end : k + 1;
        const float *row = above + (size_t)k * width * 4 + c;
        sum += (to - from) * mean_along(row, width, x);
        for (uint32_t i = 0; i < width; i++)
            *size = fmaxl(*size, fabsl((long double)row[4 * (size_t)i]));
    }
    return sum * below / height;
}

static void check_means_of_extremes(const char *path, uint32_t level_count)
{
    for (uint32_t l = 1; l < level_count; l++) {
        uint32_t width, height, w, h;
        float *above = read_level(path, l - 1, &width, &height),
              *level = read_level(path, l, &w, &h);
        for (uint32_t i = 0; i < 4 * w * h; i++) {
            long double size;
            long double mean =
                mean_of_texel(above, width, height, i / 4 % w, i / 4 / w, i % 4, &size);
            assert_true(isfinite(level[i]));
            if (fabsl((long double)level[i] - mean) > size * 1e-6L + 1e-44L)
                fail_msg("level %u value %u is %g, not %Lg", l, i, (double)level[i], mean);
        }
        free(above);
        free(level);
    }
}

static void finite_floats_are_kept_and_averaged_over_their_whole_range(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{16, 16}, {37, 21}, {7, 1}, {1, 9}};
    for (size_t s = 0; s < 2 * (sizeof sizes / sizeof sizes[0]); s++) {
        struct fixture fixture;
        struct plain_source source;
        uint32_t width = sizes[s / 2][0], height = sizes[s / 2][1], random = (uint32_t)s + 1;
        float *texels = malloc((size_t)width * height * 16);
        for (uint32_t i = 0; i < 4 * width * height; i++)
            texels[i] = extreme_number(&random);
        SluiceBakeSettings settings = {.structSize = sizeof settings,
                                       .filter = s % 2 ? SLUICE_BAKE_FILTER_KAISER
                                                       : SLUICE_BAKE_FILTER_BOX};
        fixture_init(&fixture);
        plain_source_init(&source, SLUICE_FORMAT_R32G32B32A32_SFLOAT, width, height, texels);
        bake_source(&source.base, fixture.out, &settings);
        uint32_t w, h, level_count = store_info(fixture.out).layout.mipLevelCount;
        float *level = read_level(fixture.out, 0, &w, &h);
        assert_memory_equal(level, texels, (size_t)width * height * 16);
        free(level);
        if (s % 2 == 0)
            check_means_of_extremes(fixture.out, level_count);
        for (uint32_t l = 1; l < level_count; l++) {
            level = read_level(fixture.out, l, &w, &h);
            for (uint32_t i = 0; i < 4 * w * h; i++)
                assert_true(isfinite(level[i]));
            free(level);
        }
        free(texels);
        bake_folder_finish(&fixture.folder);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_are_averaged_as_light),
        cmocka_unit_test(data_are_averaged_as_they_are),
        cmocka_unit_test(bytes_of_the_picture_are_kept),
        cmocka_unit_test(pictures_are_turned_as_exif_says),
        cmocka_unit_test(words_of_the_picture_are_kept),
        cmocka_unit_test(colors_count_as_much_as_they_cover),
        cmocka_unit_test(premultiplied_colors_are_averaged_as_they_are),
        cmocka_unit_test(normals_keep_their_length),
        cmocka_unit_test(normals_that_cancel_point_up),
        cmocka_unit_test(numbers_that_are_none_become_some),
        cmocka_unit_test(finite_floats_are_kept_and_averaged_over_their_whole_range),
    };
    return RUN_TESTS(tests);
}
