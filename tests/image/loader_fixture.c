#include "image/loader_fixture.h"

#include "support/test.h"

#include <sched.h>

static void mark(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                 uint32_t height, float rgba[4])
{
    (void)user;
    (void)height;
    rgba[0] = (float)(level * 100000 + y * width + x);
    rgba[1] = rgba[2] = rgba[3] = 0;
}

static void on_failure(void *user, const SluiceTileReadFailure *failure)
{
    struct loader_fixture *f = user;
    pthread_mutex_lock(&f->mutex);
    if (f->failure_count < MAX_FAILURES)
        f->failures[f->failure_count] = *failure;
    f->failure_count++;
    if (f->cancels)
        sluiceCancelTileRead(f->loader, f->ticket);
    pthread_mutex_unlock(&f->mutex);
}

void fixture_init(struct loader_fixture *f, SluiceTileLoaderCreateInfo create)
{
    SluiceProceduralImage image = {NULL, mark};
    SluiceImageInfo info = {sizeof info, FIXTURE_SIZE, FIXTURE_SIZE, 0, SLUICE_FORMAT_R32_SFLOAT,
                            "fault test"};
    *f = (struct loader_fixture){0};
    pthread_mutex_init(&f->mutex, NULL);
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &f->inner));
    fault_source_init(&f->source, f->inner);
    create.threadCount = create.threadCount ? create.threadCount : 1;
    create.retry.firstDelayNs = create.retry.firstDelayNs ? create.retry.firstDelayNs : 1;
    create.failure = (SluiceTileReadFailureCallback){f, on_failure};
    CHECK_OK(sluiceCreateTileLoader(&create, &f->loader));
}

void fixture_finish(struct loader_fixture *f)
{
    sluiceDestroyTileLoader(f->loader);
    fault_source_finish(&f->source);
    sluiceDestroyImageSource(f->inner);
    pthread_mutex_destroy(&f->mutex);
}

void fixture_replace_loader(struct loader_fixture *f, const SluiceTileLoaderCreateInfo *create)
{
    SluiceTileLoader *loader;
    CHECK_OK(sluiceCreateTileLoader(create, &loader));
    sluiceDestroyTileLoader(f->loader);
    pthread_mutex_lock(&f->mutex);
    f->loader = loader;
    pthread_mutex_unlock(&f->mutex);
}

uint64_t fixture_submit(struct loader_fixture *f, struct fault_source *source, uint32_t x,
                        float *texel, uint32_t priority)
{
    SluiceImageRegion region = {0, x, 0, 1, 1};
    void *texels = texel;
    uint64_t ticket = 0;
    SluiceTileRead read = {&source->base, 1, &region, &texels, priority, x};
    CHECK_OK(sluiceSubmitTileRead(f->loader, &read, &ticket));
    return ticket;
}

SluiceTileReadResult fixture_collect(struct loader_fixture *f)
{
    SluiceTileReadResult result;
    for (uint32_t count = 0; count == 0;) {
        count = 1;
        assert_true(sluiceCollectTileReads(f->loader, &count, &result) >= 0);
        if (count == 0)
            sched_yield();
    }
    return result;
}

SluiceTileLoaderStatistics fixture_statistics(struct loader_fixture *f,
                                              const struct fault_source *source)
{
    SluiceTileLoaderStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetTileLoaderStatistics(f->loader, source ? &source->base : NULL, &s));
    return s;
}
