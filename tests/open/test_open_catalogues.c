/* A catalogue is read once for all its stores, and again after a change. Names are found as by a
 * search of all rows. */
#define _XOPEN_SOURCE 700

#include <sluice/open.h>
#include <sluice/store.h>

#include "bake/baked.h"
#include "open/catalogue.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define HEAD "sluice catalogue 1\nhash\tformat\twidth\theight\tlayers\tbytes\tpicture\tstore\n"
#define THREADS 8
#define NAMES 64

/** Simulates a server with the files of a folder, and counts accesses. */
struct server {
    struct bake_folder folder;
    atomic_uint opened, closed, checked; ///< accesses to catalogues
    atomic_ullong bytes;                 ///< bytes read from catalogues
    bool is_checking, tells_no_version;
    SluiceImageOpener *opener;
    atomic_int errors;
    char last[1024];
};

struct served {
    struct server *server;
    FILE *file;
    char path[512];
    bool is_catalogue;
    unsigned char *bytes; ///< contents at the opening
    size_t size;
};

static SluiceResult read_served(void *user, uint64_t offset, void *bytes, size_t size)
{
    struct served *served = user;
    memcpy(bytes, served->bytes + offset, size);
    if (served->is_catalogue)
        atomic_fetch_add(&served->server->bytes, size);
    return SLUICE_SUCCESS;
}

static unsigned char *load(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static SluiceResult serve(void *user, const char *path, SluiceInput *input, void **opened)
{
    struct server *server = user;
    struct served *served = calloc(1, sizeof *served);
    snprintf(served->path, sizeof served->path, "%s/%s", server->folder.path,
             strstr(path, "://") + 3);
    served->bytes = load(served->path, &served->size);
    if (!served->bytes) {
        free(served);
        return SLUICE_ERROR_FILE_NOT_FOUND;
    }
    served->server = server;
    served->is_catalogue = strstr(path, ".tsv") != NULL;
    if (served->is_catalogue)
        atomic_fetch_add(&server->opened, 1);
    input->size = served->size;
    input->pUserData = *opened = served;
    input->pfnRead = read_served;
    return SLUICE_SUCCESS;
}

static void end_serving(void *user, void *opened)
{
    struct server *server = user;
    struct served *served = opened;
    if (served->is_catalogue)
        atomic_fetch_add(&server->closed, 1);
    free(served->bytes);
    free(served);
}

static SluiceResult check(void *user, void *opened)
{
    struct server *server = user;
    struct served *served = opened;
    size_t size = 0;
    unsigned char *bytes = load(served->path, &size);
    bool is_same = bytes && size == served->size && memcmp(bytes, served->bytes, size) == 0;
    atomic_fetch_add(&server->checked, 1);
    free(bytes);
    if (server->tells_no_version)
        return SLUICE_ERROR_UNSUPPORTED;
    return is_same ? SLUICE_SUCCESS : SLUICE_ERROR_IO;
}

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct server *server = user;
    if (severity != SLUICE_LOG_ERROR)
        return;
    atomic_fetch_add(&server->errors, 1);
    snprintf(server->last, sizeof server->last, "%s", message);
}

static SluiceImageOpenerCreateInfo opener_info(struct server *server)
{
    return (SluiceImageOpenerCreateInfo){.structSize = sizeof(SluiceImageOpenerCreateInfo),
                                         .log = {server, on_log},
                                         .pathOpener = {server, serve, end_serving},
                                         .pfnCheckPath = server->is_checking ? check : NULL};
}

static void write_store(const struct server *server, const char *name, uint32_t width)
{
    char path[256];
    struct plain_source source;
    uint8_t *texels = calloc(width, 10);
    plain_source_init(&source, SLUICE_FORMAT_R8_UNORM, width, 10, texels);
    bake_source(&source.base, bake_folder_file(&server->folder, name, path), NULL);
    free(texels);
}

static void setup(struct server *server, bool is_checking)
{
    memset(server, 0, sizeof *server);
    bake_folder_init(&server->folder);
    server->is_checking = is_checking;
    SluiceImageOpenerCreateInfo info = opener_info(server);
    CHECK_OK(sluiceCreateImageOpener(&info, &server->opener));
    write_store(server, "a.store", 64);
    write_store(server, "b.store", 80);
}

/* Destroying the opener must close all catalogues. */
static void teardown(struct server *server)
{
    sluiceDestroyImageOpener(server->opener);
    assert_int_equal(atomic_load(&server->opened), atomic_load(&server->closed));
    bake_folder_finish(&server->folder);
}

static unsigned long long hash_of(const struct server *server, const char *name)
{
    char path[256];
    SluiceStoreImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = bake_folder_file(&server->folder, name, path)};
    SluiceImageSource *store;
    uint64_t hash = 0;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &store));
    CHECK_OK(sluiceHashStore(store, &hash));
    sluiceDestroyImageSource(store);
    return hash;
}

/* Writes rows "pN.png" from `first` on, all with one store. Renames a temporary file, like
 * sluice-bake. */
static void write_catalogue(const struct server *server, const char *name, const char *store,
                            int first, int count)
{
    char path[256], part[256];
    FILE *file = fopen(bake_folder_file(&server->folder, "part", part), "wb");
    unsigned long long hash = hash_of(server, store);
    fputs(HEAD, file);
    for (int i = first; i < first + count; i++)
        fprintf(file, "%016llx\tR8_UNORM\t1\t1\t1\t1\tin/p%d.png\t%s\n", hash, i, store);
    fclose(file);
    assert_int_equal(rename(part, bake_folder_file(&server->folder, name, path)), 0);
}

static uint32_t width_of(SluiceImageOpener *opener, const char *path, const char *name,
                         SluiceResult expected)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceImageSource *source;
    SluiceResult result = sluiceOpenNamedImageSource(opener, path, name, &source);
    CHECK_RESULT(result, expected);
    if (result != SLUICE_SUCCESS)
        return 0;
    CHECK_OK(sluiceGetImageInfo(source, &info));
    sluiceDestroyImageSource(source);
    return info.width;
}

struct opening {
    SluiceImageOpener *opener;
    const char *path;
    int first;
    int failures;
};

static void *open_names(void *argument)
{
    struct opening *opening = argument;
    for (int i = opening->first; i < NAMES; i += THREADS) {
        char name[32];
        SluiceImageSource *source;
        snprintf(name, sizeof name, "p%d.png", i);
        if (sluiceOpenNamedImageSource(opening->opener, opening->path, name, &source) ==
            SLUICE_SUCCESS)
            sluiceDestroyImageSource(source);
        else
            opening->failures++;
    }
    return NULL;
}

static void open_on_threads(SluiceImageOpener *opener, const char *path)
{
    pthread_t threads[THREADS];
    struct opening openings[THREADS];
    for (int i = 0; i < THREADS; i++) {
        openings[i] = (struct opening){opener, path, i, 0};
        assert_int_equal(pthread_create(&threads[i], NULL, open_names, &openings[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(openings[i].failures, 0);
    }
}

static void a_catalogue_of_a_server_is_read_once_for_all_threads_and_names(void **state)
{
    (void)state;
    struct server server;
    char path[256];
    size_t size;
    setup(&server, true);
    write_catalogue(&server, "list.tsv", "a.store", 0, NAMES);
    open_on_threads(server.opener, "net://list.tsv");
    assert_int_equal(atomic_load(&server.opened), 1);
    free(load(bake_folder_file(&server.folder, "list.tsv", path), &size));
    /* Its kind takes 12 bytes. */
    assert_int_equal(atomic_load(&server.bytes), size + 12);
    assert_in_range(atomic_load(&server.checked), 0, 20); /* one per second, and slow machines */
    teardown(&server);
}

/* Counts catalogue texts: no other allocation is as large. */
struct counter {
    size_t large;
    atomic_uint count;
};

static void *count_allocation(void *user, size_t size, size_t alignment)
{
    struct counter *counter = user;
    (void)alignment;
    if (size >= counter->large)
        atomic_fetch_add(&counter->count, 1);
    return malloc(size);
}

static void count_free(void *user, void *memory, size_t size)
{
    (void)user, (void)size;
    free(memory);
}

static void a_file_of_names_is_read_once_until_it_is_changed(void **state)
{
    (void)state;
    struct server server;
    char path[256];
    setup(&server, false);
    sluiceDestroyImageOpener(server.opener);
    write_catalogue(&server, "list.tsv", "a.store", 0, 20000);
    struct counter counter = {.large = (size_t)20000 * 50};
    SluiceAllocationCallbacks callbacks = {&counter, count_allocation, count_free};
    SluiceImageOpenerCreateInfo info = opener_info(&server);
    info.pAllocator = &callbacks;
    CHECK_OK(sluiceCreateImageOpener(&info, &server.opener));
    bake_folder_file(&server.folder, "list.tsv", path);
    open_on_threads(server.opener, path);
    assert_int_equal(atomic_load(&counter.count), 1);
    write_catalogue(&server, "list.tsv", "b.store", 0, 20000);
    assert_int_equal(width_of(server.opener, path, "p7.png", SLUICE_SUCCESS), 80);
    assert_int_equal(atomic_load(&counter.count), 2);
    teardown(&server);
}

/* A name that is new, or that now has another store. No message may come before it is certain. */
static void changes_on_a_server_are_noticed_before_a_name_is_missing(void **state)
{
    (void)state;
    for (int way = 0; way < 3; way++) {
        struct server server;
        setup(&server, way > 0);
        server.tells_no_version = way == 2;
        write_catalogue(&server, "list.tsv", "a.store", 0, 2);
        assert_int_equal(width_of(server.opener, "net://list.tsv", "p1.png", SLUICE_SUCCESS), 64);
        write_catalogue(&server, "list.tsv", "a.store", 2, 2);
        assert_int_equal(width_of(server.opener, "net://list.tsv", "p3.png", SLUICE_SUCCESS), 64);
        assert_int_equal(atomic_load(&server.opened), 2);
        write_store(&server, "a.store", 96);
        write_catalogue(&server, "list.tsv", "a.store", 0, 4);
        assert_int_equal(width_of(server.opener, "net://list.tsv", "p2.png", SLUICE_SUCCESS), 96);
        assert_int_equal(atomic_load(&server.opened), 3);
        assert_int_equal(atomic_load(&server.errors), 0);
        width_of(server.opener, "net://list.tsv", "p9.png", SLUICE_ERROR_INVALID_ARGUMENT);
        assert_int_equal(atomic_load(&server.errors), 1);
        assert_non_null(strstr(server.last, "no picture and no store 'p9.png'"));
        /* Unchanged: read again only if the server cannot be asked. */
        assert_int_equal(atomic_load(&server.opened), way == 1 ? 3 : 4);
        teardown(&server);
    }
}

static void a_row_that_moved_is_noticed_in_time(void **state)
{
    (void)state;
    struct server server;
    setup(&server, true);
    write_catalogue(&server, "list.tsv", "a.store", 0, 2);
    assert_int_equal(width_of(server.opener, "net://list.tsv", "p1.png", SLUICE_SUCCESS), 64);
    write_catalogue(&server, "list.tsv", "b.store", 0, 2);
    uint32_t width = 64;
    for (int i = 0; i < 400 && width == 64; i++) {
        nanosleep(&(struct timespec){0, 50000000}, NULL);
        width = width_of(server.opener, "net://list.tsv", "p1.png", SLUICE_SUCCESS);
    }
    assert_int_equal(width, 80);
    assert_int_equal(atomic_load(&server.opened), 2);
    teardown(&server);
}

static void eight_catalogues_stay_in_memory(void **state)
{
    (void)state;
    struct server server;
    char name[32], path[64];
    setup(&server, true);
    for (int i = 0; i < 12; i++) {
        snprintf(name, sizeof name, "%d.tsv", i);
        write_catalogue(&server, name, "a.store", 0, 1);
        snprintf(path, sizeof path, "net://%s", name);
        assert_int_equal(width_of(server.opener, path, "p0.png", SLUICE_SUCCESS), 64);
    }
    assert_int_equal(atomic_load(&server.opened) - atomic_load(&server.closed), 8);
    assert_int_equal(width_of(server.opener, "net://11.tsv", "p0.png", SLUICE_SUCCESS), 64);
    assert_int_equal(width_of(server.opener, "net://4.tsv", "p0.png", SLUICE_SUCCESS), 64);
    assert_int_equal(atomic_load(&server.opened), 12);
    assert_int_equal(width_of(server.opener, "net://3.tsv", "p0.png", SLUICE_SUCCESS), 64);
    assert_int_equal(atomic_load(&server.opened), 13);
    for (int i = 20; i < 32; i++) { /* one that is used stays */
        snprintf(name, sizeof name, "%d.tsv", i);
        write_catalogue(&server, name, "a.store", 0, 1);
        snprintf(path, sizeof path, "net://%s", name);
        assert_int_equal(width_of(server.opener, path, "p0.png", SLUICE_SUCCESS), 64);
        assert_int_equal(width_of(server.opener, "net://3.tsv", "p0.png", SLUICE_SUCCESS), 64);
    }
    assert_int_equal(atomic_load(&server.opened), 25);
    teardown(&server);
}

static void *change_catalogue(void *argument)
{
    struct server *server = argument;
    for (int i = 0; i < 10; i++)
        write_catalogue(server, "list.tsv", i % 2 ? "a.store" : "b.store", 0, NAMES);
    return NULL;
}

static void threads_open_names_while_the_catalogue_changes(void **state)
{
    (void)state;
    for (int is_remote = 0; is_remote < 2; is_remote++) {
        struct server server;
        pthread_t thread;
        char path[256];
        setup(&server, true);
        write_catalogue(&server, "list.tsv", "a.store", 0, NAMES);
        assert_int_equal(pthread_create(&thread, NULL, change_catalogue, &server), 0);
        bake_folder_file(&server.folder, "list.tsv", path);
        for (int i = 0; i < 3; i++)
            open_on_threads(server.opener, is_remote ? "net://list.tsv" : path);
        pthread_join(thread, NULL);
        teardown(&server);
    }
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    struct server server;
    char path[256];
    setup(&server, true);
    write_catalogue(&server, "list.tsv", "a.store", 0, 3);
    bake_folder_file(&server.folder, "list.tsv", path);
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        SluiceImageOpener *opener = NULL;
        SluiceImageSource *first = NULL, *second = NULL;
        failing_allocator_init(&allocator, n);
        SluiceImageOpenerCreateInfo info = opener_info(&server);
        info.pAllocator = &allocator.callbacks;
        result = sluiceCreateImageOpener(&info, &opener);
        if (result == SLUICE_SUCCESS)
            result = sluiceOpenNamedImageSource(opener, "net://list.tsv", "p1.png", &first);
        if (result == SLUICE_SUCCESS)
            result = sluiceOpenNamedImageSource(opener, path, "p2.png", &second);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        sluiceDestroyImageSource(first);
        sluiceDestroyImageSource(second);
        sluiceDestroyImageOpener(opener);
        assert_int_equal(allocator.live_count, 0);
    }
    teardown(&server);
}

/* Returns 2 if the texts are equal, and 1 if `text` ends with a slash and the name. */
static int match(const char *text, const char *name)
{
    size_t length = strlen(text), wanted = strlen(name);
    if (strcmp(text, name) == 0)
        return 2;
    return length > wanted && text[length - wanted - 1] == '/' &&
           strcmp(text + length - wanted, name) == 0;
}

static char random_name(uint32_t *seed, char name[8])
{
    *seed = *seed * 1664525u + 1013904223u;
    uint32_t bits = *seed >> 8;
    int length = 1 + (int)(bits % 6);
    bits /= 6;
    for (int i = 0; i < length; i++, bits /= 3)
        name[i] = "ab/"[bits % 3];
    name[length] = '\0';
    return name[0];
}

/* The oracle searches every row. */
static void names_are_found_as_by_looking_at_all_rows(void **state)
{
    (void)state;
    enum { ROWS = 40 };
    uint32_t seed = 1, found = 0, several = 0;
    for (int round = 0; round < 50; round++) {
        char text[8192] = HEAD, names[ROWS][2][8];
        for (uint32_t i = 0; i < ROWS; i++) {
            random_name(&seed, names[i][0]);
            while (random_name(&seed, names[i][1]) == '/')
                continue;
            snprintf(text + strlen(text), 100, "%016x\tR\t1\t1\t1\t1\t%s\t%s\n", (unsigned)i,
                     names[i][0], names[i][1]);
        }
        SluiceAllocationCallbacks cb = {NULL, NULL, NULL};
        struct failing_allocator allocator;
        failing_allocator_init(&allocator, UINT64_MAX);
        cb = allocator.callbacks;
        SluiceInput input = {.structSize = sizeof input, .pBytes = text, .size = strlen(text)};
        struct slc_catalogue_place place = {
            .path = "x", .shown = "x", .input = &input, .allocator = &cb};
        struct slc_catalogue *catalogue;
        CHECK_OK(slc_catalogue_read(&place, &catalogue));
        for (int query = 0; query < 200; query++) {
            char name[8];
            uint32_t counts[3] = {0}, last[3] = {0};
            random_name(&seed, name);
            for (uint32_t i = 0; i < ROWS; i++) {
                int a = match(names[i][0], name), b = match(names[i][1], name);
                counts[a > b ? a : b]++;
                last[a > b ? a : b] = i;
            }
            int best = counts[2] ? 2 : 1;
            struct slc_catalogue_entry entry = {0};
            SluiceResult result = slc_catalogue_find(catalogue, &place, name, &entry);
            CHECK_RESULT(result,
                         counts[best] == 1 ? SLUICE_SUCCESS : SLUICE_ERROR_INVALID_ARGUMENT);
            if (result == SLUICE_SUCCESS) {
                assert_int_equal(entry.hash, last[best]);
                assert_string_equal(entry.store, names[last[best]][1]);
            }
            found += counts[best] == 1;
            several += counts[best] > 1;
            slc_catalogue_entry_finish(&entry, &cb);
        }
        slc_catalogue_destroy(catalogue, &cb);
        assert_int_equal(allocator.live_count, 0);
    }
    assert_true(found > 500 && several > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_catalogue_of_a_server_is_read_once_for_all_threads_and_names),
        cmocka_unit_test(a_file_of_names_is_read_once_until_it_is_changed),
        cmocka_unit_test(changes_on_a_server_are_noticed_before_a_name_is_missing),
        cmocka_unit_test(a_row_that_moved_is_noticed_in_time),
        cmocka_unit_test(eight_catalogues_stay_in_memory),
        cmocka_unit_test(threads_open_names_while_the_catalogue_changes),
        cmocka_unit_test(every_refused_allocation_is_survived),
        cmocka_unit_test(names_are_found_as_by_looking_at_all_rows),
    };
    return RUN_TESTS(tests);
}
