#include <sluice/dds.h>

#include "container/container_checks.h"
#include "support/test.h"

static SluiceImageSource *open_dds(const char *path, SluiceFormat format, struct log_tally *tally)
{
    SluiceDdsImageSourceCreateInfo info = {
        .structSize = sizeof info, .pPath = path, .format = format};
    if (tally) {
        *tally = (struct log_tally){.path = path};
        info.log = log_to(tally);
    }
    SluiceImageSource *source = NULL;
    CHECK_OK(sluiceCreateDdsImageSource(&info, &source));
    return source;
}

static void every_dxgi_format_is_delivered_as_it_is(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < format_names_count; i++) {
        struct picture picture = {&format_names[i], 37, 70};
        if (picture.format->dxgi)
            check_file(make_dds(&picture), &picture, open_dds);
    }
}

static void every_size_and_array_is_delivered(void **state)
{
    (void)state;
    static const SluiceFormat formats[] = {SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK,
                                           SLUICE_FORMAT_BC7_SRGB_BLOCK, SLUICE_FORMAT_R8_UNORM,
                                           SLUICE_FORMAT_R8G8B8A8_SRGB};
    for (size_t i = 0; i < picture_shapes_count; i++)
        for (size_t k = 0; k < sizeof formats / sizeof formats[0]; k++) {
            struct picture picture = picture_shapes[i];
            picture.format = format_names_of(formats[k]);
            check_file(make_dds(&picture), &picture, open_dds);
        }
}

#define FOUR_CC(text)                                                                              \
    (uint32_t)(text)[0] | (uint32_t)(text)[1] << 8 | (uint32_t)(text)[2] << 16 |                   \
        (uint32_t)(text)[3] << 24

static void old_names_are_understood(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t number;
        SluiceFormat format;
    } names[] = {
        {"DXT1", 0, SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK},
        {"DXT2", 0, SLUICE_FORMAT_BC2_UNORM_BLOCK},
        {"DXT3", 0, SLUICE_FORMAT_BC2_UNORM_BLOCK},
        {"DXT4", 0, SLUICE_FORMAT_BC3_UNORM_BLOCK},
        {"DXT5", 0, SLUICE_FORMAT_BC3_UNORM_BLOCK},
        {"ATI1", 0, SLUICE_FORMAT_BC4_UNORM_BLOCK},
        {"BC4U", 0, SLUICE_FORMAT_BC4_UNORM_BLOCK},
        {"BC4S", 0, SLUICE_FORMAT_BC4_SNORM_BLOCK},
        {"ATI2", 0, SLUICE_FORMAT_BC5_UNORM_BLOCK},
        {"BC5U", 0, SLUICE_FORMAT_BC5_UNORM_BLOCK},
        {"BC5S", 0, SLUICE_FORMAT_BC5_SNORM_BLOCK},
        {NULL, 111, SLUICE_FORMAT_R16_SFLOAT},
        {NULL, 112, SLUICE_FORMAT_R16G16_SFLOAT},
        {NULL, 113, SLUICE_FORMAT_R16G16B16A16_SFLOAT},
        {NULL, 114, SLUICE_FORMAT_R32_SFLOAT},
        {NULL, 115, SLUICE_FORMAT_R32G32_SFLOAT},
        {NULL, 116, SLUICE_FORMAT_R32G32B32A32_SFLOAT},
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct picture picture = {format_names_of(names[i].format), 33, 18};
        uint32_t code = names[i].name ? FOUR_CC(names[i].name) : names[i].number;
        check_file(make_old_dds(&picture, (uint32_t[7]){0x4, code}), &picture, open_dds);
    }
}

static void masks_are_understood(void **state)
{
    (void)state;
    struct format_names plain = *format_names_of(SLUICE_FORMAT_R8G8B8A8_UNORM);
    struct format_names bgra = plain, rgbx = plain, bgrx = plain;
    bgra.is_bgra = bgrx.is_bgra = true;
    rgbx.is_opaque = bgrx.is_opaque = true;
    const struct {
        uint32_t pixel_format[7];
        const struct format_names *format;
    } masks[] = {
        {{0x41, 0, 32, 0xFF, 0xFF00, 0xFF0000, 0xFF000000}, &plain},
        {{0x41, 0, 32, 0xFF0000, 0xFF00, 0xFF, 0xFF000000}, &bgra},
        {{0x40, 0, 32, 0xFF, 0xFF00, 0xFF0000, 0}, &rgbx},
        {{0x40, 0, 32, 0xFF0000, 0xFF00, 0xFF, 0xFF000000}, &bgrx}, /* alpha is not announced */
        {{0x40, 0, 16, 0xFF, 0xFF00, 0, 0}, format_names_of(SLUICE_FORMAT_R8G8_UNORM)},
        {{0x40, 0, 8, 0xFF, 0, 0, 0}, format_names_of(SLUICE_FORMAT_R8_UNORM)},
        {{0x20000, 0, 8, 0xFF, 0, 0, 0}, format_names_of(SLUICE_FORMAT_R8_UNORM)},
        {{0x20000, 0, 8, 0xFF, 0xFF, 0xFF, 0}, format_names_of(SLUICE_FORMAT_R8_UNORM)},
        {{0x20001, 0, 16, 0xFF, 0, 0, 0xFF00}, format_names_of(SLUICE_FORMAT_R8G8_UNORM)},
    };
    for (size_t i = 0; i < sizeof masks / sizeof masks[0]; i++) {
        /* wider than the pieces in which texels are changed */
        struct picture picture = {masks[i].format, 1500, 3};
        check_file(make_old_dds(&picture, masks[i].pixel_format), &picture, open_dds);
    }
}

static void old_cube_maps_have_six_layers(void **state)
{
    (void)state;
    struct picture picture = {format_names_of(SLUICE_FORMAT_BC3_UNORM_BLOCK), 32, 32, 0, true};
    check_file(make_old_dds(&picture, (uint32_t[7]){0x4, FOUR_CC("DXT5")}), &picture, open_dds);
}

static void a_format_of_the_same_bytes_can_be_asked_for(void **state)
{
    (void)state;
    struct picture picture = {format_names_of(SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK), 24, 24};
    check_renaming(make_old_dds(&picture, (uint32_t[7]){0x4, FOUR_CC("DXT1")}), &picture, open_dds,
                   SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK, SLUICE_FORMAT_BC4_UNORM_BLOCK);
}

static void chains_that_lack_levels_are_delivered_as_they_are(void **state)
{
    (void)state;
    for (uint32_t count = 1; count < 6; count++) {
        struct picture picture = {format_names_of(SLUICE_FORMAT_BC3_UNORM_BLOCK), 40, 20};
        picture.level_count = count;
        picture.layer_count = count;
        check_file(make_dds(&picture), &picture, open_dds);
    }
}

static void what_cannot_be_delivered_is_refused_with_a_reason(void **state)
{
    (void)state;
    static const struct refusal old[] = {
        {0, 0x20534445, SLUICE_ERROR_CORRUPT_DATA, "not a DDS file"},
        {4, 123, SLUICE_ERROR_CORRUPT_DATA, "header of 123"},
        {76, 0, SLUICE_ERROR_CORRUPT_DATA, "format of 0"},
        {16, 0, SLUICE_ERROR_CORRUPT_DATA, "0 x 32 texels"},
        {12, 0x80000000u, SLUICE_ERROR_UNSUPPORTED, "at most 1048576"},
        {28, 7, SLUICE_ERROR_CORRUPT_DATA, "has 7 levels"},
        {28, 0xFFFFFFFFu, SLUICE_ERROR_CORRUPT_DATA, "levels"},
        {16, 33, SLUICE_ERROR_CORRUPT_DATA, "need"},
        {84, FOUR_CC("RXGB"), SLUICE_ERROR_UNSUPPORTED, "RXGB"},
        {84, FOUR_CC("D\n\x01\xFF"), SLUICE_ERROR_UNSUPPORTED, "D???"},
        {80, 0x40, SLUICE_ERROR_UNSUPPORTED, "masks"},
        {112, 0x200000, SLUICE_ERROR_UNSUPPORTED, "volume"},
        {8, 0x821007, SLUICE_ERROR_UNSUPPORTED, "volume", 24, 4},
        {112, 0x200 | 0x400, SLUICE_ERROR_UNSUPPORTED, "all six"},
        {112, 0xFE00, SLUICE_ERROR_CORRUPT_DATA, "6 layers"},
        {112, 0xFE00, SLUICE_ERROR_CORRUPT_DATA, "16 x 32 texels; faces", 16, 16},
    };
    static const struct refusal dx10[] = {
        {128, 70, SLUICE_ERROR_UNSUPPORTED, "DXGI format 70"},
        {132, 4, SLUICE_ERROR_UNSUPPORTED, "dimension 4"},
        {132, 2, SLUICE_ERROR_UNSUPPORTED, "dimension 2"},
        {140, 0, SLUICE_ERROR_CORRUPT_DATA, "0 layers"},
        {140, 2, SLUICE_ERROR_CORRUPT_DATA, "2 layers"},
        {140, 65537, SLUICE_ERROR_UNSUPPORTED, "65537 layers"},
        {140, 0xFFFFFFFFu, SLUICE_ERROR_UNSUPPORTED, "layers", 136, 4},
    };
    struct picture picture = {format_names_of(SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK), 32, 32};
    check_refusals(make_old_dds(&picture, (uint32_t[7]){0x4, FOUR_CC("DXT1")}), open_dds, old,
                   sizeof old / sizeof old[0]);
    check_refusals(make_dds(&picture), open_dds, dx10, sizeof dx10 / sizeof dx10[0]);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    SluiceImageSource *source = NULL;
    SluiceDdsImageSourceCreateInfo info = {.structSize = sizeof info, .pPath = "x"};
    CHECK_RESULT(sluiceCreateDdsImageSource(NULL, &source), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceCreateDdsImageSource(&info, NULL), SLUICE_ERROR_NULL_POINTER);
    info.format = SLUICE_FORMAT_COUNT;
    CHECK_RESULT(sluiceCreateDdsImageSource(&info, &source), SLUICE_ERROR_INVALID_ARGUMENT);
    info = (SluiceDdsImageSourceCreateInfo){.structSize = sizeof(SluiceDdsImageSourceCreateInfo)};
    CHECK_RESULT(sluiceCreateDdsImageSource(&info, &source), SLUICE_ERROR_NULL_POINTER);
    assert_null(source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_dxgi_format_is_delivered_as_it_is),
        cmocka_unit_test(every_size_and_array_is_delivered),
        cmocka_unit_test(old_names_are_understood),
        cmocka_unit_test(masks_are_understood),
        cmocka_unit_test(old_cube_maps_have_six_layers),
        cmocka_unit_test(a_format_of_the_same_bytes_can_be_asked_for),
        cmocka_unit_test(chains_that_lack_levels_are_delivered_as_they_are),
        cmocka_unit_test(what_cannot_be_delivered_is_refused_with_a_reason),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return RUN_TESTS(tests);
}
