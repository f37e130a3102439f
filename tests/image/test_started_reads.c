/* Sources that start reads and complete them later, on any thread. */
#define _POSIX_C_SOURCE 200809L

#include <sluice/loader.h>

#include "support/test.h"

#include <pthread.h>
#include <time.h>

enum { SIZE = 16, LEVELS = 5, MAX_PENDING = 512 };

struct pending {
    SluiceImageReadToken token;
    SluiceImageRegion region;
    float *texels;
};

/* A source of R32_SFLOAT: a texel is 1000 level + its x. */
struct source {
    SluiceImageSource base; ///< must be first
    pthread_mutex_t mutex;
    struct pending pending[MAX_PENDING];
    uint32_t count, start_count, read_count, cancel_count;
    uint32_t level_count;  ///< 0: LEVELS
    bool at_once;          ///< true: completes before pfnStartRead returns
    SluiceResult refusal;  ///< result of pfnStartRead, if not SLUICE_SUCCESS
    bool obeys;            ///< true: completes canceled reads
    bool ends;             ///< tells complete_all to end
    SluiceResult failures; ///< result of the next `failure_count` completions
    uint32_t failure_count;
};

static void pause_briefly(void)
{
    nanosleep(&(struct timespec){0, 50000}, NULL);
}

static void fill(const SluiceImageRegion *region, float *texels)
{
    for (uint32_t i = 0; i < region->width * region->height; i++)
        texels[i] = (float)(1000 * region->mipLevel + region->x + i % region->width);
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    const struct source *source = (struct source *)base;
    info->width = info->height = SIZE;
    info->mipLevelCount = source->level_count ? source->level_count : LEVELS;
    info->format = SLUICE_FORMAT_R32_SFLOAT;
    info->pName = "started";
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct source *source = (struct source *)base;
    (void)row_pitch;
    pthread_mutex_lock(&source->mutex);
    source->read_count++;
    pthread_mutex_unlock(&source->mutex);
    fill(region, texels);
    return SLUICE_SUCCESS;
}

static SluiceResult complete(struct source *source, const struct pending *read)
{
    SluiceResult result = SLUICE_SUCCESS;
    pthread_mutex_lock(&source->mutex);
    if (source->failure_count) {
        source->failure_count--;
        result = source->failures;
    }
    pthread_mutex_unlock(&source->mutex);
    fill(&read->region, read->texels);
    return sluiceCompleteImageRead(&read->token, result);
}

static SluiceResult start_read(SluiceImageSource *base, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch, const SluiceImageReadToken *token)
{
    struct source *source = (struct source *)base;
    const struct pending read = {*token, *region, texels};
    assert_int_equal(row_pitch, region->width * sizeof(float));
    if (source->refusal != SLUICE_SUCCESS)
        return source->refusal;
    pthread_mutex_lock(&source->mutex);
    source->start_count++;
    assert_true(source->count < MAX_PENDING);
    if (!source->at_once)
        source->pending[source->count++] = read;
    pthread_mutex_unlock(&source->mutex);
    if (source->at_once)
        CHECK_OK(complete(source, &read));
    return SLUICE_SUCCESS;
}

/* Takes the newest pending read, or the read of a token. */
static bool take(struct source *source, const SluiceImageReadToken *token, struct pending *read)
{
    pthread_mutex_lock(&source->mutex);
    uint32_t at = source->count - 1;
    while (token && at < source->count &&
           (source->pending[at].token.pReader != token->pReader ||
            source->pending[at].token.ticket != token->ticket ||
            source->pending[at].token.region != token->region ||
            source->pending[at].token.attempt != token->attempt))
        at--;
    bool found = at < source->count;
    if (found) {
        *read = source->pending[at];
        source->pending[at] = source->pending[--source->count];
    }
    pthread_mutex_unlock(&source->mutex);
    return found;
}

static void cancel_read(SluiceImageSource *base, const SluiceImageRegion *region,
                        const SluiceImageReadToken *token)
{
    struct source *source = (struct source *)base;
    struct pending read;
    pthread_mutex_lock(&source->mutex);
    source->cancel_count++;
    pthread_mutex_unlock(&source->mutex);
    if (source->obeys && take(source, token, &read)) {
        assert_memory_equal(&read.region, region, sizeof *region);
        CHECK_OK(sluiceCompleteImageRead(token, SLUICE_ERROR_CANCELED));
    }
}

static void destroy(SluiceImageSource *base)
{
    (void)base;
}

static const SluiceImageSourceInterface interface = {.structSize = sizeof interface,
                                                     .pfnGetInfo = get_info,
                                                     .pfnReadRegion = read_region,
                                                     .pfnDestroy = destroy,
                                                     .pfnStartRead = start_read,
                                                     .pfnCancelRead = cancel_read};

/* Creates a loader with one thread, which a blocking source would occupy. */
static SluiceTileLoader *begin(struct source *source, uint64_t max_bytes)
{
    *source = (struct source){.base = {&interface}};
    pthread_mutex_init(&source->mutex, NULL);
    const SluiceTileLoaderCreateInfo info = {.structSize = sizeof info,
                                             .threadCount = 1,
                                             .maxReadsPerSource = 1,
                                             .maxBytesInFlight = max_bytes,
                                             .retry = {3, 1, 1}};
    SluiceTileLoader *loader;
    CHECK_OK(sluiceCreateTileLoader(&info, &loader));
    return loader;
}

static void await_pending(struct source *source, uint32_t count)
{
    for (uint32_t now = 0; now < count; pause_briefly()) {
        pthread_mutex_lock(&source->mutex);
        now = source->count;
        pthread_mutex_unlock(&source->mutex);
    }
}

static uint32_t count_starts(struct source *source)
{
    pthread_mutex_lock(&source->mutex);
    uint32_t count = source->start_count;
    pthread_mutex_unlock(&source->mutex);
    return count;
}

static uint64_t submit(SluiceTileLoader *loader, SluiceImageSource *source, uint32_t region_count,
                       uint32_t level, float *texels)
{
    SluiceImageRegion regions[LEVELS];
    void *places[LEVELS];
    for (uint32_t i = 0; i < region_count; i++) {
        regions[i] = (SluiceImageRegion){level + i, 0, 0, 1, 1, 0};
        places[i] = &texels[i];
    }
    const SluiceTileRead read = {source, region_count, regions, places, 0, 7};
    uint64_t ticket = 0;
    CHECK_OK(sluiceSubmitTileRead(loader, &read, &ticket));
    return ticket;
}

static SluiceTileReadResult collect(SluiceTileLoader *loader)
{
    SluiceTileReadResult result;
    for (uint32_t count = 0; count == 0; pause_briefly()) {
        count = 1;
        assert_true(sluiceCollectTileReads(loader, &count, &result) >= 0); /* or INCOMPLETE */
    }
    return result;
}

static uint32_t count_finished(SluiceTileLoader *loader)
{
    SluiceTileReadResult result;
    uint32_t count = 1;
    CHECK_OK(sluiceCollectTileReads(loader, &count, &result));
    return count;
}

static void started_reads_occupy_no_thread_and_are_not_polled(void **state)
{
    (void)state;
    enum { COUNT = 20 };
    struct source source;
    struct pending read;
    float texels[COUNT] = {0};
    SluiceTileLoader *loader = begin(&source, 0);
    for (uint32_t i = 0; i < COUNT; i++)
        submit(loader, &source.base, 1, i % LEVELS, &texels[i]);
    await_pending(&source, COUNT);
    assert_int_equal(count_finished(loader), 0);
    while (take(&source, NULL, &read)) {
        CHECK_OK(complete(&source, &read));
        CHECK_RESULT(sluiceCompleteImageRead(&read.token, SLUICE_SUCCESS),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        CHECK_OK(collect(loader).result);
    }
    for (uint32_t i = 0; i < COUNT; i++)
        assert_true(texels[i] == (float)(1000 * (i % LEVELS)));
    SluiceTileLoaderStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetTileLoaderStatistics(loader, &source.base, &statistics));
    assert_int_equal(statistics.attemptCount, COUNT);
    assert_int_equal(statistics.byteCount, COUNT * sizeof(float));
    assert_int_equal(source.read_count, 0);
    sluiceDestroyTileLoader(loader);
}

static void a_read_may_be_completed_before_its_start_returns(void **state)
{
    (void)state;
    struct source source;
    float texels[3] = {0};
    SluiceTileLoader *loader = begin(&source, 0);
    source.at_once = true;
    submit(loader, &source.base, 3, 1, texels);
    CHECK_OK(collect(loader).result);
    assert_true(texels[0] == 1000 && texels[1] == 2000 && texels[2] == 3000);
    sluiceDestroyTileLoader(loader);
}

static void regions_are_started_together_and_the_last_one_ends_the_read(void **state)
{
    (void)state;
    struct source source;
    struct pending read;
    float texels[LEVELS] = {0};
    SluiceTileLoader *loader = begin(&source, 0);
    submit(loader, &source.base, LEVELS, 0, texels);
    await_pending(&source, LEVELS);
    for (uint32_t i = 0; i < LEVELS; i++) {
        assert_int_equal(count_finished(loader), 0);
        assert_true(take(&source, NULL, &read));
        CHECK_OK(complete(&source, &read));
    }
    SluiceTileReadResult result = collect(loader);
    CHECK_OK(result.result);
    assert_int_equal(result.size, sizeof texels);
    sluiceDestroyTileLoader(loader);
}

static void regions_that_failed_are_started_again_alone(void **state)
{
    (void)state;
    struct source source;
    struct pending read;
    float texels[3] = {0};
    SluiceTileLoader *loader = begin(&source, 0);
    source.failures = SLUICE_ERROR_IO;
    source.failure_count = 1;
    submit(loader, &source.base, 3, 0, texels);
    await_pending(&source, 3);
    struct pending first[3];
    for (int i = 0; i < 3; i++)
        assert_true(take(&source, NULL, &first[i]));
    for (int i = 0; i < 3; i++)
        CHECK_OK(complete(&source, &first[i]));
    await_pending(&source, 1);
    assert_int_equal(count_starts(&source), 4);
    CHECK_RESULT(sluiceCompleteImageRead(&first[0].token, SLUICE_SUCCESS),
                 SLUICE_ERROR_INVALID_ARGUMENT); /* token of the first attempt */
    assert_true(take(&source, NULL, &read));
    assert_int_equal(read.region.mipLevel, 2); /* the newest one failed */
    CHECK_OK(complete(&source, &read));
    CHECK_OK(collect(loader).result);
    source.failures = SLUICE_ERROR_UNSUPPORTED; /* final */
    source.failure_count = 1;
    submit(loader, &source.base, 1, 0, texels);
    await_pending(&source, 1);
    assert_true(take(&source, NULL, &read));
    CHECK_OK(complete(&source, &read));
    CHECK_RESULT(collect(loader).result, SLUICE_ERROR_UNSUPPORTED);
    sluiceDestroyTileLoader(loader);
}

static void canceled_reads_end_when_their_source_completes_them(void **state)
{
    (void)state;
    for (int obeys = 0; obeys < 2; obeys++) {
        struct source source;
        struct pending read;
        float texels[2];
        SluiceTileLoader *loader = begin(&source, 0);
        source.obeys = obeys;
        uint64_t ticket = submit(loader, &source.base, 2, 0, texels);
        await_pending(&source, 2);
        for (uint32_t told = 0; told < 2; pause_briefly()) { /* once its start has returned */
            CHECK_OK(sluiceCancelTileRead(loader, ticket));
            pthread_mutex_lock(&source.mutex);
            told = source.cancel_count;
            pthread_mutex_unlock(&source.mutex);
        }
        if (!obeys)
            assert_int_equal(count_finished(loader), 0);
        while (take(&source, NULL, &read))
            CHECK_OK(complete(&source, &read));
        CHECK_RESULT(collect(loader).result, obeys ? SLUICE_ERROR_CANCELED : SLUICE_SUCCESS);
        assert_int_equal(source.cancel_count, 2);
        sluiceDestroyTileLoader(loader);
    }
}

static void *complete_all(void *user)
{
    struct source *source = user;
    struct pending read;
    for (bool ends = false; !ends; pause_briefly()) {
        while (take(source, NULL, &read))
            complete(source, &read);
        pthread_mutex_lock(&source->mutex);
        ends = source->ends;
        pthread_mutex_unlock(&source->mutex);
    }
    return NULL;
}

static void finish(struct source *source, pthread_t thread)
{
    pthread_mutex_lock(&source->mutex);
    source->ends = true;
    pthread_mutex_unlock(&source->mutex);
    pthread_join(thread, NULL);
}

/* Two threads complete reads, the loader starts them, and this thread cancels. Some reads fail and
 * are retried. */
static void completions_cancels_and_destruction_may_meet(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    static float texels[COUNT][2];
    for (int round = 0; round < 3; round++) {
        struct source source;
        pthread_t threads[2];
        SluiceTileLoader *loader = begin(&source, 0);
        source.obeys = true;
        source.failures = SLUICE_ERROR_IO;
        source.failure_count = 40;
        for (int i = 0; i < 2; i++)
            assert_int_equal(pthread_create(&threads[i], NULL, complete_all, &source), 0);
        for (uint32_t i = 0; i < COUNT; i++) {
            uint64_t ticket = submit(loader, &source.base, 2, 0, texels[i]);
            if (i % 3 == 0)
                CHECK_OK(sluiceCancelTileRead(loader, ticket));
        }
        for (uint32_t i = 0; round > 0 && i < COUNT; i++) {
            SluiceResult result = collect(loader).result;
            assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_CANCELED ||
                        result == SLUICE_ERROR_IO);
        }
        sluiceDestroyTileLoader(loader);
        for (int i = 0; i < 2; i++)
            finish(&source, threads[i]);
        assert_int_equal(source.count, 0);
    }
}

static void sources_may_have_a_region_read_at_once(void **state)
{
    (void)state;
    struct source source;
    float texel = 0;
    SluiceTileLoader *loader = begin(&source, 0);
    source.refusal = SLUICE_ERROR_UNSUPPORTED;
    submit(loader, &source.base, 1, 2, &texel);
    CHECK_OK(collect(loader).result);
    assert_true(texel == 2000);
    assert_int_equal(source.read_count, 1);
    source.refusal = SLUICE_ERROR_CORRUPT_DATA;
    submit(loader, &source.base, 1, 2, &texel);
    CHECK_RESULT(collect(loader).result, SLUICE_ERROR_CORRUPT_DATA);
    sluiceDestroyTileLoader(loader);
}

static void layers_of_arrays_start_their_own_reads(void **state)
{
    (void)state;
    struct source source;
    struct pending read;
    float texel = 0;
    SluiceImageSource *array;
    SluiceTileLoader *loader = begin(&source, 0);
    source.obeys = true;
    CHECK_OK(sluiceCreateArrayImageSource((SluiceImageSource *[]){&source.base, &source.base}, 2,
                                          NULL, &array));
    const SluiceImageRegion region = {3, 0, 0, 1, 1, 1};
    void *place = &texel;
    const SluiceTileRead layer = {array, 1, &region, &place, 0, 0};
    uint64_t ticket;
    CHECK_OK(sluiceSubmitTileRead(loader, &layer, &ticket));
    await_pending(&source, 1);
    assert_true(take(&source, NULL, &read));
    assert_int_equal(read.region.arrayLayer, 0);
    CHECK_OK(complete(&source, &read));
    CHECK_OK(collect(loader).result);
    assert_true(texel == 3000);
    sluiceDestroyTileLoader(loader);
    sluiceDestroyImageSource(array);
}

static void completed_chains_start_the_levels_that_they_do_not_build(void **state)
{
    (void)state;
    struct source source;
    struct pending read;
    float texels[LEVELS] = {0}, built = 0;
    SluiceImageSource *chain;
    SluiceTileLoader *loader = begin(&source, 0);
    source.level_count = 2;
    source.obeys = true;
    const SluiceCompleteChainSourceCreateInfo info = {.structSize = sizeof info,
                                                      .source = &source.base};
    CHECK_OK(sluiceCreateCompleteChainSource(&info, &chain));
    submit(loader, chain, LEVELS, 0, texels);
    await_pending(&source, 2);
    assert_int_equal(count_finished(loader), 0);
    while (take(&source, NULL, &read))
        CHECK_OK(complete(&source, &read));
    CHECK_OK(collect(loader).result);
    assert_true(source.read_count > 0); /* reads for built levels */
    assert_true(texels[0] == 0 && texels[1] == 1000);
    assert_true(texels[2] == 1000.5f); /* the mean of texels 0 and 1 */
    uint64_t ticket = submit(loader, chain, 1, 1, &built);
    await_pending(&source, 1);
    CHECK_OK(sluiceCancelTileRead(loader, ticket));
    CHECK_RESULT(collect(loader).result, SLUICE_ERROR_CANCELED);
    assert_int_equal(source.cancel_count, 1);
    assert_int_equal(count_starts(&source), 3);
    sluiceDestroyTileLoader(loader);
    sluiceDestroyImageSource(chain);
}

static void bytes_of_started_reads_are_in_flight(void **state)
{
    (void)state;
    struct source source;
    struct pending read;
    float texels[6];
    SluiceTileLoader *loader = begin(&source, 2 * sizeof(float));
    submit(loader, &source.base, 1, 0, texels); /* makes the format known */
    await_pending(&source, 1);
    assert_true(take(&source, NULL, &read));
    CHECK_OK(complete(&source, &read));
    CHECK_OK(collect(loader).result);
    for (uint32_t i = 1; i < 6; i++)
        submit(loader, &source.base, 1, 0, &texels[i]);
    for (uint32_t i = 5; i > 0; i--) {
        await_pending(&source, i < 2 ? i : 2);
        assert_true(count_starts(&source) <= 6 - i + 3);
        assert_true(take(&source, NULL, &read));
        CHECK_OK(complete(&source, &read));
        CHECK_OK(collect(loader).result);
    }
    sluiceDestroyTileLoader(loader);
}

/* Pools -------------------------------------------------------------------------------------- */

/* Creates a pool with one thread for both loaders. */
static SluiceReadPool *begin_pool(struct source *source, SluiceTileLoader *loaders[2])
{
    *source = (struct source){.base = {&interface}};
    pthread_mutex_init(&source->mutex, NULL);
    const SluiceReadPoolCreateInfo info = {
        .structSize = sizeof info, .threadCount = 1, .maxReadsPerSource = 1};
    SluiceReadPool *pool;
    CHECK_OK(sluiceCreateReadPool(&info, &pool));
    for (int i = 0; i < 2; i++) {
        const SluiceTileLoaderCreateInfo loader = {
            .structSize = sizeof loader, .readPool = pool, .retry = {3, 1, 1}};
        CHECK_OK(sluiceCreateTileLoader(&loader, &loaders[i]));
    }
    return pool;
}

static void end_pool(SluiceReadPool *pool, SluiceTileLoader *loaders[2])
{
    for (int i = 0; i < 2; i++)
        sluiceDestroyTileLoader(loaders[i]);
    sluiceDestroyReadPool(pool);
}

/* Loader 0 has started level 1. Loader 1 waits for it, and has started level 2. Returns the tickets
 * of level 1. */
static void join(struct source *source, SluiceTileLoader *loaders[2], float texels[3],
                 uint64_t tickets[2])
{
    tickets[0] = submit(loaders[0], &source->base, 1, 1, &texels[0]);
    await_pending(source, 1);
    tickets[1] = submit(loaders[1], &source->base, 1, 1, &texels[1]);
    submit(loaders[1], &source->base, 1, 2, &texels[2]);
    await_pending(source, 2);
    assert_int_equal(count_starts(source), 2);
}

static void complete_level(struct source *source, uint32_t level)
{
    struct pending read = {0};
    for (uint32_t i = 0; i < source->count; i++)
        if (source->pending[i].region.mipLevel == level)
            read = source->pending[i];
    assert_true(take(source, &read.token, &read));
    CHECK_OK(complete(source, &read));
}

static void started_reads_are_joined(void **state)
{
    (void)state;
    struct source source;
    SluiceTileLoader *loaders[2];
    uint64_t tickets[2];
    float texels[3] = {0}, later = 0;
    SluiceReadPool *pool = begin_pool(&source, loaders);
    join(&source, loaders, texels, tickets);
    complete_level(&source, 1);
    CHECK_OK(collect(loaders[0]).result);
    SluiceTileReadResult joined = collect(loaders[1]);
    CHECK_OK(joined.result);
    assert_int_equal(joined.ticket, tickets[1]);
    assert_int_equal(joined.size, sizeof(float));
    complete_level(&source, 2);
    CHECK_OK(collect(loaders[1]).result);
    assert_true(texels[0] == 1000 && texels[1] == 1000 && texels[2] == 2000);
    submit(loaders[0], &source.base, 1, 2, &later);
    CHECK_OK(collect(loaders[0]).result);
    assert_true(later == 2000);
    assert_int_equal(count_starts(&source), 2);
    SluiceReadPoolStatistics now = {.structSize = sizeof now};
    CHECK_OK(sluiceGetReadPoolStatistics(pool, &now));
    assert_int_equal(now.readCount, 2);
    assert_int_equal(now.joinedCount, 1);
    assert_int_equal(now.cachedCount, 1);
    end_pool(pool, loaders);
}

static void sources_are_not_told_of_a_cancel_while_others_wait(void **state)
{
    (void)state;
    struct source source;
    SluiceTileLoader *loaders[2];
    uint64_t tickets[2];
    float texels[3] = {0};
    SluiceReadPool *pool = begin_pool(&source, loaders);
    source.obeys = true;
    join(&source, loaders, texels, tickets);
    CHECK_OK(sluiceCancelTileRead(loaders[0], tickets[0]));
    assert_int_equal(source.cancel_count, 0);
    complete_level(&source, 1);
    assert_int_equal(collect(loaders[1]).ticket, tickets[1]);
    assert_true(texels[1] == 1000);
    complete_level(&source, 2);
    CHECK_OK(collect(loaders[1]).result);
    assert_int_equal(count_starts(&source), 2);
    end_pool(pool, loaders);
}

/* Otherwise the loader would wait for the source, or forever if the source waits for a cancel. The
 * joined read starts itself, also if the read was canceled before. */
static void a_loader_that_ends_tells_its_sources_at_once(void **state)
{
    (void)state;
    for (int canceled = 0; canceled < 2; canceled++) {
        struct source source;
        SluiceTileLoader *loaders[2];
        uint64_t tickets[2];
        float texels[3] = {0};
        SluiceReadPool *pool = begin_pool(&source, loaders);
        source.obeys = true;
        join(&source, loaders, texels, tickets);
        if (canceled)
            CHECK_OK(sluiceCancelTileRead(loaders[0], tickets[0]));
        assert_int_equal(source.cancel_count, 0);
        sluiceDestroyTileLoader(loaders[0]);
        loaders[0] = NULL;
        assert_int_equal(source.cancel_count, 1);
        await_pending(&source, 2); /* levels 2 and 1 */
        complete_level(&source, 1);
        assert_int_equal(collect(loaders[1]).ticket, tickets[1]);
        assert_true(texels[1] == 1000);
        complete_level(&source, 2);
        end_pool(pool, loaders);
    }
}

/* The reader of level 1 is canceled before or after the read that waits for it, or both loaders are
 * destroyed. The source completes reads only on request. */
static void sources_are_told_of_a_cancel_when_nobody_waits_any_more(void **state)
{
    (void)state;
    enum { FIRST, LAST, DESTROYED, CASES };
    for (int reader = 0; reader < CASES; reader++) {
        struct source source;
        SluiceTileLoader *loaders[2];
        uint64_t tickets[2];
        float texels[3] = {0};
        SluiceReadPool *pool = begin_pool(&source, loaders);
        source.obeys = true;
        join(&source, loaders, texels, tickets);
        CHECK_OK(sluiceCancelTileRead(loaders[reader == LAST], tickets[reader == LAST]));
        assert_int_equal(source.cancel_count, 0);
        if (reader == DESTROYED) {
            sluiceDestroyTileLoader(loaders[1]);
            loaders[1] = NULL;
        } else {
            CHECK_OK(sluiceCancelTileRead(loaders[reader != LAST], tickets[reader != LAST]));
            assert_int_equal(source.cancel_count, 1);
            CHECK_RESULT(collect(loaders[1]).result, SLUICE_ERROR_CANCELED);
        }
        CHECK_RESULT(collect(loaders[0]).result, SLUICE_ERROR_CANCELED);
        end_pool(pool, loaders);
        assert_int_equal(source.cancel_count, 2); /* once each */
        assert_int_equal(source.count, 0);
    }
}

/* Two levels are read and one is still wanted: the source gets a cancel for the other, and later
 * for both. */
static void each_region_is_canceled_once(void **state)
{
    (void)state;
    struct source source;
    SluiceTileLoader *loaders[2];
    float texels[4] = {0};
    SluiceReadPool *pool = begin_pool(&source, loaders);
    uint64_t both = submit(loaders[0], &source.base, 2, 1, &texels[0]);
    await_pending(&source, 2);
    uint64_t second = submit(loaders[1], &source.base, 1, 2, &texels[2]);
    submit(loaders[1], &source.base, 1, 3, &texels[3]);
    await_pending(&source, 3);
    source.obeys = true;
    for (int again = 0; again < 2; again++) {
        CHECK_OK(sluiceCancelTileRead(loaders[0], both));
        assert_int_equal(source.cancel_count, 1);
    }
    assert_int_equal(count_finished(loaders[0]), 0);
    CHECK_OK(sluiceCancelTileRead(loaders[1], second));
    assert_int_equal(source.cancel_count, 2);
    CHECK_RESULT(collect(loaders[0]).result, SLUICE_ERROR_CANCELED);
    CHECK_RESULT(collect(loaders[1]).result, SLUICE_ERROR_CANCELED);
    end_pool(pool, loaders);
    assert_int_equal(source.cancel_count, 3);
}

/* The source has not completed the canceled read. No other read may join it. */
static void reads_that_were_canceled_are_not_joined(void **state)
{
    (void)state;
    struct source source;
    SluiceTileLoader *loaders[2];
    float texels[2] = {0};
    SluiceReadPool *pool = begin_pool(&source, loaders);
    uint64_t ticket = submit(loaders[0], &source.base, 1, 1, &texels[0]);
    await_pending(&source, 1);
    for (uint32_t told = 0; told < 1; pause_briefly()) { /* once its start has returned */
        CHECK_OK(sluiceCancelTileRead(loaders[0], ticket));
        pthread_mutex_lock(&source.mutex);
        told = source.cancel_count;
        pthread_mutex_unlock(&source.mutex);
    }
    submit(loaders[1], &source.base, 1, 1, &texels[1]);
    await_pending(&source, 2);
    complete_level(&source, 1);
    complete_level(&source, 1);
    CHECK_OK(collect(loaders[1]).result);
    assert_true(texels[1] == 1000);
    end_pool(pool, loaders);
}

/* Both loaders try three times. One starts the second attempt, and the other joins it. */
static void a_started_failure_that_was_joined_is_an_attempt_of_each_reader(void **state)
{
    (void)state;
    struct source source;
    SluiceTileLoader *loaders[2];
    uint64_t tickets[2];
    float texels[3] = {0};
    SluiceReadPool *pool = begin_pool(&source, loaders);
    source.failures = SLUICE_ERROR_IO;
    source.failure_count = 1;
    join(&source, loaders, texels, tickets);
    complete_level(&source, 1);
    await_pending(&source, 2);                  /* levels 2 and 1 */
    source.failures = SLUICE_ERROR_UNSUPPORTED; /* final */
    source.failure_count = 1;
    for (uint64_t retried = 0; retried < 2; pause_briefly()) { /* the one thread starts nothing */
        retried = 0;
        for (int i = 0; i < 2; i++) {
            SluiceTileLoaderStatistics own = {.structSize = sizeof own};
            CHECK_OK(sluiceGetTileLoaderStatistics(loaders[i], &source.base, &own));
            retried += own.retriedCount - own.delayedCount;
        }
    }
    submit(loaders[0], &source.base, 1, 3, &texels[2]);
    submit(loaders[1], &source.base, 1, 4, &texels[2]);
    await_pending(&source, 4);
    complete_level(&source, 1);
    for (int i = 0; i < 2; i++) {
        SluiceTileReadResult result = collect(loaders[i]);
        CHECK_RESULT(result.result, SLUICE_ERROR_UNSUPPORTED);
        assert_int_equal(result.ticket, tickets[i]);
    }
    assert_int_equal(count_starts(&source), 5);
    for (uint32_t level = 2; level < LEVELS; level++)
        complete_level(&source, level);
    end_pool(pool, loaders);
}

static void regions_that_are_read_at_once_are_shared_too(void **state)
{
    (void)state;
    for (int at_once = 0; at_once < 2; at_once++) {
        struct source source;
        SluiceTileLoader *loaders[2];
        SluiceReadPool *pool = begin_pool(&source, loaders);
        source.at_once = at_once;
        source.refusal = at_once ? SLUICE_SUCCESS : SLUICE_ERROR_UNSUPPORTED;
        for (int i = 0; i < 2; i++) {
            float texels[3] = {0};
            submit(loaders[i], &source.base, 3, 1, texels);
            CHECK_OK(collect(loaders[i]).result);
            assert_true(texels[0] == 1000 && texels[1] == 2000 && texels[2] == 3000);
        }
        assert_int_equal(source.read_count + source.start_count, 3);
        end_pool(pool, loaders);
    }
}

/* Like completions_cancels_and_destruction_may_meet, with two loaders of a pool that request the
 * same regions. Every successful read must have its texels. */
static void joins_completions_and_cancels_may_meet(void **state)
{
    (void)state;
    enum { COUNT = 200 };
    static float texels[2][COUNT][2];
    for (int round = 0; round < 3; round++) {
        struct source source;
        SluiceTileLoader *loaders[2];
        pthread_t threads[2];
        SluiceReadPool *pool = begin_pool(&source, loaders);
        source.obeys = true;
        source.failures = SLUICE_ERROR_IO;
        source.failure_count = 40;
        for (int i = 0; i < 2; i++)
            assert_int_equal(pthread_create(&threads[i], NULL, complete_all, &source), 0);
        for (uint32_t i = 0; i < COUNT; i++)
            for (uint32_t k = 0; k < 2; k++) {
                uint32_t level = i * (k + 1) % (LEVELS - 1);
                texels[k][i][0] = texels[k][i][1] = -1;
                uint64_t ticket = submit(loaders[k], &source.base, 2, level, texels[k][i]);
                if (i % 3 == k)
                    CHECK_OK(sluiceCancelTileRead(loaders[k], ticket));
                if (i % 32 == 31)
                    sluiceDropTileLoaderStatistics(loaders[k], &source.base);
            }
        for (uint32_t k = 0; round > 0 && k < 2; k++)
            for (uint32_t i = 0; i < COUNT; i++) {
                SluiceTileReadResult result = collect(loaders[k]);
                if (result.result == SLUICE_SUCCESS)
                    assert_int_equal(result.size, 2 * sizeof(float));
                else
                    assert_true(result.result == SLUICE_ERROR_CANCELED ||
                                result.result == SLUICE_ERROR_IO);
            }
        for (uint32_t k = 0; round > 0 && k < 2; k++)
            for (uint32_t i = 0; i < COUNT; i++)
                for (uint32_t r = 0; r < 2; r++)
                    assert_true(texels[k][i][r] == -1 ||
                                texels[k][i][r] ==
                                    (float)(1000 * (i * (k + 1) % (LEVELS - 1) + r)));
        end_pool(pool, loaders);
        for (int i = 0; i < 2; i++)
            finish(&source, threads[i]);
        assert_int_equal(source.count, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(started_reads_occupy_no_thread_and_are_not_polled),
        cmocka_unit_test(a_read_may_be_completed_before_its_start_returns),
        cmocka_unit_test(regions_are_started_together_and_the_last_one_ends_the_read),
        cmocka_unit_test(regions_that_failed_are_started_again_alone),
        cmocka_unit_test(canceled_reads_end_when_their_source_completes_them),
        cmocka_unit_test(completions_cancels_and_destruction_may_meet),
        cmocka_unit_test(sources_may_have_a_region_read_at_once),
        cmocka_unit_test(layers_of_arrays_start_their_own_reads),
        cmocka_unit_test(completed_chains_start_the_levels_that_they_do_not_build),
        cmocka_unit_test(bytes_of_started_reads_are_in_flight),
        cmocka_unit_test(started_reads_are_joined),
        cmocka_unit_test(sources_are_not_told_of_a_cancel_while_others_wait),
        cmocka_unit_test(sources_are_told_of_a_cancel_when_nobody_waits_any_more),
        cmocka_unit_test(each_region_is_canceled_once),
        cmocka_unit_test(a_loader_that_ends_tells_its_sources_at_once),
        cmocka_unit_test(reads_that_were_canceled_are_not_joined),
        cmocka_unit_test(a_started_failure_that_was_joined_is_an_attempt_of_each_reader),
        cmocka_unit_test(regions_that_are_read_at_once_are_shared_too),
        cmocka_unit_test(joins_completions_and_cancels_may_meet),
    };
    return RUN_TESTS(tests);
}
