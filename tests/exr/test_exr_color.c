/* Files that name their primaries. Expected Rec. 709 values are computed here in long double. */
#include <sluice/exr.h>

#include "exr/exr_paths.h"
#include "image/half.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef long double real;

/* x and y of red, green, blue, white */
static const real rec709[8] = {0.64L, 0.33L, 0.3L, 0.6L, 0.15L, 0.06L, 0.3127L, 0.329L};
static const real xyz[8] = {1, 0, 0, 1, 0, 0, 1 / 3.0L, 1 / 3.0L};
static const real rec2020[8] = {0.708L, 0.292L, 0.17L, 0.797L, 0.131L, 0.046L, 0.3127L, 0.329L};
static const real aces[8] = {0.7347L, 0.2653L, 0, 1, 0.0001L, -0.077L, 0.32168L, 0.33767L};

static real determinant(real m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* Solves matrix * x = right by Cramer's rule. */
static void solve(real matrix[3][3], const real right[3], real x[3])
{
    for (int k = 0; k < 3; k++) {
        real changed[3][3];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                changed[i][j] = j == k ? right[i] : matrix[i][j];
        x[k] = determinant(changed) / determinant(matrix);
    }
}

static void to_xyz(const real *xy, real luminance, real result[3])
{
    result[0] = xy[0] / xy[1] * luminance;
    result[1] = luminance;
    result[2] = (1 - xy[0] - xy[1]) / xy[1] * luminance;
}

/* Columns: tristimulus values of red, green and blue that add up to white. */
static void find_basis(const real space[8], real basis[3][3])
{
    real white[3], share[3];
    for (int k = 0; k < 3; k++) {
        basis[0][k] = space[2 * k];
        basis[1][k] = space[2 * k + 1];
        basis[2][k] = 1 - space[2 * k] - space[2 * k + 1];
    }
    to_xyz(space + 6, 1, white);
    solve(basis, white, share);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            basis[i][k] *= share[k];
}

/* Lam's responses, known as Bradford's */
static real cones[3][3] = {
    {0.8951L, 0.2664L, -0.1614L}, {-0.7502L, 1.7135L, 0.0367L}, {0.0389L, -0.0685L, 1.0296L}};

static void apply(real matrix[3][3], const real in[3], real out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = matrix[i][0] * in[0] + matrix[i][1] * in[1] + matrix[i][2] * in[2];
}

static void convert(const real space[8], const real *neutral, const real rgb[3], real result[3])
{
    real basis[3][3], light[3], response[3], from[3], to[3], white[3];
    find_basis(space, basis);
    apply(basis, rgb, light);
    to_xyz(neutral, 1, white);
    apply(cones, white, from);
    to_xyz(rec709 + 6, 1, white);
    apply(cones, white, to);
    apply(cones, light, response);
    for (int i = 0; i < 3; i++)
        response[i] *= to[i] / from[i];
    solve(cones, response, light);
    find_basis(rec709, basis);
    solve(basis, light, result);
}

struct colored {
    const char *name;
    const real *space, *neutral; ///< neutral: color that becomes R = G = B
    uint32_t level_count;        ///< levels in the file
    bool has_alpha;
};

static const real d50[2] = {0.3457L, 0.3585L};

static const struct colored files[] = {
    {"scan_xyz.exr", xyz, rec709 + 6, 1, false}, /* nothing is adapted */
    {"scan_rec2020.exr", rec2020, rec2020 + 6, 1, true},  {"mip_aces.exr", aces, aces + 6, 6, true},
    {"scan_aces_neutral.exr", aces, rec709 + 6, 1, true}, /* as in its adoptedNeutral */
    {"scan_neutral_alone.exr", rec709, d50, 1, false},
};

/* Formula of tests/exr/data/README.md for a texel. */
static real formula(uint32_t level, uint32_t x, uint32_t y, uint32_t k)
{
    return (real)((3 * x + 5 * y + 18 * level + 13 * k) % 64) / 16 - 1;
}

static SluiceImageSource *open_file(const char *name, SluiceFormat format, bool keep)
{
    char path[1024];
    SluiceImageSource *source;
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = own_file(name, path),
                                             .format = format,
                                             .keepPrimaries = keep};
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    return source;
}

enum { WIDTH = 37, HEIGHT = 21 };

static uint32_t at_least_1(uint32_t size)
{
    return size ? size : 1;
}

static SluiceImageRegion level_region(uint32_t level)
{
    return (SluiceImageRegion){level, 0, 0, at_least_1(WIDTH >> level), at_least_1(HEIGHT >> level),
                               0};
}

static void expect_color(const struct colored *file, uint32_t level, uint32_t x, uint32_t y,
                         real rgba[4])
{
    real rgb[3];
    for (uint32_t k = 0; k < 3; k++)
        rgb[k] = formula(level, x, y, k);
    convert(file->space, file->neutral, rgb, rgba);
    rgba[3] = file->has_alpha ? formula(level, x, y, 3) : 1;
}

static void primaries_are_converted_to_those_of_rec709(void **state)
{
    (void)state;
    for (size_t f = 0; f < sizeof files / sizeof files[0]; f++)
        for (uint32_t level = 0; level < files[f].level_count; level++) {
            static float texels[WIDTH * HEIGHT][4];
            SluiceImageSource *source =
                open_file(files[f].name, SLUICE_FORMAT_R32G32B32A32_SFLOAT, false);
            SluiceImageRegion region = level_region(level);
            CHECK_OK(sluiceReadImageRegion(source, &region, texels, 16 * region.width));
            for (uint32_t i = 0; i < region.width * region.height; i++) {
                real expected[4];
                expect_color(&files[f], level, i % region.width, i / region.width, expected);
                for (int c = 0; c < 4; c++) /* the file's chromaticities are floats */
                    if (fabsl((real)texels[i][c] - expected[c]) > 4e-6L)
                        fail_msg("%s level %u texel %u component %d: %g, not %Lg", files[f].name,
                                 level, i, c, (double)texels[i][c], expected[c]);
            }
            sluiceDestroyImageSource(source);
        }
}

/* ITU-R BT.2087 and IEC 61966-2-1 print these to four and more digits. */
static void the_matrices_are_those_in_print(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double matrix[3][3];
    } printed[] = {
        {"scan_rec2020.exr",
         {{1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}}},
        {"scan_xyz.exr",
         {{3.2410, -1.5374, -0.4986}, {-0.9692, 1.8760, 0.0416}, {0.0556, -0.2040, 1.0570}}},
    };
    for (size_t f = 0; f < sizeof printed / sizeof printed[0]; f++) {
        static float texels[WIDTH * HEIGHT][4];
        SluiceImageSource *source =
            open_file(printed[f].name, SLUICE_FORMAT_R32G32B32A32_SFLOAT, false);
        SluiceImageRegion region = level_region(0);
        CHECK_OK(sluiceReadImageRegion(source, &region, texels, 16 * WIDTH));
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
            for (int c = 0; c < 3; c++) {
                double expected = 0;
                for (uint32_t k = 0; k < 3; k++)
                    expected +=
                        printed[f].matrix[c][k] * (double)formula(0, i % WIDTH, i / WIDTH, k);
                assert_true(fabs((double)texels[i][c] - expected) < 5e-4);
            }
        sluiceDestroyImageSource(source);
    }
}

static void other_formats_hold_the_converted_colors(void **state)
{
    (void)state;
    static uint16_t halves[WIDTH * HEIGHT][4];
    static uint8_t bytes[WIDTH * HEIGHT][4], reds[WIDTH * HEIGHT];
    const struct colored *file = &files[2];
    SluiceImageSource *half = open_file(file->name, SLUICE_FORMAT_UNDEFINED, false);
    SluiceImageSource *srgb = open_file(file->name, SLUICE_FORMAT_R8G8B8A8_SRGB, false);
    SluiceImageSource *red = open_file(file->name, SLUICE_FORMAT_R8_UNORM, false);
    SluiceImageRegion region = level_region(0);
    CHECK_OK(sluiceReadImageRegion(half, &region, halves, 8 * WIDTH));
    CHECK_OK(sluiceReadImageRegion(srgb, &region, bytes, 4 * WIDTH));
    CHECK_OK(sluiceReadImageRegion(red, &region, reds, WIDTH));
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        real expected[4];
        expect_color(file, 0, i % WIDTH, i / WIDTH, expected);
        for (int c = 0; c < 4; c++) {
            real value = (real)slc_float_from_half(halves[i][c]);
            assert_true(fabsl(value - expected[c]) <= fabsl(expected[c]) * 0x1p-11L + 4e-6L);
            real clamped = fminl(fmaxl(expected[c], 0), 1);
            real code = c == 3                  ? clamped
                        : clamped <= 0.0031308L ? clamped * 12.92L
                                                : 1.055L * powl(clamped, 1 / 2.4L) - 0.055L;
            assert_true(fabsl(code * 255 - bytes[i][c]) <= 0.51L);
            assert_true(c != 0 || fabsl(clamped * 255 - reds[i]) <= 0.51L);
        }
    }
    sluiceDestroyImageSource(half);
    sluiceDestroyImageSource(srgb);
    sluiceDestroyImageSource(red);
}

/* Files with Rec. 709 or invalid primaries, gray files, and files whose primaries are to be
 * kept. */
static void other_files_keep_their_bits(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        bool keep, is_gray;
    } cases[] = {{"scan_rec709.exr", false, false},
                 {"scan_no_primaries.exr", false, false},
                 {"scan_rec2020_grey.exr", false, true},
                 {"mip_aces.exr", true, false}};
    for (size_t f = 0; f < sizeof cases / sizeof cases[0]; f++) {
        static float texels[WIDTH * HEIGHT][4];
        SluiceExrInfo info = {.structSize = sizeof info};
        SluiceImageSource *source =
            open_file(cases[f].name, SLUICE_FORMAT_R32G32B32A32_SFLOAT, cases[f].keep);
        CHECK_OK(sluiceGetExrInfo(source, &info));
        assert_true(info.hasChromaticities && !info.convertsPrimaries);
        SluiceImageRegion region = level_region(0);
        CHECK_OK(sluiceReadImageRegion(source, &region, texels, 16 * WIDTH));
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
            for (uint32_t c = 0; c < (cases[f].is_gray ? 3u : 4u); c++)
                assert_true((real)texels[i][c] ==
                            formula(0, i % WIDTH, i / WIDTH, cases[f].is_gray ? 4 : c));
        sluiceDestroyImageSource(source);
    }
}

static void colors_that_are_no_numbers_stay_as_they_are(void **state)
{
    (void)state;
    uint16_t texels[4][4];
    SluiceImageSource *source = open_file("scan_aces_special.exr", SLUICE_FORMAT_UNDEFINED, false);
    SluiceImageRegion region = {.width = 4, .height = 1};
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, sizeof texels));
    const uint16_t first[4] = {0x7C00, 0x3C00, 0x4000, 0x3C00};
    assert_memory_equal(texels[0], first, sizeof first);
    assert_int_equal(texels[1][0], 0x3C00);
    assert_true((texels[1][1] & 0x7FFF) > 0x7C00);
    assert_int_equal(texels[1][2], 0xFC00);
    assert_int_equal(texels[2][0], 0x7BFF); /* 165170, saturated */
    assert_true((texels[2][1] & 0x8000) && (texels[2][1] & 0x7FFF) < 0x7BFF); /* -18110 */
    const uint16_t white[4] = {0x3C00, 0x3C00, 0x3C00, 0x3C00};
    assert_memory_equal(texels[3], white, sizeof white);
    sluiceDestroyImageSource(source);
}

struct messages {
    char text[1024];
    int warnings, news;
};

static void keep_message(void *user, SluiceLogSeverity severity, const char *text)
{
    struct messages *messages = user;
    snprintf(messages->text, sizeof messages->text, "%s", text);
    messages->warnings += severity != SLUICE_LOG_INFO;
    messages->news += severity == SLUICE_LOG_INFO;
}

static void what_is_not_applied_is_said_once(void **state)
{
    (void)state;
    static const struct {
        const char *name, *words;
        int warnings, news;
    } cases[] = {{"scan_no_primaries.exr", "are no primaries", 1, 0},
                 {"scan_aces_neutral.exr", "white has 100 cd/m2", 0, 1},
                 {"mip_aces.exr", "", 0, 0}};
    for (size_t f = 0; f < sizeof cases / sizeof cases[0]; f++) {
        char path[1024];
        struct messages messages = {0};
        SluiceImageSource *source;
        SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                                 .pPath = own_file(cases[f].name, path),
                                                 .log = {&messages, keep_message}};
        CHECK_OK(sluiceCreateExrImageSource(&create, &source));
        assert_int_equal(messages.warnings, cases[f].warnings);
        assert_int_equal(messages.news, cases[f].news);
        assert_non_null(strstr(messages.text, cases[f].words));
        sluiceDestroyImageSource(source);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(primaries_are_converted_to_those_of_rec709),
        cmocka_unit_test(the_matrices_are_those_in_print),
        cmocka_unit_test(other_formats_hold_the_converted_colors),
        cmocka_unit_test(other_files_keep_their_bits),
        cmocka_unit_test(colors_that_are_no_numbers_stay_as_they_are),
        cmocka_unit_test(what_is_not_applied_is_said_once),
    };
    return RUN_TESTS(tests);
}
