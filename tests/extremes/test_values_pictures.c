/*
 * Extreme half values on their way from an OpenEXR file through baker, store, streamer and shader
 * to a comparison of pictures. Checks each value at each stage.
 */
#include "bake/baked.h"
#include "device/scene.h"
#include "extremes/extremes.h"
#include "extremes/values.h"

#include "base/checked.h"
#include "image/convert.h"
#include "support/map_everything.h"
#include "support/test.h"

#include <sluice/exr.h>
#include <sluice/metrics.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Forms of the picture at its stages. */
enum form { FORM_FILE, FORM_HALF, FORM_FLOAT, FORM_BYTE, FORM_COUNT };

static const char *const form_names[FORM_COUNT] = {"file", "half", "float", "byte"};

struct fixture {
    struct harness *h;
    struct bake_folder folder;
    char exr[256], stores[FORM_COUNT][256];
};

static struct fixture fixture;

static float wanted(enum form form, uint32_t value)
{
    const struct value *v = &values[value];
    const float forms[FORM_COUNT] = {v->in_file, v->in_half, v->in_float, v->in_byte};
    return forms[form];
}

/* Valid until the next call. */
static const char *row_name(const char *stage, enum form form)
{
    static char name[64];
    snprintf(name, sizeof name, "values.%s.%s", stage, form_names[form]);
    return name;
}

static SluiceImageSource *open_form(enum form form)
{
    SluiceImageSource *source;
    SluiceExrImageSourceCreateInfo exr = {.structSize = sizeof exr, .pPath = fixture.exr};
    SluiceStoreImageSourceCreateInfo store = {.structSize = sizeof store,
                                              .pPath = fixture.stores[form]};
    if (form == FORM_FILE)
        CHECK_OK(sluiceCreateExrImageSource(&exr, &source));
    else
        CHECK_OK(sluiceCreateStoreImageSource(&store, &source));
    return source;
}

/* Returns level 0 as RGBA floats, allocated. */
static float *read_form(enum form form)
{
    SluiceImageSource *source = open_form(form);
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceImageRegion region = {0, 0, 0, VALUES_WIDTH, VALUES_HEIGHT, 0};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    size_t pitch = VALUES_WIDTH * sluiceGetFormatTexelSize(info.format);
    char *texels = malloc(pitch * VALUES_HEIGHT);
    float *rgba = malloc(4 * VALUES_TEXELS * sizeof *rgba);
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, pitch));
    slc_texels_to_rgba(info.format, texels, rgba, VALUES_TEXELS);
    free(texels);
    sluiceDestroyImageSource(source);
    return rgba;
}

static uint64_t bake(enum form form, SluiceFormat format)
{
    SluiceBakerCreateInfo create = {.structSize = sizeof create, .threadCount = 1};
    SluiceBakeInfo info = {
        .structSize = sizeof info, .pInputPath = fixture.exr, .pOutputPath = fixture.stores[form]};
    SluiceBakeReport report = {.structSize = sizeof report};
    SluiceBaker *baker;
    SluiceBakeSettings settings = {.structSize = sizeof settings, .format = format};
    info.pSettings = &settings;
    CHECK_OK(sluiceCreateBaker(&create, &baker));
    CHECK_OK(sluiceBakeFile(baker, &info, &report));
    sluiceDestroyBaker(baker);
    return report.replacedTexelCount;
}

static void write_pictures(void)
{
    SluiceImageSource source;
    SluiceExrWriteInfo info = {
        .structSize = sizeof info, .pPath = fixture.exr, .tileWidth = 64, .tileHeight = 64};
    bake_folder_init(&fixture.folder);
    bake_folder_file(&fixture.folder, "values.exr", fixture.exr);
    values_source_init(&source);
    CHECK_OK(sluiceWriteExrFile(&info, &source));
    for (int form = FORM_HALF; form < FORM_COUNT; form++)
        bake_folder_file(&fixture.folder, form_names[form], fixture.stores[form]);
    uint64_t replaced = bake(FORM_HALF, SLUICE_FORMAT_UNDEFINED), special = 0;
    for (uint32_t i = 0; i < VALUES_TEXELS; i++)
        special += !isfinite(values[value_at(0, i % VALUES_WIDTH, i / VALUES_WIDTH)].in_file);
    assert_int_equal(replaced, special);
    assert_int_equal(bake(FORM_FLOAT, SLUICE_FORMAT_R32G32B32A32_SFLOAT), special);
    bake(FORM_BYTE, SLUICE_FORMAT_R8G8B8A8_UNORM);
}

/* Compares bit by bit, except for the kind of NaN. */
static bool is_same(float got, float expected)
{
    return isnan(expected) ? isnan(got) : memcmp(&got, &expected, sizeof got) == 0;
}

static void files_and_stores_hold_what_is_documented(void **state)
{
    (void)state;
    for (int form = 0; form < FORM_COUNT; form++) {
        struct extremes_row row = {.name = row_name("stored", (enum form)form), .unit = "texels"};
        float *rgba = read_form((enum form)form);
        for (uint32_t i = 0; i < VALUES_TEXELS; i++) {
            uint32_t value = value_at(0, i % VALUES_WIDTH, i / VALUES_WIDTH);
            float expected = wanted((enum form)form, value);
            bool same = is_same(rgba[4 * i], expected) && is_same(rgba[4 * i + 1], expected) &&
                        rgba[4 * i + 2] == 1 && rgba[4 * i + 3] == 1;
            extremes_add(&row, !same, "%s in %s is %a", values[value].name, form_names[form],
                         (double)rgba[4 * i]);
        }
        free(rgba);
        extremes_end(&row);
    }
}

static void baked_levels_are_finite(void **state)
{
    (void)state;
    const float limits[FORM_COUNT] = {0, 65504, 0x1p120f, 1};
    for (int form = FORM_HALF; form < FORM_COUNT; form++)
        for (uint32_t level = 1; level < VALUES_LEVELS; level++) {
            uint32_t width, height;
            float *rgba = read_level(fixture.stores[form], level, &width, &height);
            for (uint32_t i = 0; i < 4 * width * height; i++)
                assert_true(fabsf(rgba[i]) <= limits[form]);
            free(rgba);
        }
}

struct dispatch {
    struct scene *scene;
    uint32_t texture, count, flags;
};

static void record(void *user, VkCommandBuffer commands)
{
    const struct dispatch *d = user;
    prober_record(&d->scene->prober, commands, d->scene->textures[d->texture].probe, 0, d->count,
                  d->flags);
}

static void run_probe(struct scene *scene, uint32_t texture, uint32_t count, uint32_t flags)
{
    struct dispatch d = {scene, texture, count, flags};
    harness_run(scene->h, record, &d);
}

/*
 * Vulkan lets shaders flush denormals to 0, and replace NaN and infinities by any value
 * ("Floating-point controls"). Values that are special in 32 bits may change; all others may not.
 */
static bool may_show(float got, float expected)
{
    if (isnan(expected) || isinf(expected))
        return true;
    if (got == 0 && fabsf(expected) < 0x1p-14f) /* denormal in a half */
        return true;
    return fabsf(got - expected) <= 1e-6f * fabsf(expected);
}

static void check_fetched(struct scene *scene, enum form form, uint32_t texture, float *shown)
{
    struct extremes_row row = {.name = row_name("fetched", form), .unit = "texels"};
    for (uint32_t i = 0; i < VALUES_TEXELS; i++)
        prober_inputs(&scene->prober)[i] =
            (struct ProbeInput){.uv = {(float)(i % VALUES_WIDTH), (float)(i / VALUES_WIDTH)}};
    run_probe(scene, texture, VALUES_TEXELS, PROBE_FETCH);
    const struct ProbeOutput *out = prober_outputs(&scene->prober);
    uint32_t kept = 0, special = 0;
    for (uint32_t i = 0; i < VALUES_TEXELS; i++) {
        uint32_t value = value_at(0, i % VALUES_WIDTH, i / VALUES_WIDTH);
        float expected = wanted(form, value), got = out[i].color[0];
        memcpy(shown + 4 * i, out[i].color, sizeof out[i].color);
        bool same = may_show(got, expected) && may_show(out[i].color[1], expected) &&
                    out[i].color[2] == 1 && out[i].color[3] == 1;
        special += !isfinite(expected);
        kept += !isfinite(expected) && (isnan(expected) ? isnan(got) : got == expected);
        extremes_add(&row, !same, "%s in %s is %a", values[value].name, form_names[form],
                     (double)got);
    }
    if (special)
        print_message("# %u of %u infinities and NaN are shown as they are\n", kept, special);
    extremes_end(&row);
}

/* Largest value among the texels that a filter may reach with coordinates one step off. */
static double largest_around(enum form form, uint32_t x, uint32_t y)
{
    double largest = 0;
    for (uint32_t i = 0; i < 12; i++) {
        uint32_t u = (x + i % 4 + VALUES_WIDTH - 1) % VALUES_WIDTH;
        uint32_t v = (y + i / 4 + VALUES_HEIGHT - 1) % VALUES_HEIGHT;
        largest = fmax(largest, fabs((double)wanted(form, value_at(0, u, v))));
    }
    return largest;
}

/* Samples half-way between two texels: no sum overflows. Errors are relative to the largest
 * value. */
static void check_filtered(struct scene *scene, enum form form, uint32_t texture)
{
    struct extremes_row row = {
        .name = row_name("filtered", form), .unit = "relative", .bound = 1.0 / 128};
    uint32_t count = 0;
    for (uint32_t y = 0; y < VALUES_HEIGHT; y++)
        for (uint32_t x = 0; x + 1 < VALUES_WIDTH; x++)
            prober_inputs(&scene->prober)[count++] = (struct ProbeInput){
                .uv = {(float)(x + 1) / VALUES_WIDTH, ((float)y + 0.5f) / VALUES_HEIGHT},
                .dx = {0.25f / VALUES_WIDTH, 0},
                .dy = {0, 0.25f / VALUES_HEIGHT},
                .maxAnisotropy = 1};
    run_probe(scene, texture, count, PROBE_SAMPLE);
    const struct ProbeOutput *out = prober_outputs(&scene->prober);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t x = i % (VALUES_WIDTH - 1), y = i / (VALUES_WIDTH - 1);
        double a = (double)wanted(form, value_at(0, x, y));
        double b = (double)wanted(form, value_at(0, x + 1, y));
        double error = fabs((double)out[i].color[0] - (a + b) / 2);
        extremes_add(&row, error / fmax(largest_around(form, x, y), 0x1p-13),
                     "%g and %g in %s are %g", a, b, form_names[form], (double)out[i].color[0]);
    }
    extremes_end(&row);
}

/* Divisions by 255 may be products, and denormals 0. FLIP grows with the root of a difference. */
#define SHOWN_TOLERANCE 1e-3

/* NaN counts as 0 and infinity as the largest value, so file and store look alike. */
static void check_alike(const float *a, const float *b, float peak, double tolerance)
{
    SluicePicturePair pair = {.structSize = sizeof pair,
                              .pA = a,
                              .pB = b,
                              .width = VALUES_WIDTH,
                              .height = VALUES_HEIGHT,
                              .format = SLUICE_PIXEL_FORMAT_RGBA32_FLOAT,
                              .peak = peak};
    double ssim, flip;
    CHECK_OK(sluiceComputeSsim(&pair, NULL, NULL, &ssim));
    CHECK_OK(sluiceComputeFlip(&pair, 0, NULL, NULL, &flip));
    if (!(ssim >= 1 - tolerance && flip <= tolerance))
        fail_msg("SSIM %g, FLIP %g", ssim, flip);
}

static void values_reach_shaders_and_metrics(void **state)
{
    (void)state;
    struct scene scene;
    scene_init(
        &scene, fixture.h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .pDebug = &map_everything});
    uint32_t textures[FORM_COUNT];
    for (int form = 0; form < FORM_COUNT; form++)
        textures[form] = scene_add(&scene, open_form((enum form)form));
    scene_settle(&scene, 24);
    for (int form = 0; form < FORM_COUNT; form++) {
        float *shown = malloc(4 * VALUES_TEXELS * sizeof *shown);
        float *file = read_form(FORM_FILE), *stored = read_form((enum form)form);
        check_fetched(&scene, (enum form)form, textures[form], shown);
        if (form != FORM_FILE) {
            check_filtered(&scene, (enum form)form, textures[form]);
            check_alike(shown, stored, form == FORM_FLOAT ? 0x1p120f : 65504.0f, SHOWN_TOLERANCE);
        }
        if (form == FORM_HALF)
            check_alike(file, stored, 65504.0f, 0);
        free(shown);
        free(file);
        free(stored);
    }
    scene_finish(&scene);
}

int main(int argc, char **argv)
{
    struct harness h;
    if (!extremes_begin(argc, argv))
        return 2;
    int status = harness_init(&h);
    if (status)
        return status;
    fixture.h = &h;
    write_pictures();
    struct CMUnitTest tests[] = {
        cmocka_unit_test(files_and_stores_hold_what_is_documented),
        cmocka_unit_test(baked_levels_are_finite),
        cmocka_unit_test(values_reach_shaders_and_metrics),
    };
    status = RUN_TESTS(tests);
    bake_folder_finish(&fixture.folder);
    return harness_finish(&h, status);
}
