/* The cube flag of a store: its meaning, and refused files and writers. */
#include "store/naive_store.h"
#include "store/stores.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#define AT_MINOR 12
#define AT_CUBE 112

struct cube_file {
    struct scratch scratch;
    unsigned char *bytes;
    size_t size;
};

static SluiceStoreCreateInfo describe(const char *path, uint32_t layers, bool cube)
{
    return (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                   .pPath = path,
                                   .width = 150,
                                   .height = 150,
                                   .arrayLayerCount = layers,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                   .compressionLevel = 1,
                                   .cube = cube};
}

static void cube_file_init(struct cube_file *file, const SluiceStoreCreateInfo *given)
{
    scratch_init(&file->scratch);
    SluiceStoreCreateInfo info = *given;
    info.pPath = file->scratch.path;
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    file->bytes = read_bytes(file->scratch.path, &file->size);
}

static void cube_file_finish(struct cube_file *file)
{
    free(file->bytes);
    scratch_finish(&file->scratch);
}

static SluiceResult read_as_it_is(struct cube_file *file, struct messages *messages)
{
    naive_store_reseal(file->bytes, file->size);
    write_bytes(file->scratch.path, file->bytes, file->size);
    return read_store(file->scratch.path, PICTURE_MIXED, messages);
}

/* Returns the flag, and checks it in both infos. */
static bool is_cube(const char *path)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    SluiceStoreInfo info = {.structSize = sizeof info};
    SluiceImageInfo image = {.structSize = sizeof image};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetStoreInfo(source, &info));
    CHECK_OK(sluiceGetImageInfo(source, &image));
    assert_int_equal(info.cube, image.cube);
    sluiceDestroyImageSource(source);
    return info.cube;
}

static void a_store_says_whether_its_layers_are_faces(void **state)
{
    (void)state;
    for (int cube = 0; cube < 2; cube++) {
        struct cube_file file;
        struct messages messages;
        SluiceStoreCreateInfo info = describe(NULL, 12, cube);
        cube_file_init(&file, &info);
        assert_int_equal(is_cube(file.scratch.path), cube);
        assert_int_equal(file.bytes[AT_CUBE], cube);
        for (int i = 1; i < 16; i++)
            assert_int_equal(file.bytes[AT_CUBE + i], 0);
        CHECK_OK(read_as_it_is(&file, &messages));
        cube_file_finish(&file);
    }
}

static void a_store_of_version_1_0_is_no_cube(void **state)
{
    (void)state;
    struct cube_file file;
    struct messages messages;
    SluiceStoreCreateInfo info = describe(NULL, 6, false);
    cube_file_init(&file, &info);
    file.bytes[AT_MINOR] = 0;
    CHECK_OK(read_as_it_is(&file, &messages));
    assert_int_equal(messages.errors + messages.others, 0);
    assert_false(is_cube(file.scratch.path));
    cube_file_finish(&file);
}

static void a_flag_that_is_neither_0_nor_1_is_refused_with_its_value(void **state)
{
    (void)state;
    struct cube_file file;
    struct messages messages;
    SluiceStoreCreateInfo info = describe(NULL, 6, true);
    cube_file_init(&file, &info);
    file.bytes[AT_CUBE] = 7;
    CHECK_RESULT(read_as_it_is(&file, &messages), SLUICE_ERROR_CORRUPT_DATA);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last, file.scratch.path));
    assert_non_null(strstr(messages.last, "at 112: "));
    assert_non_null(strstr(messages.last, "the number is 7"));
    file.bytes[AT_MINOR] = SLUICE_STORE_VERSION_MINOR + 1; /* a later version may define 7 */
    CHECK_OK(read_as_it_is(&file, &messages));
    assert_false(is_cube(file.scratch.path));
    cube_file_finish(&file);
}

static void a_flag_on_layers_that_are_no_faces_is_refused(void **state)
{
    (void)state;
    struct cube_file file;
    struct messages messages;
    SluiceStoreCreateInfo info = describe(NULL, 5, false);
    cube_file_init(&file, &info);
    file.bytes[AT_CUBE] = 1;
    CHECK_RESULT(read_as_it_is(&file, &messages), SLUICE_ERROR_CORRUPT_DATA);
    assert_non_null(strstr(messages.last, "at 28: "));
    assert_non_null(strstr(messages.last, "no multiple of 6; the number is 5"));
    cube_file_finish(&file);

    info = describe(NULL, 6, false);
    info.height = 149;
    cube_file_init(&file, &info);
    file.bytes[AT_CUBE] = 1;
    CHECK_RESULT(read_as_it_is(&file, &messages), SLUICE_ERROR_CORRUPT_DATA);
    assert_non_null(strstr(messages.last, "not square; the number is 149"));
    cube_file_finish(&file);
}

static void writers_of_layers_that_are_no_faces_are_refused(void **state)
{
    (void)state;
    struct scratch scratch;
    struct messages messages = {0};
    SluiceStoreWriter *writer;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(scratch.path, 0, true);
    info.log = messages_log(&messages);
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(messages.last, "arrayLayerCount is 1"));
    info.arrayLayerCount = 6;
    info.height = 149;
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(messages.last, "width is 150, height 149"));
    assert_false(exists(scratch.part_path));
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_store_says_whether_its_layers_are_faces),
        cmocka_unit_test(a_store_of_version_1_0_is_no_cube),
        cmocka_unit_test(a_flag_that_is_neither_0_nor_1_is_refused_with_its_value),
        cmocka_unit_test(a_flag_on_layers_that_are_no_faces_is_refused),
        cmocka_unit_test(writers_of_layers_that_are_no_faces_are_refused),
    };
    return RUN_TESTS(tests);
}
