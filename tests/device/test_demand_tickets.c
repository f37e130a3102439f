/* Tickets from any thread: they end, whatever the reads do. */
#include "device/demand_runner.h"

#include "support/job_system.h"
#include "support/test.h"

#include <sluice/demand_query.h>

#include <pthread.h>
#include <string.h>

static struct harness h;

/* An opened texture whose reads are held, with eight requested tiles. */
struct held {
    struct runner r;
    struct runner_image image;
    SluiceDemandTextureId id;
};

static void setup(struct held *held)
{
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info};
    runner_init(&held->r, &h, &info);
    runner_image_init(&held->image, SLUICE_FORMAT_R8G8B8A8_UNORM, 1024, 1024, 1);
    held->id = runner_add_texture(&held->r, &held->image);
    for (uint32_t i = 0; i < 8; i++)
        runner_add_texel(&held->r, held->id, 1024, 1024, 0, i * 128, 9);
    runner_launch(&held->r);
    CHECK_OK(sluiceWaitDemandTicket(held->r.loader, held->r.ticket, UINT64_MAX, NULL));
    held->image.source.holds = true;
    runner_launch(&held->r);
    assert_int_equal(held->r.requests.servedCount, 8);
    fault_source_await(&held->image.source, 2);
}

static void teardown(struct held *held)
{
    fault_source_release(&held->image.source);
    runner_finish(&held->r);
    runner_image_finish(&held->image);
}

static void check_status(const struct held *held, SluiceDemandTicket ticket, uint32_t tasks,
                         uint32_t remaining, uint32_t failed)
{
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    CHECK_OK(sluiceGetDemandTicketStatus(held->r.loader, ticket, &status));
    assert_int_equal(status.taskCount, tasks);
    assert_int_equal(status.remainingCount, remaining);
    assert_int_equal(status.failedCount, failed);
}

static void a_canceled_ticket_ends_with_what_is_under_way(void **state)
{
    (void)state;
    struct held held;
    setup(&held);
    SluiceDemandTicket ticket = held.r.ticket;
    check_status(&held, ticket, 8, 8, 0);
    CHECK_OK(sluiceCancelDemandTicket(held.r.loader, ticket));
    check_status(&held, ticket, 8, 2, 6);
    CHECK_RESULT(sluiceWaitDemandTicket(held.r.loader, ticket, 0, NULL), SLUICE_NOT_READY);
    fault_source_release(&held.image.source);
    CHECK_OK(sluiceWaitDemandTicket(held.r.loader, ticket, UINT64_MAX, NULL));
    check_status(&held, ticket, 8, 0, 6);
    /* Shaders ask again. */
    assert_in_range(runner_load(&held.r, 9), 2, 3);
    assert_true(runner_all_resident(&held.r));
    assert_int_equal(held.image.source.read_count, 1 + 8);
    assert_int_equal(runner_statistics(&held.r).canceledCount, 6);
    teardown(&held);
}

static void a_wait_ends_when_its_time_is_over(void **state)
{
    (void)state;
    struct held held;
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    setup(&held);
    CHECK_RESULT(sluiceWaitDemandTicket(held.r.loader, held.r.ticket, 1000000, &status),
                 SLUICE_NOT_READY);
    assert_int_equal(status.remainingCount, 8);
    SluiceDemandLaunch launch = held.r.launch;
    CHECK_OK(runner_submit(&held.r)); /* launches go on meanwhile */
    CHECK_OK(sluiceProcessDemandRequests(held.r.loader, &held.r.launch, UINT64_MAX,
                                         &held.r.requests, &held.r.ticket));
    assert_int_equal(held.r.launch.launchIndex, launch.launchIndex + 1);
    assert_int_equal(held.r.requests.pendingCount, 8);
    assert_int_equal(held.r.ticket, 0);
    CHECK_OK(sluiceWaitDemandTicket(held.r.loader, 0, UINT64_MAX, &status));
    assert_int_equal(status.taskCount, 0);
    teardown(&held);
}

static void tickets_that_were_never_given_are_refused(void **state)
{
    (void)state;
    struct held held;
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    setup(&held);
    const SluiceDemandTicket wrong[] = {1, held.r.ticket + 7, held.r.ticket + (1ull << 32),
                                        UINT64_MAX};
    for (uint32_t i = 0; i < 4; i++) {
        CHECK_RESULT(sluiceGetDemandTicketStatus(held.r.loader, wrong[i], &status),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        CHECK_RESULT(sluiceWaitDemandTicket(held.r.loader, wrong[i], 0, NULL),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        CHECK_RESULT(sluiceCancelDemandTicket(held.r.loader, wrong[i]),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    }
    teardown(&held);
}

struct waiter {
    SluiceDemandLoader *loader;
    SluiceDemandTicket ticket;
    SluiceResult result;
    pthread_t thread;
};

static void *wait_for_ever(void *user)
{
    struct waiter *waiter = user;
    waiter->result = sluiceWaitDemandTicket(waiter->loader, waiter->ticket, UINT64_MAX, NULL);
    return NULL;
}

static void *cancel(void *user)
{
    struct waiter *waiter = user;
    waiter->result = sluiceCancelDemandTicket(waiter->loader, waiter->ticket);
    return NULL;
}

static void *end_all(void *user)
{
    struct waiter *waiter = user;
    waiter->result = sluiceAbortDemandLoader(waiter->loader);
    return NULL;
}

static void begin(struct waiter *waiter, const struct held *held, void *(*what)(void *user))
{
    *waiter = (struct waiter){.loader = held->r.loader, .ticket = held->r.ticket};
    assert_int_equal(pthread_create(&waiter->thread, NULL, what, waiter), 0);
}

static void another_thread_may_cancel_what_this_one_waits_for(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 20; i++) {
        struct held held;
        struct waiter waiters[3], canceller;
        setup(&held);
        for (uint32_t w = 0; w < 3; w++)
            begin(&waiters[w], &held, wait_for_ever);
        begin(&canceller, &held, cancel);
        fault_source_release(&held.image.source);
        CHECK_OK(sluiceWaitDemandTicket(held.r.loader, held.r.ticket, UINT64_MAX, NULL));
        for (uint32_t w = 0; w < 3; w++) {
            assert_int_equal(pthread_join(waiters[w].thread, NULL), 0);
            CHECK_OK(waiters[w].result);
        }
        assert_int_equal(pthread_join(canceller.thread, NULL), 0);
        CHECK_OK(canceller.result);
        teardown(&held);
    }
}

static void an_abort_wakes_all_though_reads_are_stuck(void **state)
{
    (void)state;
    struct held held;
    struct waiter waiters[3], end;
    setup(&held);
    for (uint32_t w = 0; w < 3; w++)
        begin(&waiters[w], &held, wait_for_ever);
    begin(&end, &held, end_all);
    CHECK_RESULT(sluiceWaitDemandTicket(held.r.loader, held.r.ticket, UINT64_MAX, NULL),
                 SLUICE_ERROR_CANCELED);
    for (uint32_t w = 0; w < 3; w++) {
        assert_int_equal(pthread_join(waiters[w].thread, NULL), 0);
        CHECK_RESULT(waiters[w].result, SLUICE_ERROR_CANCELED);
    }
    assert_int_equal(pthread_join(end.thread, NULL), 0);
    CHECK_OK(end.result);
    CHECK_RESULT(runner_submit(&held.r), SLUICE_ERROR_CANCELED);
    CHECK_RESULT(
        sluiceProcessDemandRequests(held.r.loader, &held.r.launch, 0, &held.r.requests, NULL),
        SLUICE_ERROR_INVALID_ARGUMENT); /* this one was */
    teardown(&held);
    assert_int_equal(held.image.source.read_count, 1 + 2);
    assert_int_equal(held.image.closed, 1);
}

static void many_tickets_end_and_the_last_ones_are_remembered(void **state)
{
    (void)state;
    enum { COUNT = 3000, KEPT = 1000 };
    struct runner r;
    struct runner_image image;
    static SluiceDemandTicket tickets[COUNT];
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .maxTextureCount = COUNT};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 4, 4, 1);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK_OK(
            sluicePreloadDemandTexture(r.loader, runner_add_texture(&r, &image), 0, &tickets[i]));
    for (bool over = false; !over;) {
        runner_launch(&r);
        over = true;
        for (uint32_t i = 0; i < COUNT; i++) {
            CHECK_OK(sluiceWaitDemandTicket(r.loader, tickets[i], UINT64_MAX, &status));
            over = over && status.remainingCount == 0;
        }
    }
    for (uint32_t i = 0; i < COUNT; i++) {
        CHECK_OK(sluiceGetDemandTicketStatus(r.loader, tickets[i], &status));
        assert_int_equal(status.remainingCount + status.failedCount, 0);
        /* The opening, and a tile where there was memory left. */
        assert_true(status.taskCount == 1 || status.taskCount == 2 ||
                    (i < COUNT - KEPT && status.taskCount == 0));
    }
    assert_int_equal(image.opened, COUNT);
    runner_finish(&r);
    assert_int_equal(image.closed, COUNT);
    runner_image_finish(&image);
}

/* Launches and waits until the region is there. Returns the last status. */
static SluiceDemandWaitStatus wait_for_region(struct runner *r, SluiceDemandTextureId id,
                                              const SluiceImageRegion *region)
{
    SluiceDemandWaitStatus status = SLUICE_DEMAND_WAIT_LAUNCH;
    for (uint32_t i = 0; i < 200 && status == SLUICE_DEMAND_WAIT_LAUNCH; i++) {
        CHECK_OK(sluiceWaitDemandRegion(r->loader, id, region, UINT64_MAX, &status));
        if (status == SLUICE_DEMAND_WAIT_LAUNCH)
            runner_launch(r);
    }
    return status;
}

/* Texel by texel: whether the region covers a texel of the tile, a level after the other. */
static bool is_covered(const SluiceImageRegion *region, uint32_t level, uint32_t x, uint32_t y)
{
    for (uint32_t v = region->y; v < region->y + region->height; v++)
        for (uint32_t u = region->x; u < region->x + region->width; u++)
            if (u >> (level - region->mipLevel) >> 7 == x &&
                v >> (level - region->mipLevel) >> 7 == y)
                return true;
    return false;
}

static void a_preloaded_region_is_ready_and_no_other_tile_is_read(void **state)
{
    (void)state;
    static const SluiceImageRegion regions[] = {
        {.mipLevel = 0, .x = 300, .y = 511, .width = 90, .height = 2},
        {.mipLevel = 1, .x = 1023, .y = 0, .width = 1, .height = 1},
        {.mipLevel = 0, .x = 0, .y = 127, .width = 2048, .height = 1},
        {.mipLevel = 9, .width = 1, .height = 1}};
    for (uint32_t i = 0; i < sizeof regions / sizeof regions[0]; i++) {
        struct runner r;
        struct runner_image image;
        SluiceDemandRegionProgress progress = {.structSize = sizeof progress};
        const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                                   .maxTilesInFlight = 3};
        runner_init(&r, &h, &info);
        runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 2048, 2048, i);
        SluiceDemandTextureId id = runner_add_texture(&r, &image);
        CHECK_OK(sluicePreloadDemandRegion(r.loader, id, &regions[i], NULL));
        assert_int_equal(wait_for_region(&r, id, &regions[i]), SLUICE_DEMAND_WAIT_READY);
        uint32_t count = 1; /* the tail */
        for (uint32_t level = 0; level < 5; level++)
            for (uint32_t t = 0; t < 256u >> 2 * level; t++) {
                uint32_t x = t % (16u >> level), y = t / (16u >> level);
                SluiceDemandTileInfo tile = {.structSize = sizeof tile};
                CHECK_OK(sluiceGetDemandTileInfo(r.loader, id, level, x * 128, y * 128, &tile));
                bool covered = level >= regions[i].mipLevel && is_covered(&regions[i], level, x, y);
                assert_int_equal(tile.state,
                                 covered ? SLUICE_DEMAND_PAGE_RESIDENT : SLUICE_DEMAND_PAGE_ABSENT);
                count += covered;
            }
        CHECK_OK(sluiceGetDemandRegionProgress(r.loader, id, &regions[i], &progress));
        assert_true(progress.isOpen && progress.ready && !progress.failed);
        assert_int_equal(progress.tileCount, count);
        assert_int_equal(progress.residentTileCount, count);
        assert_int_equal(progress.pendingTileCount + progress.refusedTileCount, 0);
        runner_finish(&r);
        runner_image_finish(&image);
    }
}

static const SluiceImageRegion coarse = {.mipLevel = 2, .width = 256, .height = 256};

static SluiceDemandWaitStatus wait_once(const struct held *held, uint64_t timeout)
{
    SluiceDemandWaitStatus status;
    CHECK_OK(sluiceWaitDemandRegion(held->r.loader, held->id, &coarse, timeout, &status));
    return status;
}

static void check_progress(const struct held *held, uint32_t resident, uint32_t refused)
{
    SluiceDemandRegionProgress progress = {.structSize = sizeof progress};
    CHECK_OK(sluiceGetDemandRegionProgress(held->r.loader, held->id, NULL, &progress));
    assert_true(progress.isOpen && !progress.failed);
    assert_int_equal(progress.tileCount, 64 + 16 + 4 + 1 + 1);
    assert_int_equal(progress.residentTileCount, resident);
    assert_int_equal(progress.refusedTileCount, refused);
    assert_int_equal(progress.pendingTileCount, 0);
    assert_int_equal(progress.ready, resident == progress.tileCount);
}

static void waits_say_who_has_the_next_step(void **state)
{
    (void)state;
    struct held held;
    SluiceDemandRegionProgress progress = {.structSize = sizeof progress};
    SluiceDemandWaitStatus status;
    const SluiceImageRegion all = {.width = 1024, .height = 1024};
    runner_init(&held.r, &h, NULL);
    runner_image_init(&held.image, SLUICE_FORMAT_R8G8B8A8_UNORM, 1024, 1024, 1);
    held.id = runner_add_texture(&held.r, &held.image);
    CHECK_OK(sluiceGetDemandRegionProgress(held.r.loader, held.id, NULL, &progress));
    assert_true(!progress.isOpen && !progress.ready && progress.tileCount == 0);
    assert_int_equal(wait_once(&held, UINT64_MAX), SLUICE_DEMAND_WAIT_NOT_REQUESTED);
    CHECK_OK(runner_submit(&held.r)); /* it might request something */
    assert_int_equal(wait_once(&held, UINT64_MAX), SLUICE_DEMAND_WAIT_LAUNCH);
    CHECK_OK(sluiceProcessDemandRequests(held.r.loader, &held.r.launch, UINT64_MAX,
                                         &held.r.requests, &held.r.ticket));
    held.image.source.holds = true;
    CHECK_OK(sluicePreloadDemandRegion(held.r.loader, held.id, &coarse, NULL));
    fault_source_await(&held.image.source, 1); /* it is being opened */
    assert_int_equal(wait_once(&held, 0), SLUICE_DEMAND_WAIT_TIMEOUT);
    assert_int_equal(wait_once(&held, 2000000), SLUICE_DEMAND_WAIT_TIMEOUT);
    fault_source_release(&held.image.source);
    assert_int_equal(wait_once(&held, UINT64_MAX), SLUICE_DEMAND_WAIT_LAUNCH);
    assert_int_equal(wait_for_region(&held.r, held.id, &coarse), SLUICE_DEMAND_WAIT_READY);
    check_progress(&held, 4 + 1 + 1, 0);
    held.image.source.fail_at = 1;
    held.image.source.fails_on = true;
    held.image.source.failure = SLUICE_ERROR_UNSUPPORTED;
    h.quiet = true;
    CHECK_OK(sluicePreloadDemandRegion(held.r.loader, held.id, &all, NULL));
    assert_int_equal(wait_for_region(&held.r, held.id, NULL), SLUICE_DEMAND_WAIT_FAILED);
    check_progress(&held, 4 + 1 + 1, 64 + 16);
    held.image.source.fail_at = 0;
    CHECK_OK(sluiceRetryDemandTexture(held.r.loader, held.id));
    CHECK_OK(sluicePreloadDemandRegion(held.r.loader, held.id, &all, NULL));
    assert_int_equal(wait_for_region(&held.r, held.id, NULL), SLUICE_DEMAND_WAIT_READY);
    check_progress(&held, 64 + 16 + 4 + 1 + 1, 0);
    const SluiceImageRegion beyond = {.mipLevel = 1, .x = 500, .width = 13, .height = 1};
    CHECK_RESULT(sluiceGetDemandRegionProgress(held.r.loader, held.id, &beyond, &progress),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluicePreloadDemandRegion(held.r.loader, held.id, &beyond, NULL),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceAbortDemandLoader(held.r.loader));
    CHECK_RESULT(sluiceWaitDemandRegion(held.r.loader, held.id, NULL, 0, &status),
                 SLUICE_ERROR_CANCELED);
    h.quiet = false;
    teardown(&held);
}

/* The rectangle is looked at when its texture has been opened. */
static void a_region_beyond_its_level_loads_nothing(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    const SluiceImageRegion beyond = {.width = 301, .height = 1};
    SluiceDemandTicketStatus status = {.structSize = sizeof status, .taskCount = 9};
    SluiceDemandTicket ticket;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    h.quiet = true;
    CHECK_OK(sluicePreloadDemandRegion(r.loader, id, &beyond, &ticket));
    assert_int_equal(wait_for_region(&r, id, NULL), SLUICE_DEMAND_WAIT_NOT_REQUESTED);
    assert_memory_equal(h.last_message, "sluicePreloadDemandRegion: level 0, 301 x 1", 43);
    h.quiet = false;
    CHECK_OK(sluiceGetDemandTicketStatus(r.loader, ticket, &status));
    assert_int_equal(status.remainingCount, 0);
    assert_int_equal(image.source.read_count, 1); /* its base color */
    runner_finish(&r);
    runner_image_finish(&image);
}

/* Reads that are completed on another thread, later; nobody may read at once. */
struct later {
    SluiceImageSource base; ///< must be first
    SluiceImageSource *inner;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    struct {
        SluiceImageReadToken token;
        SluiceImageRegion region;
        void *texels;
        size_t pitch;
    } reads[64];
    uint32_t count, started, read_at_once, canceled;
    uint32_t failures; ///< so many are completed with NOT_READY first
    bool ends;
    pthread_t thread;
};

static SluiceResult get_later_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct later *)base)->inner, info);
}

static SluiceResult read_later_now(SluiceImageSource *base, const SluiceImageRegion *region,
                                   void *texels, size_t pitch)
{
    struct later *later = (struct later *)base;
    pthread_mutex_lock(&later->mutex);
    later->read_at_once++;
    pthread_mutex_unlock(&later->mutex);
    return sluiceReadImageRegion(later->inner, region, texels, pitch);
}

static SluiceResult start_later(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t pitch, const SluiceImageReadToken *token)
{
    struct later *later = (struct later *)base;
    pthread_mutex_lock(&later->mutex);
    assert_true(later->count < 64);
    later->reads[later->count].token = *token;
    later->reads[later->count].region = *region;
    later->reads[later->count].texels = texels;
    later->reads[later->count++].pitch = pitch;
    later->started++;
    pthread_cond_signal(&later->changed);
    pthread_mutex_unlock(&later->mutex);
    return SLUICE_SUCCESS;
}

static void *complete_later(void *user)
{
    struct later *later = user;
    pthread_mutex_lock(&later->mutex);
    while (later->count || !later->ends) {
        if (later->count == 0) {
            pthread_cond_wait(&later->changed, &later->mutex);
            continue;
        }
        uint32_t at = --later->count;
        const SluiceImageReadToken token = later->reads[at].token;
        SluiceResult result = later->failures ? SLUICE_NOT_READY : SLUICE_SUCCESS;
        later->failures -= later->failures > 0;
        if (result == SLUICE_SUCCESS)
            result = sluiceReadImageRegion(later->inner, &later->reads[at].region,
                                           later->reads[at].texels, later->reads[at].pitch);
        pthread_mutex_unlock(&later->mutex);
        sluiceCompleteImageRead(&token, result);
        pthread_mutex_lock(&later->mutex);
    }
    pthread_mutex_unlock(&later->mutex);
    return NULL;
}

/* Completes the read at once, before this returns. */
static void cancel_later(SluiceImageSource *base, const SluiceImageRegion *region,
                         const SluiceImageReadToken *token)
{
    struct later *later = (struct later *)base;
    bool is_known = false;
    pthread_mutex_lock(&later->mutex);
    for (uint32_t i = 0; i < later->count && !is_known; i++) {
        is_known = later->reads[i].token.ticket == token->ticket &&
                   memcmp(&later->reads[i].region, region, sizeof *region) == 0;
        if (is_known)
            later->reads[i] = later->reads[--later->count];
    }
    later->canceled += is_known;
    pthread_mutex_unlock(&later->mutex);
    if (is_known)
        CHECK_OK(sluiceCompleteImageRead(token, SLUICE_ERROR_CANCELED));
}

static void keep_later(SluiceImageSource *base)
{
    (void)base;
}

/* Openings, too: the color of the last level comes by a completion, as tiles and mip tails do. */
static void sources_that_start_reads_are_never_read_at_once(void **state)
{
    (void)state;
    static const SluiceImageSourceInterface interface = {.structSize = sizeof interface,
                                                         .pfnGetInfo = get_later_info,
                                                         .pfnReadRegion = read_later_now,
                                                         .pfnDestroy = keep_later,
                                                         .pfnStartRead = start_later};
    struct runner r;
    struct runner_image image;
    float rgba[4];
    for (uint32_t failures = 0; failures < 2; failures++) {
        struct later later = {.base = {&interface}, .failures = failures};
        runner_init(&r, &h, NULL);
        runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 512, 512, 3);
        later.inner = image.inner;
        pthread_mutex_init(&later.mutex, NULL);
        pthread_cond_init(&later.changed, NULL);
        assert_int_equal(pthread_create(&later.thread, NULL, complete_later, &later), 0);
        const SluiceDemandTextureCreateInfo info = {
            .structSize = sizeof info, .image.source = &later.base, .pSampler = &runner_nearest};
        SluiceDemandTextureId id;
        CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &id));
        runner_add_texel(&r, id, 512, 512, 9, 0, 0); /* the color that the opening read */
        runner_add_texel(&r, id, 512, 512, 0, 300, 200);
        assert_in_range(runner_load(&r, 9), 2, 8);
        runner_check_texel(&r, 0, &image, 9, 0, 0);
        runner_check_texel(&r, 1, &image, 0, 300, 200);
        runner_image_texel(&image, 9, 0, 0, rgba);
        assert_true(rgba[0] > 0);
        CHECK_OK(sluiceInvalidateDemandTexture(r.loader, id)); /* the color is read anew */
        runner_load(&r, 9);
        runner_check_texel(&r, 1, &image, 0, 300, 200);
        assert_int_equal(later.read_at_once, 0);
        assert_true(later.started >= 4 + failures);
        CHECK_OK(sluiceRemoveDemandTexture(r.loader, id));
        runner_finish(&r);
        pthread_mutex_lock(&later.mutex);
        later.ends = true;
        pthread_cond_signal(&later.changed);
        pthread_mutex_unlock(&later.mutex);
        pthread_join(later.thread, NULL);
        pthread_cond_destroy(&later.changed);
        pthread_mutex_destroy(&later.mutex);
        runner_image_finish(&image);
    }
}

struct cancel_call {
    SluiceDemandLoader *loader;
    SluiceDemandTicket ticket;
};

static void *cancel_ticket(void *user)
{
    struct cancel_call *call = user;
    CHECK_OK(sluiceCancelDemandTicket(call->loader, call->ticket));
    return NULL;
}

/* Nobody completes the reads of these sources, so only the cancel ends their openings: by removal
 * of one texture, by its ticket on another thread, and of the rest with the loader. */
static void openings_end_when_they_are_canceled(void **state)
{
    (void)state;
    enum { COUNT = 6 };
    static const SluiceImageSourceInterface interface = {.structSize = sizeof interface,
                                                         .pfnGetInfo = get_later_info,
                                                         .pfnReadRegion = read_later_now,
                                                         .pfnDestroy = keep_later,
                                                         .pfnStartRead = start_later,
                                                         .pfnCancelRead = cancel_later};
    struct runner r;
    struct runner_image image;
    struct later later[COUNT] = {0};
    SluiceDemandTextureId ids[COUNT];
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 512, 512, 3);
    for (uint32_t i = 0; i < COUNT; i++) {
        later[i].base.pInterface = &interface;
        later[i].inner = image.inner;
        pthread_mutex_init(&later[i].mutex, NULL);
        pthread_cond_init(&later[i].changed, NULL);
        const SluiceDemandTextureCreateInfo info = {
            .structSize = sizeof info, .image.source = &later[i].base, .pSampler = &runner_nearest};
        CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &ids[i]));
        runner_add_texel(&r, ids[i], 512, 512, 0, 1, 1);
    }
    runner_launch(&r);
    for (uint32_t i = 0; i < COUNT; i++) {
        pthread_mutex_lock(&later[i].mutex);
        while (later[i].started == 0)
            pthread_cond_wait(&later[i].changed, &later[i].mutex);
        pthread_mutex_unlock(&later[i].mutex);
    }
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, ids[2]));
    for (uint32_t i = 0; i < COUNT; i++)
        assert_int_equal(later[i].canceled, i == 2);
    struct cancel_call call = {r.loader, r.ticket};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, cancel_ticket, &call), 0);
    CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    pthread_join(thread, NULL);
    for (uint32_t i = 0; i < COUNT; i++)
        assert_int_equal(later[i].canceled, 1);
    runner_launch(&r); /* asks for them again, but for the removed one */
    for (uint32_t i = 0; i < COUNT; i++) {
        pthread_mutex_lock(&later[i].mutex);
        while (i != 2 && later[i].started == 1)
            pthread_cond_wait(&later[i].changed, &later[i].mutex);
        pthread_mutex_unlock(&later[i].mutex);
    }
    runner_finish(&r);
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_int_equal(later[i].canceled, i == 2 ? 1 : 2);
        assert_int_equal(later[i].read_at_once, 0);
        pthread_cond_destroy(&later[i].changed);
        pthread_mutex_destroy(&later[i].mutex);
    }
    runner_image_finish(&image);
}

/* Threads that wait read themselves. Jobs are compared with threads: requests and texels. */
static void waits_end_whatever_a_job_system_does(void **state)
{
    (void)state;
    static const struct job_system_habits systems[] = {
        {.thread_count = 2}, {.thread_count = 0}, {.thread_count = 1, .refuse_count = UINT32_MAX}};
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info};
    for (uint32_t i = 0; i < sizeof systems / sizeof systems[0]; i++) {
        struct job_system system;
        struct runner r;
        struct runner_image image;
        job_system_init(&system, systems[i]);
        CHECK_OK(harness_set_context(
            &h, &(SluiceVulkanContextCreateInfo){.pJobSystem = &system.callbacks}));
        runner_init(&r, &h, &info);
        runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 1024, 1024, 1);
        SluiceDemandTextureId id = runner_add_texture(&r, &image);
        for (uint32_t k = 0; k < 8; k++)
            runner_add_texel(&r, id, 1024, 1024, 0, k * 128, 9);
        assert_in_range(runner_load(&r, 9), 2, 4);
        assert_true(runner_all_resident(&r));
        assert_int_equal(image.source.read_count, 1 + 8); /* opened, and eight tiles */
        runner_finish(&r);
        runner_image_finish(&image);
        CHECK_OK(harness_set_context(&h, NULL));
        job_system_finish(&system);
        assert_true(system.submitted_count > 0 || system.refused_count > 0);
    }
    CHECK_OK(harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.loaderThreadCount = 3}));
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_canceled_ticket_ends_with_what_is_under_way),
        cmocka_unit_test(a_wait_ends_when_its_time_is_over),
        cmocka_unit_test(tickets_that_were_never_given_are_refused),
        cmocka_unit_test(another_thread_may_cancel_what_this_one_waits_for),
        cmocka_unit_test(an_abort_wakes_all_though_reads_are_stuck),
        cmocka_unit_test(many_tickets_end_and_the_last_ones_are_remembered),
        cmocka_unit_test(a_preloaded_region_is_ready_and_no_other_tile_is_read),
        cmocka_unit_test(waits_say_who_has_the_next_step),
        cmocka_unit_test(a_region_beyond_its_level_loads_nothing),
        cmocka_unit_test(sources_that_start_reads_are_never_read_at_once),
        cmocka_unit_test(openings_end_when_they_are_canceled),
        cmocka_unit_test(waits_end_whatever_a_job_system_does),
    };
    CHECK_OK(harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.loaderThreadCount = 3}));
    return harness_finish(&h, RUN_TESTS(tests));
}
