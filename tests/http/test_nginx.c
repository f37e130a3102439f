/* Tile stores on nginx. Skipped where it is not installed. */
#define _XOPEN_SOURCE 700

#include "http/nginx_server.h"
#include "store/stores.h"
#include "support/test.h"

#include <sluice/http.h>

#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define SIZE 1024u
#define COLUMNS (SIZE / 128)
#define TILES (COLUMNS * COLUMNS)
#define THREADS 8u

static struct nginx_server server;

/* `second` is the date of the file: nginx makes its ETag of date and size alone. */
static void write_picture(const char *name, enum picture picture, time_t second)
{
    char path[128];
    const struct timespec times[2] = {{second, 0}, {second, 0}};
    snprintf(path, sizeof path, "%s/www/%s", server.folder, name);
    SluiceStoreCreateInfo create = {.structSize = sizeof create,
                                    .pPath = path,
                                    .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                    .width = SIZE,
                                    .height = SIZE};
    CHECK_OK(write_store(&create, picture));
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

struct remote {
    struct messages messages;
    SluiceHttpClient *client;
    SluiceHttpFile *file;
    SluiceImageSource *source;
};

static SluiceHttpClientCreateInfo quick(struct remote *remote)
{
    return (SluiceHttpClientCreateInfo){.structSize = sizeof(SluiceHttpClientCreateInfo),
                                        .maxConnectionsPerHost = 4,
                                        .retryDelay = 2,
                                        .maxRetryDelay = 20,
                                        .headSize = 4096,
                                        .log = messages_log(&remote->messages)};
}

/* `info` is of quick(remote). */
static SluiceResult remote_open(struct remote *remote, const SluiceHttpClientCreateInfo *info,
                                const char *path, bool has_tls)
{
    char url[512];
    SluiceInput input = {.structSize = sizeof input};
    CHECK_OK(sluiceCreateHttpClient(info, &remote->client));
    snprintf(url, sizeof url, "%s://127.0.0.1:%u/%s", has_tls ? "https" : "http",
             has_tls ? server.tls_port : server.port, path);
    SluiceResult result = sluiceOpenHttpFile(remote->client, url, &remote->file);
    if (result != SLUICE_SUCCESS)
        return result;
    CHECK_OK(sluiceGetHttpInput(remote->file, &input));
    SluiceStoreImageSourceCreateInfo source = {
        .structSize = sizeof source, .pPath = url, .pInput = &input};
    return sluiceCreateStoreImageSource(&source, &remote->source);
}

static void remote_finish(struct remote *remote)
{
    sluiceDestroyImageSource(remote->source);
    sluiceDestroyHttpFile(remote->file);
    sluiceDestroyHttpClient(remote->client);
}

static SluiceHttpStatistics statistics_of(const struct remote *remote)
{
    SluiceHttpStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetHttpStatistics(remote->client, &statistics));
    return statistics;
}

/* A tile of level 0. `is_right` may be NULL. */
static SluiceResult read_tile(const struct remote *remote, uint32_t i, enum picture picture,
                              bool *is_right)
{
    unsigned char *texels = malloc(65536);
    SluiceImageRegion region = {0, i % COLUMNS * 128, i / COLUMNS * 128, 128, 128, 0};
    SluiceResult result = sluiceReadImageRegion(remote->source, &region, texels, 512);
    if (is_right)
        *is_right = result == SLUICE_SUCCESS &&
                    is_painted(picture, SLUICE_FORMAT_R8G8B8A8_UNORM, &region, texels, 512);
    free(texels);
    return result;
}

struct reader {
    pthread_t thread;
    const struct remote *remote;
    uint32_t number, wrong;
};

static void *read_tiles(void *argument)
{
    struct reader *reader = argument;
    for (uint32_t i = reader->number; i < TILES; i += THREADS) {
        bool is_right;
        read_tile(reader->remote, i, PICTURE_MIXED, &is_right);
        reader->wrong += !is_right;
    }
    return NULL;
}

static void read_all(const struct remote *remote)
{
    struct reader readers[THREADS];
    for (uint32_t i = 0; i < THREADS; i++) {
        readers[i] = (struct reader){.remote = remote, .number = i};
        assert_int_equal(pthread_create(&readers[i].thread, NULL, read_tiles, &readers[i]), 0);
    }
    for (uint32_t i = 0; i < THREADS; i++) {
        pthread_join(readers[i].thread, NULL);
        assert_int_equal(readers[i].wrong, 0);
    }
}

/* nginx closes each connection after five requests. */
static void every_tile_is_right_though_connections_are_closed(void **state)
{
    struct remote remote = {0};
    SluiceHttpClientCreateInfo info = quick(&remote);
    (void)state;
    write_picture("a.store", PICTURE_MIXED, 1000);
    CHECK_OK(remote_open(&remote, &info, "a.store", false));
    read_all(&remote);
    SluiceHttpStatistics statistics = statistics_of(&remote);
    assert_true(statistics.connectTotal > 4);
    assert_int_equal(statistics.retryTotal, 0);
    assert_int_equal(remote.messages.errors, 0);
    remote_finish(&remote);
}

static void tls_and_redirects_lead_to_the_same_tiles(void **state)
{
    struct remote remote = {0};
    char certificate[128];
    SluiceHttpClientCreateInfo info = quick(&remote);
    (void)state;
    snprintf(certificate, sizeof certificate, "%s/certificate.pem", server.folder);
    info.pCertificateFile = certificate;
    write_picture("b.store", PICTURE_MIXED, 1000);
    CHECK_OK(remote_open(&remote, &info, "moved/b.store", true));
    read_all(&remote);
    remote_finish(&remote);
    remote = (struct remote){0};
    info = quick(&remote);
    CHECK_RESULT(remote_open(&remote, &info, "b.store", true), SLUICE_ERROR_IO);
    assert_non_null(strstr(remote.messages.last, "certificate"));
    remote_finish(&remote);
}

static void a_replaced_file_fails_until_it_is_opened_again(void **state)
{
    struct remote remote = {0};
    SluiceHttpClientCreateInfo info = quick(&remote);
    bool is_right;
    (void)state;
    write_picture("c.store", PICTURE_MIXED, 1000);
    CHECK_OK(remote_open(&remote, &info, "c.store", false));
    CHECK_OK(read_tile(&remote, 5, PICTURE_MIXED, &is_right));
    assert_true(is_right);
    write_picture("c.store", PICTURE_SMOOTH, 1001);
    CHECK_RESULT(read_tile(&remote, 6, PICTURE_MIXED, NULL), SLUICE_ERROR_IO);
    assert_non_null(strstr(remote.messages.last, "changed on the server"));
    remote_finish(&remote);
    remote = (struct remote){0};
    info = quick(&remote);
    CHECK_OK(remote_open(&remote, &info, "c.store", false));
    CHECK_OK(read_tile(&remote, 6, PICTURE_SMOOTH, &is_right));
    assert_true(is_right);
    remote_finish(&remote);
}

/* nginx tells no difference then, and the checksums of the store do. */
static void a_file_replaced_within_a_second_is_corrupt_data(void **state)
{
    struct remote remote = {0};
    SluiceHttpClientCreateInfo info = quick(&remote);
    (void)state;
    write_picture("g.store", PICTURE_MIXED, 1000);
    CHECK_OK(remote_open(&remote, &info, "g.store", false));
    CHECK_OK(read_tile(&remote, 5, PICTURE_MIXED, NULL)); /* and the index */
    write_picture("g.store", PICTURE_SMOOTH, 1000);
    CHECK_RESULT(read_tile(&remote, 6, PICTURE_MIXED, NULL), SLUICE_ERROR_CORRUPT_DATA);
    remote_finish(&remote);
}

static void a_server_that_comes_back_is_read_within_its_back_off(void **state)
{
    struct remote remote = {0};
    SluiceHttpClientCreateInfo info = quick(&remote);
    SluiceResult result = SLUICE_ERROR_IO;
    (void)state;
    write_picture("d.store", PICTURE_MIXED, 1000);
    CHECK_OK(remote_open(&remote, &info, "d.store", false));
    nginx_stop(&server);
    CHECK_RESULT(read_tile(&remote, 5, PICTURE_MIXED, NULL), SLUICE_ERROR_IO);
    nginx_start(&server);
    for (int left = 50; left > 0 && result != SLUICE_SUCCESS; left--) {
        nanosleep(&(struct timespec){0, 20000000}, NULL);
        result = read_tile(&remote, 5, PICTURE_MIXED, NULL);
    }
    CHECK_OK(result);
    read_all(&remote);
    remote_finish(&remote);
}

/* nginx answers 503 beyond its limit. */
static void tiles_come_from_a_server_that_limits_requests(void **state)
{
    struct remote remote = {0};
    SluiceHttpClientCreateInfo info = quick(&remote);
    (void)state;
    info.maxAttemptCount = 20;
    write_picture("e.store", PICTURE_MIXED, 1000);
    CHECK_OK(remote_open(&remote, &info, "limited/e.store", false));
    for (uint32_t i = 0; i < 5; i++) {
        SluiceResult result = SLUICE_ERROR_IO;
        for (int left = 50; left > 0 && result != SLUICE_SUCCESS; left--)
            result = read_tile(&remote, i, PICTURE_MIXED, NULL);
        CHECK_OK(result);
    }
    assert_true(statistics_of(&remote).retryTotal > 0);
    remote_finish(&remote);
}

static void a_server_without_ranges_is_refused(void **state)
{
    struct remote remote = {0};
    SluiceHttpClientCreateInfo info = quick(&remote);
    (void)state;
    write_picture("f.store", PICTURE_MIXED, 1000);
    CHECK_RESULT(remote_open(&remote, &info, "whole/f.store", false), SLUICE_ERROR_UNSUPPORTED);
    assert_non_null(strstr(remote.messages.last, "ignores ranges"));
    remote_finish(&remote);
}

static int start(void **state)
{
    (void)state;
    nginx_init(&server);
    return 0;
}

static int finish(void **state)
{
    (void)state;
    nginx_finish(&server);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_tile_is_right_though_connections_are_closed),
        cmocka_unit_test(tls_and_redirects_lead_to_the_same_tiles),
        cmocka_unit_test(a_replaced_file_fails_until_it_is_opened_again),
        cmocka_unit_test(a_file_replaced_within_a_second_is_corrupt_data),
        cmocka_unit_test(a_server_that_comes_back_is_read_within_its_back_off),
        cmocka_unit_test(tiles_come_from_a_server_that_limits_requests),
        cmocka_unit_test(a_server_without_ranges_is_refused),
    };
    if (!nginx_is_there()) {
        printf("1..0 # SKIP nginx or openssl is not installed\n");
        return 0;
    }
    tap_filter_stdout();
    return cmocka_run_group_tests_name(__FILE__, tests, start, finish);
}
