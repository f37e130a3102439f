/* One writer and many threads, one source and many threads. */
#include "base/checked.h"
#include "store/stores.h"
#include "support/test.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { THREADS = 4, READS = 80 };

struct job {
    SluiceStoreWriter *writer;
    SluiceImageSource *source;
    SluiceStoreLayout layout;
    uint32_t layer_count, random;
    atomic_uint *next;
    atomic_uint *failures;
};

static SluiceStoreCreateInfo describe(const struct scratch *scratch, uint32_t compression)
{
    return (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                   .pPath = scratch->path,
                                   .width = 900,
                                   .height = 700,
                                   .arrayLayerCount = 3,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                   .compressionLevel = compression};
}

/* Threads take one tile after the other; each asks, writes, and asks again. */
static void *write_some(void *argument)
{
    const struct job *job = argument;
    uint32_t number = 0, mine = atomic_fetch_add(job->next, 1);
    for (uint32_t layer = 0; layer < job->layer_count; layer++)
        for (uint32_t l = 0; l <= job->layout.tailFirstLevel; l++)
            for (uint32_t y = 0; y < job->layout.levelHeightInTiles[l]; y++)
                for (uint32_t x = 0; x < job->layout.levelWidthInTiles[l]; x++) {
                    if (number++ != mine)
                        continue;
                    bool before = true, after = false;
                    uint64_t done, total;
                    if (sluiceIsStoreTileWritten(job->writer, layer, l, x, y, &before) ||
                        write_one(job->writer, &job->layout, PICTURE_MIXED, layer, l, x, y) ||
                        sluiceIsStoreTileWritten(job->writer, layer, l, x, y, &after) ||
                        sluiceGetStoreProgress(job->writer, &done, &total) || before || !after ||
                        done == 0)
                        atomic_fetch_add(job->failures, 1);
                    mine = atomic_fetch_add(job->next, 1);
                }
    return NULL;
}

static void *read_some(void *argument)
{
    struct job *job = argument;
    for (int i = 0; i < READS; i++) {
        uint32_t random = job->random = job->random * 1664525u + 1013904223u;
        uint32_t level = (random >> 8) % job->layout.mipLevelCount;
        SluiceImageRegion region;
        if (sluiceGetStoreTileRegion(
                &job->layout, level, (random >> 12) % job->layout.levelWidthInTiles[level],
                (random >> 20) % job->layout.levelHeightInTiles[level], &region))
            atomic_fetch_add(job->failures, 1);
        region.arrayLayer = (random >> 24) % job->layer_count;
        region.width = region.width - (random & 1) * (region.width / 2);
        size_t pitch = sluiceGetFormatRegionSize(job->layout.format, region.width, 1);
        void *texels = malloc(pitch * region.height);
        if (sluiceReadImageRegion(job->source, &region, texels, pitch) ||
            !is_painted(PICTURE_MIXED, job->layout.format, &region, texels, pitch))
            atomic_fetch_add(job->failures, 1);
        free(texels);
    }
    return NULL;
}

static void run(struct job *job, void *(*function)(void *))
{
    pthread_t threads[THREADS];
    struct job jobs[THREADS];
    atomic_uint next = 0, failures = 0;
    for (uint32_t i = 0; i < THREADS; i++) {
        jobs[i] = *job;
        jobs[i].random = i + 1;
        jobs[i].next = &next;
        jobs[i].failures = &failures;
        assert_int_equal(pthread_create(&threads[i], NULL, function, &jobs[i]), 0);
    }
    for (uint32_t i = 0; i < THREADS; i++)
        pthread_join(threads[i], NULL);
    assert_int_equal(failures, 0);
}

static void write_with_threads(const SluiceStoreCreateInfo *info)
{
    struct job job = {.layer_count = info->arrayLayerCount};
    CHECK_OK(sluiceCreateStoreWriter(info, &job.writer));
    CHECK_OK(sluiceGetStoreWriterLayout(job.writer, &job.layout));
    run(&job, write_some);
    CHECK_OK(sluiceFinishStore(job.writer));
    sluiceDestroyStoreWriter(job.writer);
}

static void threads_that_write_at_once_make_a_whole_file(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 1; compression++) {
        struct scratch scratch;
        scratch_init(&scratch);
        SluiceStoreCreateInfo info = describe(&scratch, compression);
        write_with_threads(&info);
        CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
        SluiceStoreVerifyInfo verify = {.structSize = sizeof verify, .pPath = scratch.path};
        CHECK_OK(sluiceVerifyStore(&verify, NULL));
        scratch_finish(&scratch);
    }
}

static void an_uncompressed_file_has_the_same_bytes_whatever_threads_do(void **state)
{
    (void)state;
    struct scratch one, many;
    scratch_init(&one);
    scratch_init(&many);
    SluiceStoreCreateInfo info = describe(&one, 0);
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    info.pPath = many.path;
    write_with_threads(&info);
    size_t sizes[2];
    unsigned char *bytes[] = {read_bytes(one.path, &sizes[0]), read_bytes(many.path, &sizes[1])};
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    free(bytes[0]);
    free(bytes[1]);
    scratch_finish(&one);
    scratch_finish(&many);
}

static void threads_that_read_at_once_get_what_was_written(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 1; compression++) {
        struct scratch scratch;
        scratch_init(&scratch);
        SluiceStoreCreateInfo info = describe(&scratch, compression);
        CHECK_OK(write_store(&info, PICTURE_MIXED));
        struct job job = {.layer_count = info.arrayLayerCount};
        CHECK_OK(sluiceGetStoreLayout(info.width, info.height, info.format, &job.layout));
        SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                                   .pPath = scratch.path};
        CHECK_OK(sluiceCreateStoreImageSource(&create, &job.source));
        run(&job, read_some);
        sluiceDestroyImageSource(job.source);
        scratch_finish(&scratch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_that_write_at_once_make_a_whole_file),
        cmocka_unit_test(an_uncompressed_file_has_the_same_bytes_whatever_threads_do),
        cmocka_unit_test(threads_that_read_at_once_get_what_was_written),
    };
    return RUN_TESTS(tests);
}
