/* A disk that is full after k bytes: baking and recording report it, name the file, and work again
 * later. */
#define _XOPEN_SOURCE 700

#include "bake/baked.h"
#include "extremes/note.h"
#include "support/failing_allocator.h"

#include <sluice/replay.h>

#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

static bool is_long_run;

enum { WIDTH = 700, HEIGHT = 500 };

struct told {
    char last[1200]; ///< error
};

static void keep(void *user, SluiceLogSeverity severity, const char *message)
{
    struct told *told = user;
    if (severity == SLUICE_LOG_ERROR)
        snprintf(told->last, sizeof told->last, "%s", message);
}

/* Sets the system's own limit for files, which every larger write exceeds. */
static void limit_files(rlim_t size)
{
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = size < limit.rlim_max ? size : limit.rlim_max;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static SluiceResult bake_with(const SluiceBakeInfo *info, const SluiceAllocationCallbacks *memory,
                              struct told *told, SluiceBakeReport *report)
{
    SluiceBakerCreateInfo create = {
        .structSize = sizeof create, .threadCount = 1, .pAllocator = memory, .log = {told, keep}};
    SluiceBaker *baker = NULL;
    SluiceResult result = sluiceCreateBaker(&create, &baker);
    if (result == SLUICE_SUCCESS)
        result = sluiceBakeFile(baker, info, report);
    sluiceDestroyBaker(baker);
    return result;
}

struct scene {
    struct bake_folder folder;
    char picture[256], path[256], whole[256];
    uint8_t *samples;
    SluiceBakeInfo info;
    SluiceBakeReport report; ///< report of the whole store
};

/* A picture, and the store expected from it. */
static void scene_init(struct scene *s)
{
    uint32_t random = 9;
    *s = (struct scene){.samples = malloc(WIDTH * HEIGHT * 3),
                        .report = {.structSize = sizeof(SluiceBakeReport)}};
    assert_non_null(s->samples);
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT * 3; i++)
        s->samples[i] = (uint8_t)((random = random * 1664525u + 1013904223u) >> 24);
    bake_folder_init(&s->folder);
    bake_folder_file(&s->folder, "picture.png", s->picture);
    bake_folder_file(&s->folder, "out.store", s->path);
    bake_folder_file(&s->folder, "whole.store", s->whole);
    write_png(s->picture, s->samples, WIDTH, HEIGHT, 3, false);
    s->info = (SluiceBakeInfo){
        .structSize = sizeof(SluiceBakeInfo), .pInputPath = s->picture, .pOutputPath = s->whole};
    struct told told = {{0}};
    CHECK_OK(bake_with(&s->info, NULL, &told, &s->report));
    s->info.pOutputPath = s->path;
}

static void scene_finish(struct scene *s)
{
    free(s->samples);
    bake_folder_finish(&s->folder);
}

static void check_same_levels(const char *a, const char *b)
{
    for (uint32_t level = 0; level < 10; level++) {
        size_t sizes[2];
        void *bytes[2] = {read_bytes(a, level, &sizes[0]), read_bytes(b, level, &sizes[1])};
        assert_int_equal(sizes[0], sizes[1]);
        assert_memory_equal(bytes[0], bytes[1], sizes[0]);
        free(bytes[0]);
        free(bytes[1]);
    }
}

/* Bakes with room for k bytes, for growing k until it suffices. Failed attempts free their
 * space. */
static void a_bake_onto_a_full_disk_names_the_file_and_leaves_none(void **state)
{
    (void)state;
    struct scene s;
    char part[300];
    scene_init(&s);
    snprintf(part, sizeof part, "%s.sluice-part", s.path);
    const uint64_t size = s.report.outputSize, step = is_long_run ? 997 : size / 40;
    uint32_t cases = 0, wrong = 0;
    for (uint64_t room = 0;; room += step, cases++) {
        struct told told = {{0}};
        limit_files(room);
        SluiceResult result = bake_with(&s.info, NULL, &told, NULL);
        limit_files(RLIM_INFINITY);
        wrong += access(part, F_OK) == 0;
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_IO);
        wrong += strstr(told.last, s.path) == NULL || access(s.path, F_OK) == 0;
        assert_true(room <= size + step);
    }
    check_same_levels(s.path, s.whole);
    note("bake on a full disk: not named, or something left", cases, wrong, 0);
    assert_int_equal(wrong, 0);
    assert_true(cases > 20);
    scene_finish(&s);
}

/* The existing file stays until the new one is complete. */
static void a_bake_onto_a_full_disk_leaves_what_was_there(void **state)
{
    (void)state;
    struct scene s;
    scene_init(&s);
    CHECK_OK(bake_with(&s.info, NULL, &(struct told){{0}}, NULL));
    SluiceBakeSettings settings = {.structSize = sizeof settings,
                                   .filter = SLUICE_BAKE_FILTER_KAISER};
    s.info.pSettings = &settings;
    for (uint32_t i = 0; i < 12; i++) {
        struct told told = {{0}};
        limit_files(s.report.outputSize * i / 12);
        CHECK_RESULT(bake_with(&s.info, NULL, &told, NULL), SLUICE_ERROR_IO);
        limit_files(RLIM_INFINITY);
        check_same_levels(s.path, s.whole); /* still the older store */
    }
    scene_finish(&s);
}

/* A device that is always full, and one that is no regular file. */
static void devices_are_no_stores(void **state)
{
    (void)state;
    struct scene s;
    struct told told = {{0}};
    scene_init(&s);
    s.info.pOutputPath = "/dev/full";
    assert_true(bake_with(&s.info, NULL, &told, NULL) < 0);
    assert_non_null(strstr(told.last, "/dev/full"));
    scene_finish(&s);
}

/* Bakes from a file with a second pass for the cut-out. libvips allocates for itself. */
static void a_bake_of_a_file_survives_every_refused_allocation(void **state)
{
    (void)state;
    struct scene s;
    uint64_t refusals = 0, left = 0;
    scene_init(&s);
    for (uint32_t lasting = 0; lasting < 2; lasting++) {
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint64_t n = 0; result != SLUICE_SUCCESS; n++, refusals++) {
            struct failing_allocator memory;
            struct told told = {{0}};
            failing_allocator_init(&memory, n);
            memory.refuse_count = !lasting;
            result = bake_with(&s.info, &memory.callbacks, &told, NULL);
            if (result != SLUICE_SUCCESS)
                CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            left += memory.live_count;
            assert_int_equal(access(s.path, F_OK), result == SLUICE_SUCCESS ? 0 : -1);
            assert_true(n < 1000);
        }
        check_same_levels(s.path, s.whole);
        unlink(s.path);
    }
    note("bake of a file: refused allocations, what is left", refusals, (double)left, 0);
    assert_int_equal(left, 0);
    assert_true(refusals > 20);
    scene_finish(&s);
}

static SluiceResult no_heap(void *user, uint64_t size, uint32_t *id)
{
    (void)user, (void)size, (void)id;
    return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
}

static void release_no_heap(void *user, uint32_t id)
{
    (void)user, (void)id;
}

/* Records a few hundred calls of a manager. Returns the result at the recording's end. */
static SluiceResult record(const char *path, const SluiceAllocationCallbacks *memory)
{
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {NULL, no_heap, release_no_heap},
        .heapTileCapacity = 8,
        .tileSize = 65536};
    SluiceStreamedTextureManager *manager;
    SluiceRecorder *recorder;
    const SluiceStreamedTextureDesc desc = {256, 256, 9, 1, 1, 128, 128, 0, 0};
    CHECK_OK(sluiceCreateStreamedTextureManager(&info, &manager));
    SluiceResult result = sluiceBeginRecordingToFile(manager, path, memory, &recorder);
    if (result == SLUICE_SUCCESS) {
        for (uint32_t i = 0; i < 400; i++) {
            SluiceTextureId id;
            CHECK_OK(sluiceAddStreamedTexture(manager, &desc, &id));
            const uint8_t map[4] = {0};
            const SluiceFeedbackDesc feedback = {sizeof feedback, map, 2, 2, 0, 0};
            CHECK_OK(sluiceUpdateWithSamplerFeedback(manager, id, &feedback, i, 10));
        }
        result = sluiceEndRecording(recorder);
    }
    sluiceDestroyStreamedTextureManager(manager);
    return result;
}

static void a_recording_onto_a_full_disk_is_an_error_and_no_file(void **state)
{
    (void)state;
    struct bake_folder folder;
    char path[256], partial[300];
    uint32_t cases = 0;
    bake_folder_init(&folder);
    bake_folder_file(&folder, "run.slrt", path);
    snprintf(partial, sizeof partial, "%s.sluice-part", path);
    for (rlim_t room = 0;; room += 211, cases++) {
        limit_files(room);
        SluiceResult result = record(path, NULL);
        limit_files(RLIM_INFINITY);
        assert_int_equal(access(partial, F_OK), -1);
        assert_int_equal(access(path, F_OK), result == SLUICE_SUCCESS ? 0 : -1);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_IO);
    }
    assert_true(cases > 10);
    if (access("/dev/full", W_OK) == 0)
        CHECK_RESULT(record("/dev/full", NULL), SLUICE_ERROR_IO);
    bake_folder_finish(&folder);
}

static void a_recording_to_a_file_survives_every_refused_allocation(void **state)
{
    (void)state;
    struct bake_folder folder;
    char path[256];
    uint64_t refusals = 0, left = 0;
    bake_folder_init(&folder);
    bake_folder_file(&folder, "run.slrt", path);
    for (uint32_t lasting = 0; lasting < 2; lasting++) {
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint64_t n = 0; result != SLUICE_SUCCESS; n++, refusals++) {
            struct failing_allocator memory;
            failing_allocator_init(&memory, n);
            memory.refuse_count = !lasting;
            result = record(path, &memory.callbacks);
            left += memory.live_count;
            if (result != SLUICE_SUCCESS)
                CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_int_equal(access(path, F_OK), result == SLUICE_SUCCESS ? 0 : -1);
            assert_true(n < 1000);
        }
        unlink(path);
    }
    note("recording to a file: refused allocations, what is left", refusals, (double)left, 0);
    assert_int_equal(left, 0);
    bake_folder_finish(&folder);
}

int main(int argc, char **argv)
{
    is_long_run = is_long(argc, argv);
    signal(SIGXFSZ, SIG_IGN);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bake_onto_a_full_disk_names_the_file_and_leaves_none),
        cmocka_unit_test(a_bake_onto_a_full_disk_leaves_what_was_there),
        cmocka_unit_test(devices_are_no_stores),
        cmocka_unit_test(a_bake_of_a_file_survives_every_refused_allocation),
        cmocka_unit_test(a_recording_onto_a_full_disk_is_an_error_and_no_file),
        cmocka_unit_test(a_recording_to_a_file_survives_every_refused_allocation),
    };
    return RUN_TESTS(tests);
}
