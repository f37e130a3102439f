/* Files are opened by what is in them, once while they stay the same, and refused by name. */
#define _XOPEN_SOURCE 700

#include <sluice/open.h>
#include <sluice/store.h>

#include "bake/baked.h"
#include "support/failing_allocator.h"
#include "support/few_descriptors.h"
#include "support/test.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct fixture {
    struct bake_folder folder;
    SluiceImageOpener *opener;
    int errors;
    char last[1024];
};

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct fixture *f = user;
    if (severity != SLUICE_LOG_ERROR)
        return;
    f->errors++;
    snprintf(f->last, sizeof f->last, "%s", message);
}

static void setup(struct fixture *f)
{
    memset(f, 0, sizeof *f);
    bake_folder_init(&f->folder);
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info, .log = {f, on_log}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f->opener));
}

static void teardown(struct fixture *f)
{
    sluiceDestroyImageOpener(f->opener);
    bake_folder_finish(&f->folder);
}

static void own_file(const char *name, char path[1024])
{
    const char *root = getenv("SLUICE_SOURCE_ROOT");
    snprintf(path, 1024, "%s/tests/%s", root ? root : ".", name);
}

static void copy_file(const char *from, const char *to)
{
    char command[2048];
    snprintf(command, sizeof command, "cp '%s' '%s'", from, to);
    assert_int_equal(system(command), 0);
}

static void write_store(const char *path, uint32_t width)
{
    struct plain_source source;
    uint8_t *texels = calloc(width, 100);
    plain_source_init(&source, SLUICE_FORMAT_R8_UNORM, width, 100, texels);
    bake_source(&source.base, path, NULL);
    free(texels);
}

static SluiceOpenedImageInfo state_of(SluiceImageSource *source)
{
    SluiceOpenedImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetOpenedImageInfo(source, &info));
    return info;
}

/* Names say nothing: all of them end in .png. */
static void files_are_known_by_their_contents(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        SluiceImageFileKind kind;
    } files[] = {
        {"exr/data/mip_zip.exr", SLUICE_IMAGE_FILE_KIND_EXR},
        {"exr/data/scan_mixed.exr", SLUICE_IMAGE_FILE_KIND_EXR},
        {"container/data/nvtt_bc1.dds", SLUICE_IMAGE_FILE_KIND_DDS},
        {NULL, SLUICE_IMAGE_FILE_KIND_STORE},
    };
    struct fixture f;
    setup(&f);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char path[256], from[1024];
        SluiceImageSource *source;
        SluiceImageInfo image = {.structSize = sizeof image};
        bake_folder_file(&f.folder, "a.png", path);
        if (files[i].file) {
            own_file(files[i].file, from);
            copy_file(from, path);
        } else {
            write_store(path, 300);
        }
        CHECK_OK(sluiceOpenImageSource(f.opener, path, &source));
        SluiceOpenedImageInfo info = state_of(source);
        assert_int_equal(info.kind, files[i].kind);
        assert_true(info.ready && info.previewReady && info.source);
        CHECK_OK(sluiceGetImageInfo(source, &image));
        SluiceImageRegion region = {image.mipLevelCount - 1, 0, 0, 1, 1, 0};
        uint8_t texel[16];
        CHECK_OK(sluiceReadImageRegion(source, &region, texel, sizeof texel));
        sluiceDestroyImageSource(source);
        unlink(path);
    }
    assert_int_equal(f.errors, 0);
    teardown(&f);
}

static void a_file_is_open_once_until_it_changes(void **state)
{
    (void)state;
    struct fixture f;
    char path[256], other[256];
    SluiceImageSource *first, *again, *changed;
    SluiceImageInfo image = {.structSize = sizeof image};
    setup(&f);
    bake_folder_file(&f.folder, "a.store", path);
    bake_folder_file(&f.folder, "b.store", other);
    write_store(path, 300);
    write_store(other, 300);
    CHECK_OK(sluiceOpenImageSource(f.opener, path, &first));
    CHECK_OK(sluiceOpenImageSource(f.opener, path, &again));
    assert_ptr_equal(first, again);
    assert_int_equal(state_of(first).openCount, 2);
    CHECK_OK(sluiceOpenImageSource(f.opener, other, &changed));
    assert_ptr_not_equal(first, changed);
    sluiceDestroyImageSource(changed);
    write_store(path, 200);
    CHECK_OK(sluiceOpenImageSource(f.opener, path, &changed));
    assert_ptr_not_equal(first, changed);
    CHECK_OK(sluiceGetImageInfo(changed, &image));
    assert_int_equal(image.width, 200);
    sluiceDestroyImageSource(again);
    CHECK_OK(sluiceGetImageInfo(first, &image));
    assert_int_equal(image.width, 300);
    sluiceDestroyImageSource(first);
    sluiceDestroyImageSource(changed);
    teardown(&f);
}

static void what_cannot_be_opened_is_refused_by_name(void **state)
{
    (void)state;
    struct fixture f;
    char path[256];
    SluiceImageSource *source = NULL;
    setup(&f);
    bake_folder_file(&f.folder, "x", path);
    CHECK_RESULT(sluiceOpenImageSource(f.opener, path, &source), SLUICE_ERROR_FILE_NOT_FOUND);
    assert_non_null(strstr(f.last, path));
    CHECK_RESULT(sluiceOpenImageSource(f.opener, f.folder.path, &source), SLUICE_ERROR_IO);
    assert_int_equal(mkfifo(path, 0600), 0);
    CHECK_RESULT(sluiceOpenImageSource(f.opener, path, &source), SLUICE_ERROR_IO);
    assert_non_null(strstr(f.last, "is not a regular file"));
    unlink(path);
    static const char *const starts[] = {"\x76\x2F\x31\x01", "DDS ", "\xABKTX 20\xBB\r\n\x1A\n",
                                         "\x89SLS\r\n\x1A\n"};
    for (size_t i = 0; i < sizeof starts / sizeof starts[0]; i++) {
        FILE *file = fopen(path, "wb");
        fputs(starts[i], file);
        fclose(file);
        int before = f.errors;
        CHECK_RESULT(sluiceOpenImageSource(f.opener, path, &source), SLUICE_ERROR_CORRUPT_DATA);
        assert_true(f.errors > before);
        assert_non_null(strstr(f.last, path));
        unlink(path);
    }
    FILE *file = fopen(path, "wb");
    fclose(file);
    CHECK_RESULT(sluiceOpenImageSource(f.opener, path, &source), SLUICE_ERROR_UNSUPPORTED);
    assert_non_null(strstr(f.last, "pCacheFolder"));
    assert_null(source);
    if (getuid() != 0) {
        chmod(path, 0);
        CHECK_RESULT(sluiceOpenImageSource(f.opener, path, &source), SLUICE_ERROR_IO);
    }
    teardown(&f);
}

enum { MANY_FILES = 300 };

static void open_and_read_all(const struct bake_folder *folder, uint32_t max_open_file_count)
{
    SluiceImageSource *sources[MANY_FILES] = {0};
    char path[256];
    struct few_descriptors few;
    SluiceImageOpener *opener;
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .maxOpenFileCount = max_open_file_count};
    few_descriptors_begin(&few, 40);
    SluiceResult result = sluiceCreateImageOpener(&info, &opener);
    for (int i = 0; i < MANY_FILES && result == SLUICE_SUCCESS; i++) {
        char name[32];
        snprintf(name, sizeof name, "%d.store", i);
        result = sluiceOpenImageSource(opener, bake_folder_file(folder, name, path), &sources[i]);
    }
    uint8_t texel;
    SluiceImageRegion region = {0, 5, 5, 1, 1, 0};
    for (int i = 0; i < 2 * MANY_FILES && result == SLUICE_SUCCESS; i++)
        result = sluiceReadImageRegion(sources[i % MANY_FILES], &region, &texel, 1);
    few_descriptors_end(&few);
    for (int i = 0; i < MANY_FILES; i++)
        sluiceDestroyImageSource(sources[i]);
    sluiceDestroyImageOpener(opener);
    CHECK_OK(result);
}

static void three_hundred_files_are_open_with_sixty_descriptors(void **state)
{
    (void)state;
    struct bake_folder folder;
    char first[256], path[256];
    bake_folder_init(&folder);
    bake_folder_file(&folder, "first.store", first);
    write_store(first, 64);
    for (int i = 0; i < MANY_FILES; i++) {
        char name[32];
        snprintf(name, sizeof name, "%d.store", i);
        assert_int_equal(link(first, bake_folder_file(&folder, name, path)), 0);
    }
    open_and_read_all(&folder, 0);
    open_and_read_all(&folder, 60); /* more than there are descriptors: idle files are closed */
    bake_folder_finish(&folder);
}

struct opening {
    SluiceImageOpener *opener;
    char path[256];
    int failures;
};

static void *open_and_close(void *argument)
{
    struct opening *opening = argument;
    for (int i = 0; i < 100; i++) {
        SluiceImageSource *source;
        uint8_t texel;
        SluiceImageRegion region = {0, 5, 5, 1, 1, 0};
        if (sluiceOpenImageSource(opening->opener, opening->path, &source) != SLUICE_SUCCESS ||
            sluiceReadImageRegion(source, &region, &texel, 1) != SLUICE_SUCCESS)
            opening->failures++;
        else
            sluiceDestroyImageSource(source);
    }
    return NULL;
}

static void threads_share_a_source(void **state)
{
    (void)state;
    struct fixture f;
    struct opening openings[4] = {0};
    pthread_t threads[4];
    setup(&f);
    for (int i = 0; i < 4; i++) {
        openings[i].opener = f.opener;
        bake_folder_file(&f.folder, i < 3 ? "a.store" : "b.store", openings[i].path);
        write_store(openings[i].path, 64);
    }
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, open_and_close, &openings[i]), 0);
    for (int i = 0; i < 4; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(openings[i].failures, 0);
    }
    teardown(&f);
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    struct bake_folder folder;
    char path[256];
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    bake_folder_init(&folder);
    bake_folder_file(&folder, "a.store", path);
    write_store(path, 64);
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        SluiceImageOpener *opener = NULL;
        SluiceImageSource *source = NULL;
        failing_allocator_init(&a, n);
        SluiceImageOpenerCreateInfo info = {
            .structSize = sizeof info, .pCacheFolder = folder.path, .pAllocator = &a.callbacks};
        result = sluiceCreateImageOpener(&info, &opener);
        if (result == SLUICE_SUCCESS)
            result = sluiceOpenImageSource(opener, path, &source);
        if (result == SLUICE_SUCCESS) {
            uint64_t calls = a.calls;
            a.refuse_from = 0;
            assert_int_equal(state_of(source).openCount, 1);
            assert_int_equal(a.calls, calls);
        }
        sluiceDestroyImageSource(source);
        sluiceDestroyImageOpener(opener);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(a.live_bytes, 0);
    }
    bake_folder_finish(&folder);
}

/* A path opener of bytes in memory. */
struct shelf {
    const char *folder;
    uint32_t opened, closed;
};

static SluiceResult open_from_shelf(void *user, const char *path, SluiceInput *input, void **opened)
{
    struct shelf *shelf = user;
    char name[300];
    snprintf(name, sizeof name, "%s/%s", shelf->folder, strstr(path, "://") + 3);
    FILE *file = fopen(name, "rb");
    if (!file)
        return SLUICE_ERROR_FILE_NOT_FOUND;
    fseek(file, 0, SEEK_END);
    input->size = (uint64_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(input->size);
    assert_int_equal(fread(bytes, 1, input->size, file), input->size);
    fclose(file);
    input->pBytes = *opened = bytes;
    shelf->opened++;
    return SLUICE_SUCCESS;
}

static void put_back(void *user, void *opened)
{
    struct shelf *shelf = user;
    shelf->closed++;
    free(opened);
}

static void a_path_opener_opens_what_contains_a_scheme_once_and_closes_it(void **state)
{
    (void)state;
    struct fixture f;
    char path[1024];
    SluiceImageSource *source, *again;
    setup(&f);
    sluiceDestroyImageOpener(f.opener);
    struct shelf shelf = {.folder = f.folder.path};
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .log = {&f, on_log},
                                        .pathOpener = {&shelf, open_from_shelf, put_back}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f.opener));
    snprintf(path, sizeof path, "%s/wall", f.folder.path);
    write_store(path, 100);
    CHECK_OK(sluiceOpenImageSource(f.opener, "shelf://wall", &source));
    CHECK_OK(sluiceOpenImageSource(f.opener, "shelf://wall", &again));
    assert_ptr_equal(source, again);
    assert_int_equal(state_of(source).kind, SLUICE_IMAGE_FILE_KIND_STORE);
    sluiceDestroyImageSource(again);
    CHECK_OK(sluiceOpenImageSource(f.opener, path, &again)); /* the file itself */
    uint8_t texel[1];
    SluiceImageRegion region = {0, 0, 0, 1, 1, 0};
    CHECK_OK(sluiceReadImageRegion(source, &region, texel, 1));
    SluiceImageSource *refused;
    CHECK_RESULT(sluiceOpenNamedImageSource(f.opener, "shelf://wall", "x", &refused),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceOpenImageSource(f.opener, "shelf://none", &refused),
                 SLUICE_ERROR_FILE_NOT_FOUND);
    snprintf(path, sizeof path, "%s/note", f.folder.path);
    FILE *note = fopen(path, "wb");
    fputs("no picture", note);
    fclose(note);
    CHECK_RESULT(sluiceOpenImageSource(f.opener, "shelf://note", &refused),
                 SLUICE_ERROR_UNSUPPORTED);
    assert_non_null(strstr(f.last, "shelf://note"));
    sluiceDestroyImageSource(again);
    assert_int_equal(shelf.opened, shelf.closed + 1);
    info.pathOpener.pfnClosePath = NULL;
    SluiceImageOpener *half;
    CHECK_RESULT(sluiceCreateImageOpener(&info, &half), SLUICE_ERROR_NULL_POINTER);
    sluiceDestroyImageSource(source);
    assert_int_equal(shelf.opened, shelf.closed);
    teardown(&f);
}

static uint64_t hash_of(const char *path)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *store;
    uint64_t hash = 0;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &store));
    CHECK_OK(sluiceHashStore(store, &hash));
    sluiceDestroyImageSource(store);
    return hash;
}

#define CATALOGUE_HEAD                                                                             \
    "sluice catalogue 1\nhash\tformat\twidth\theight\tlayers\tbytes\tpicture\tstore\n"

/* A hash stands before each row; NULL: one row. */
static void write_rows(const char *path, uint64_t first, const char *row, uint64_t second,
                       const char *other)
{
    FILE *file = fopen(path, "wb");
    fputs(CATALOGUE_HEAD, file);
    fprintf(file, "%016llx%s", (unsigned long long)first, row);
    if (other)
        fprintf(file, "%016llx%s", (unsigned long long)second, other);
    fclose(file);
}

static uint32_t width_by_name(struct fixture *f, const char *path, const char *name,
                              SluiceResult expected)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceImageSource *source;
    f->last[0] = '\0';
    SluiceResult result = name ? sluiceOpenNamedImageSource(f->opener, path, name, &source)
                               : sluiceOpenImageSource(f->opener, path, &source);
    CHECK_RESULT(result, expected);
    if (result != SLUICE_SUCCESS)
        return 0;
    assert_int_equal(state_of(source).kind, SLUICE_IMAGE_FILE_KIND_STORE);
    CHECK_OK(sluiceGetImageInfo(source, &info));
    sluiceDestroyImageSource(source);
    return info.width;
}

/* The stores lie in the catalogue's folder, and names with a tab are escaped. */
static void stores_of_a_catalogue_are_opened_by_name(void **state)
{
    (void)state;
    static const char row[] = "\tR8_UNORM\t64\t100\t1\t9\tin/a.png\ta.store\n";
    static const char other[] = "\tR8_UNORM\t80\t100\t1\t9\tin/x\\ty.png\tb c.store\n";
    struct fixture f;
    char path[256], store[256];
    setup(&f);
    sluiceDestroyImageOpener(f.opener);
    struct shelf shelf = {.folder = f.folder.path};
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .log = {&f, on_log},
                                        .pathOpener = {&shelf, open_from_shelf, put_back}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f.opener));
    bake_folder_file(&f.folder, "list.tsv", path);
    write_store(bake_folder_file(&f.folder, "a.store", store), 64);
    uint64_t first = hash_of(store);
    write_store(bake_folder_file(&f.folder, "b c.store", store), 80);
    uint64_t second = hash_of(store);
    write_rows(path, first, row, second, other);
    assert_int_equal(width_by_name(&f, path, NULL, SLUICE_SUCCESS), 64);
    assert_int_equal(width_by_name(&f, path, "in/a.png", SLUICE_SUCCESS), 64);
    assert_int_equal(width_by_name(&f, path, "x\ty.png", SLUICE_SUCCESS), 80);
    assert_int_equal(width_by_name(&f, path, "b c.store", SLUICE_SUCCESS), 80);
    width_by_name(&f, path, "y.png", SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(f.last, "no picture and no store 'y.png'"));
    assert_int_equal(width_by_name(&f, "shelf://list.tsv", "a.png", SLUICE_SUCCESS), 64);
    assert_int_equal(width_by_name(&f, "shelf://list.tsv", "b c.store", SLUICE_SUCCESS), 80);
    assert_int_equal(symlink(".", bake_folder_file(&f.folder, "h", store)), 0);
    width_by_name(&f, "https://h/list.tsv", "b c.store", SLUICE_ERROR_FILE_NOT_FOUND);
    write_store(bake_folder_file(&f.folder, "b%20c.store", store), 80);
    assert_int_equal(width_by_name(&f, "https://h/list.tsv", "b c.store", SLUICE_SUCCESS), 80);
    assert_int_equal(shelf.opened, shelf.closed + 2); /* the catalogues stay open */

    char local[512]; /* for a catalogue on this machine alone */
    snprintf(local, sizeof local, "\tR8_UNORM\t64\t100\t1\t9\ta\t%s\n",
             bake_folder_file(&f.folder, "a.store", store));
    write_rows(path, first, local, 0, NULL);
    assert_int_equal(width_by_name(&f, path, NULL, SLUICE_SUCCESS), 64);
    width_by_name(&f, "shelf://list.tsv", "a", SLUICE_ERROR_CORRUPT_DATA);
    assert_non_null(strstr(f.last, "names the local file /"));
    FILE *picture = fopen(bake_folder_file(&f.folder, "a.ppm", store), "wb");
    fputs("P6 2 2 255\nabcdefghijkl", picture);
    fclose(picture);
    write_rows(path, 0, "\tR8_UNORM\t2\t2\t1\t9\ta\ta.ppm\n", 0, NULL);
    width_by_name(&f, path, NULL, SLUICE_ERROR_CORRUPT_DATA); /* and is not baked */
    assert_non_null(strstr(f.last, "is not the store"));

    write_rows(path, first, row, first, other); /* another store than the second one */
    width_by_name(&f, path, "x\ty.png", SLUICE_ERROR_CORRUPT_DATA);
    assert_non_null(strstr(f.last, "is not the store"));
    write_rows(path, 0, "\tR8_UNORM\t64\t100\t1\t9\tc\tlist.tsv\n", 0, NULL);
    width_by_name(&f, path, NULL, SLUICE_ERROR_CORRUPT_DATA);
    write_rows(path, 0, "\tR8_UNORM\t64\t100\t1\n", 0, NULL);
    width_by_name(&f, path, NULL, SLUICE_ERROR_CORRUPT_DATA);
    assert_non_null(strstr(f.last, "list.tsv:3: is no row"));
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_known_by_their_contents),
        cmocka_unit_test(a_file_is_open_once_until_it_changes),
        cmocka_unit_test(what_cannot_be_opened_is_refused_by_name),
        cmocka_unit_test(three_hundred_files_are_open_with_sixty_descriptors),
        cmocka_unit_test(a_path_opener_opens_what_contains_a_scheme_once_and_closes_it),
        cmocka_unit_test(stores_of_a_catalogue_are_opened_by_name),
        cmocka_unit_test(threads_share_a_source),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    return RUN_TESTS(tests);
}
