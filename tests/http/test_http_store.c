/* A tile store on a web server, read by a source as from a disk. */
#define _XOPEN_SOURCE 700

#include "http/web_server.h"
#include "store/stores.h"
#include "support/test.h"

#include <sluice/http.h>

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#define SIZE 1024u
#define THREADS 8u

struct remote {
    struct scratch scratch;
    struct messages messages;
    SluiceHttpClient *client;
    SluiceHttpFile *file;
    SluiceImageSource *source;
};

/* `query` is added to the URL of the store. */
static void remote_init(struct remote *remote, const char *query)
{
    char url[512];
    *remote = (struct remote){0};
    scratch_init(&remote->scratch);
    SluiceStoreCreateInfo create = {.structSize = sizeof create,
                                    .pPath = remote->scratch.path,
                                    .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                    .width = SIZE,
                                    .height = SIZE};
    CHECK_OK(write_store(&create, PICTURE_MIXED));
    SluiceHttpClientCreateInfo info = {.structSize = sizeof info,
                                       .maxConnectionsPerHost = 4,
                                       .retryDelay = 1,
                                       .headSize = 4096,
                                       .log = messages_log(&remote->messages)};
    CHECK_OK(sluiceCreateHttpClient(&info, &remote->client));
    snprintf(url, sizeof url, "http://127.0.0.1:%u/file/store?path=%s%s", web_server.ports[0],
             remote->scratch.path, query);
    CHECK_OK(sluiceOpenHttpFile(remote->client, url, &remote->file));
    SluiceInput input = {.structSize = sizeof input};
    CHECK_OK(sluiceGetHttpInput(remote->file, &input));
    SluiceStoreImageSourceCreateInfo source = {.structSize = sizeof source,
                                               .pPath = "remote.store",
                                               .pInput = &input,
                                               .log = messages_log(&remote->messages)};
    CHECK_OK(sluiceCreateStoreImageSource(&source, &remote->source));
}

static void remote_finish(struct remote *remote)
{
    sluiceDestroyImageSource(remote->source);
    sluiceDestroyHttpFile(remote->file);
    sluiceDestroyHttpClient(remote->client);
    scratch_finish(&remote->scratch);
}

struct reader {
    pthread_t thread;
    SluiceImageSource *source;
    uint32_t number;
    SluiceResult result;
    bool is_right;
};

/* Every THREADS-th tile of 128 x 128 texels of level 0. */
static void *read_tiles(void *argument)
{
    struct reader *reader = argument;
    unsigned char *texels = malloc(65536);
    reader->is_right = true;
    for (uint32_t i = reader->number; i < SIZE / 128 * (SIZE / 128); i += THREADS) {
        SluiceImageRegion region = {0, i % (SIZE / 128) * 128, i / (SIZE / 128) * 128, 128, 128, 0};
        SluiceResult result = sluiceReadImageRegion(reader->source, &region, texels, 512);
        if (result != SLUICE_SUCCESS)
            reader->result = result;
        else if (!is_painted(PICTURE_MIXED, SLUICE_FORMAT_R8G8B8A8_UNORM, &region, texels, 512))
            reader->is_right = false;
    }
    free(texels);
    return NULL;
}

static void read_all(struct remote *remote)
{
    struct reader readers[THREADS];
    for (uint32_t i = 0; i < THREADS; i++) {
        readers[i] = (struct reader){.source = remote->source, .number = i};
        assert_int_equal(pthread_create(&readers[i].thread, NULL, read_tiles, &readers[i]), 0);
    }
    for (uint32_t i = 0; i < THREADS; i++) {
        pthread_join(readers[i].thread, NULL);
        CHECK_OK(readers[i].result);
        assert_true(readers[i].is_right);
    }
}

static void every_tile_is_equal_to_the_one_on_the_disk(void **state)
{
    struct remote remote;
    (void)state;
    remote_init(&remote, "");
    SluiceHttpStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetHttpStatistics(remote.client, &statistics));
    assert_int_equal(statistics.requestTotal, 1); /* header and index came with the opening */
    read_all(&remote);
    CHECK_OK(sluiceGetHttpStatistics(remote.client, &statistics));
    assert_int_equal(statistics.retryTotal, 0);
    assert_int_equal(remote.messages.errors, 0);
    remote_finish(&remote);
}

static void a_store_is_verified_over_the_network(void **state)
{
    struct remote remote;
    (void)state;
    remote_init(&remote, "&every=1000");
    SluiceInput input = {.structSize = sizeof input};
    SluiceStoreReport here = {.structSize = sizeof here}, there = {.structSize = sizeof there};
    SluiceStoreVerifyInfo info = {.structSize = sizeof info, .pPath = remote.scratch.path};
    CHECK_OK(sluiceVerifyStore(&info, &here));
    CHECK_OK(sluiceGetHttpInput(remote.file, &input));
    info.pPath = NULL;
    CHECK_RESULT(sluiceVerifyStore(&info, &there), SLUICE_ERROR_NULL_POINTER);
    info.pInput = &input;
    CHECK_OK(sluiceVerifyStore(&info, &there));
    assert_int_equal(there.tileCount, here.tileCount);
    assert_int_equal(there.storedSize, here.storedSize);
    remote_finish(&remote);
}

static void cut_bodies_cost_attempts_and_no_texel(void **state)
{
    struct remote remote;
    (void)state;
    remote_init(&remote, "&every=5");
    read_all(&remote);
    SluiceHttpStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetHttpStatistics(remote.client, &statistics));
    assert_true(statistics.retryTotal > 0);
    assert_int_equal(remote.messages.errors, 0);
    remote_finish(&remote);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_tile_is_equal_to_the_one_on_the_disk),
        cmocka_unit_test(a_store_is_verified_over_the_network),
        cmocka_unit_test(cut_bodies_cost_attempts_and_no_texel),
    };
    tap_filter_stdout();
    return cmocka_run_group_tests_name(__FILE__, tests, web_server_start, web_server_stop);
}
