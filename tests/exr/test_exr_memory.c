/* How much memory a file may take: what its header says is bounded before any of it is allocated.
 */
#define _XOPEN_SOURCE 700

#include <sluice/exr.h>

#include "exr/exr_paths.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct message {
    char text[1024];
    int errors;
};

static void keep_error(void *user, SluiceLogSeverity severity, const char *text)
{
    struct message *message = user;
    if (severity != SLUICE_LOG_ERROR)
        return;
    snprintf(message->text, sizeof message->text, "%s", text);
    message->errors++;
}

static void check_words(const struct message *message, const char *const *words)
{
    assert_int_equal(message->errors, 1);
    for (; *words; words++)
        if (!strstr(message->text, *words))
            fail_msg("'%s' does not say '%s'", message->text, *words);
}

/* A copy of a file of tests/exr/data with another attribute and `size` bytes. */
struct bomb {
    char path[64];
};

static void bomb_init(struct bomb *bomb, const char *name)
{
    char path[1024];
    static char bytes[1 << 16];
    FILE *file = fopen(own_file(name, path), "rb");
    assert_non_null(file);
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    strcpy(bomb->path, "/tmp/sluice-bomb-XXXXXX");
    int descriptor = mkstemp(bomb->path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, bytes, size), size);
    assert_int_equal(ftruncate(descriptor, 1 << 21), 0); /* a hole: as much as was compressed */
    close(descriptor);
}

/* `attribute`: its name, a zero and its type. */
static void bomb_set(struct bomb *bomb, const char *attribute, size_t length, const void *value,
                     size_t size)
{
    static char bytes[1 << 12];
    FILE *file = fopen(bomb->path, "r+b");
    assert_non_null(file);
    assert_int_equal(fread(bytes, 1, sizeof bytes, file), sizeof bytes);
    size_t at = 0;
    while (memcmp(bytes + at, attribute, length) != 0)
        at++;
    fseek(file, (long)(at + length + 4), SEEK_SET);
    assert_int_equal(fwrite(value, 1, size, file), size);
    fclose(file);
}

static void bomb_resize(struct bomb *bomb, int32_t size)
{
    const int32_t window[4] = {0, 0, size - 1, size - 1};
    bomb_set(bomb, "dataWindow\0box2i", 17, window, sizeof window);
}

static void large_files_without_levels_are_refused_with_a_way_out(void **state)
{
    (void)state;
    struct bomb bomb;
    struct message message = {0};
    SluiceImageSource *source = NULL;
    SluiceExrInfo info = {.structSize = sizeof info};
    bomb_init(&bomb, "scan_zip.exr");
    bomb_resize(&bomb, 16384);
    SluiceExrImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = bomb.path, .log = {&message, keep_error}};
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_LIMIT_EXCEEDED);
    assert_null(source);
    const char *words[] = {
        bomb.path,       "16384 x 16384",           "scanlines", "2738 MiB", "512 MiB",
        "maxMemorySize", "sluice-bake FILE -o DIR", NULL};
    check_words(&message, words);
    create.maxMemorySize = (uint64_t)3 << 30;
    CHECK_OK(sluiceCreateExrImageSource(&create, &source)); /* and nothing was read */
    CHECK_OK(sluiceGetExrInfo(source, &info));
    assert_int_equal(info.chainSize / 1000000, 2864);
    sluiceDestroyImageSource(source);
    create.maxMemorySize = 0;
    create.levelZeroAlone = true;
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    CHECK_OK(sluiceGetExrInfo(source, &info));
    assert_int_equal(info.chainSize, 0);
    assert_int_equal(info.readSize, 3 * 16384 * 16 * 8);
    sluiceDestroyImageSource(source);
    unlink(bomb.path);
}

static void large_tiles_are_refused_with_a_way_out(void **state)
{
    (void)state;
    static const char *const names[] = {"one_level.exr", "mip_zip.exr", "rip_down.exr"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct bomb bomb;
        struct message message = {0};
        SluiceImageSource *source;
        const uint32_t tile[2] = {8192, 8192};
        bomb_init(&bomb, names[i]);
        bomb_resize(&bomb, 8192);
        bomb_set(&bomb, "tiles\0tiledesc", 15, tile, sizeof tile);
        SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                                 .pPath = bomb.path,
                                                 .log = {&message, keep_error},
                                                 .levelZeroAlone = i == 0};
        CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_LIMIT_EXCEEDED);
        const char *words[] = {"8192 x 8192", "1536 MiB", "512 MiB", "smaller tiles", NULL};
        check_words(&message, words);
        unlink(bomb.path);
    }
}

static void a_file_that_needs_no_more_than_the_limit_is_read(void **state)
{
    (void)state;
    char path[1024], texels[37 * 21 * 8];
    struct failing_allocator allocator;
    SluiceImageSource *source;
    SluiceExrInfo info = {.structSize = sizeof info};
    failing_allocator_init(&allocator, UINT64_MAX);
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = own_file("scan_zip.exr", path),
                                             .pAllocator = &allocator.callbacks};
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    CHECK_OK(sluiceGetExrInfo(source, &info));
    sluiceDestroyImageSource(source);
    struct message message = {0};
    create.log = (SluiceLogCallback){&message, keep_error};
    create.maxMemorySize = info.chainSize + info.readSize - 1;
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &source), SLUICE_ERROR_LIMIT_EXCEEDED);
    check_words(&message, (const char *[]){"take 1 MiB", "is 0 MiB", NULL}); /* not 1 and 1 */
    create.maxMemorySize++;
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    uint64_t before = allocator.live_bytes;
    SluiceImageRegion region = {.width = 37, .height = 21};
    CHECK_OK(sluiceReadImageRegion(source, &region, texels, 37 * 8));
    uint64_t held = allocator.live_bytes - before;
    assert_true(held > 37 * 21 * 8 && held <= info.chainSize);
    sluiceDestroyImageSource(source);
    assert_int_equal(allocator.live_bytes, 0);
}

static void sources_share_a_budget_until_they_are_destroyed(void **state)
{
    (void)state;
    char path[1024];
    struct message message = {0};
    SluiceImageSource *first, *second, *tiled;
    SluiceExrMemoryBudget *budget;
    SluiceExrInfo info = {.structSize = sizeof info};
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = own_file("scan_zip.exr", path),
                                             .log = {&message, keep_error}};
    CHECK_OK(sluiceCreateExrImageSource(&create, &first));
    CHECK_OK(sluiceGetExrInfo(first, &info));
    sluiceDestroyImageSource(first);
    CHECK_OK(sluiceCreateExrMemoryBudget(2 * info.chainSize - 1, NULL, &budget));
    create.memoryBudget = budget;
    create.maxMemorySize = 1 << 20;
    CHECK_OK(sluiceCreateExrImageSource(&create, &first));
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &second), SLUICE_ERROR_LIMIT_EXCEEDED);
    const char *words[] = {"37 x 21", "share", "sluice-bake FILE -o DIR", NULL};
    check_words(&message, words);
    create.levelZeroAlone = true;
    CHECK_OK(sluiceCreateExrImageSource(&create, &tiled));
    sluiceDestroyImageSource(tiled);
    create.levelZeroAlone = false;
    create.pPath = own_file("mip_zip.exr", path);
    CHECK_OK(sluiceCreateExrImageSource(&create, &tiled));
    sluiceDestroyImageSource(tiled);
    create.pPath = own_file("scan_zip.exr", path);
    sluiceDestroyImageSource(first);
    CHECK_OK(sluiceCreateExrImageSource(&create, &second));
    sluiceDestroyImageSource(second);
    create.pPath = own_file("scan_layered.exr", path); /* a refused one has taken nothing */
    CHECK_RESULT(sluiceCreateExrImageSource(&create, &second), SLUICE_ERROR_UNSUPPORTED);
    sluiceDestroyExrMemoryBudget(budget);
}

static void what_is_in_a_file_is_told_without_reading_it(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        SluiceExrStorage storage;
        uint32_t width, height;
        const char *compression, *channels;
    } files[] = {
        {"scan_piz.exr", SLUICE_EXR_STORAGE_SCANLINES, 37, 32, "PIZ", "A, B, G, R"},
        {"scan_depth.exr", SLUICE_EXR_STORAGE_SCANLINES, 8, 16, "ZIP", "B, G, R, Z"},
        {"one_level.exr", SLUICE_EXR_STORAGE_TILES, 16, 8, "ZIP", "A, B, G, R"},
        {"mip_b44a.exr", SLUICE_EXR_STORAGE_MIP_TILES, 16, 8, "B44A", "A, B, G, R"},
        {"rip_wide.exr", SLUICE_EXR_STORAGE_RIP_TILES, 8, 2, "NONE", "Y"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char path[1024];
        SluiceImageSource *source;
        SluiceExrInfo info = {.structSize = sizeof info};
        struct failing_allocator memory;
        failing_allocator_init(&memory, UINT64_MAX);
        SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                                 .pPath = own_file(files[i].name, path),
                                                 .pAllocator = &memory.callbacks};
        CHECK_OK(sluiceCreateExrImageSource(&create, &source));
        memory.refuse_from = 0;
        uint64_t calls = memory.calls;
        CHECK_OK(sluiceGetExrInfo(source, &info));
        assert_int_equal(memory.calls, calls);
        assert_int_equal(info.storage, files[i].storage);
        assert_int_equal(info.chunkWidth, files[i].width);
        assert_int_equal(info.chunkHeight, files[i].height);
        assert_string_equal(info.pCompression, files[i].compression);
        assert_string_equal(info.pChannels, files[i].channels);
        assert_int_equal(info.chainSize > 0, files[i].storage <= SLUICE_EXR_STORAGE_TILES);
        sluiceDestroyImageSource(source);
    }
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    SluiceExrMemoryBudget *budget;
    SluiceExrInfo info = {.structSize = sizeof info};
    const uint8_t texel = 0;
    SluiceImageInfo image = {sizeof image, 1, 1, 1, SLUICE_FORMAT_R8_UNORM, "no file", 0};
    SluiceImageSource *source;
    struct failing_allocator allocator;
    failing_allocator_init(&allocator, 0);
    CHECK_RESULT(sluiceCreateExrMemoryBudget(0, NULL, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceCreateExrMemoryBudget(0, &allocator.callbacks, &budget),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    sluiceDestroyExrMemoryBudget(NULL);
    CHECK_OK(sluiceCreateMemoryImageSource(&texel, &image, NULL, &source));
    CHECK_RESULT(sluiceGetExrInfo(NULL, &info), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceGetExrInfo(source, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceGetExrInfo(source, &info), SLUICE_ERROR_INVALID_ARGUMENT);
    sluiceDestroyImageSource(source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(large_files_without_levels_are_refused_with_a_way_out),
        cmocka_unit_test(large_tiles_are_refused_with_a_way_out),
        cmocka_unit_test(a_file_that_needs_no_more_than_the_limit_is_read),
        cmocka_unit_test(sources_share_a_budget_until_they_are_destroyed),
        cmocka_unit_test(what_is_in_a_file_is_told_without_reading_it),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return RUN_TESTS(tests);
}
