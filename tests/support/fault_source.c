#define _POSIX_C_SOURCE 200809L

#include "support/fault_source.h"

#include <time.h>

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    struct fault_source *source = (struct fault_source *)base;
    if (atomic_fetch_add(&source->info_count, 1) < source->unopened)
        return source->failure;
    return sluiceGetImageInfo(source->inner, info);
}

static void wait_while_held(struct fault_source *source)
{
    pthread_mutex_lock(&source->mutex);
    source->waiting++;
    pthread_cond_broadcast(&source->changed);
    while (source->holds)
        pthread_cond_wait(&source->changed, &source->mutex);
    source->waiting--;
    pthread_mutex_unlock(&source->mutex);
}

/* Returns the test's answer to the read of this number. */
static SluiceResult answer_of(const struct fault_source *source, uint64_t number)
{
    if (number <= source->script_length)
        return source->script[number - 1];
    if (number <= source->postponed)
        return SLUICE_NOT_READY;
    bool fails = source->fail_at &&
                 (number == source->fail_at || (source->fails_on && number > source->fail_at));
    return fails ? source->failure : SLUICE_SUCCESS;
}

static void note_beginning(struct fault_source *source)
{
    unsigned now = atomic_fetch_add(&source->running, 1) + 1;
    unsigned most = atomic_load(&source->most_running);
    while (now > most && !atomic_compare_exchange_weak(&source->most_running, &most, now))
        continue;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct fault_source *source = (struct fault_source *)base;
    uint64_t number = atomic_fetch_add(&source->read_count, 1) + 1;
    note_beginning(source);
    wait_while_held(source);
    if (source->delay_us) {
        struct timespec delay = {0, (long)source->delay_us * 1000};
        nanosleep(&delay, NULL);
    }
    SluiceImageRegion half = *region;
    SluiceResult answer = answer_of(source, number);
    half.height /= 2;
    if (answer == SLUICE_SUCCESS)
        answer = sluiceReadImageRegion(source->inner, region, texels, row_pitch);
    else if (source->is_short && half.height > 0)
        sluiceReadImageRegion(source->inner, &half, texels, row_pitch);
    atomic_fetch_sub(&source->running, 1);
    return answer;
}

static void destroy(SluiceImageSource *base)
{
    (void)base; /* belongs to the test */
}

static const SluiceImageSourceInterface fault_interface = {sizeof fault_interface, get_info,
                                                           read_region, destroy};

void fault_source_init(struct fault_source *source, SluiceImageSource *inner)
{
    *source = (struct fault_source){.base.pInterface = &fault_interface, .inner = inner};
    pthread_mutex_init(&source->mutex, NULL);
    pthread_cond_init(&source->changed, NULL);
}

void fault_source_finish(struct fault_source *source)
{
    pthread_mutex_destroy(&source->mutex);
    pthread_cond_destroy(&source->changed);
}

void fault_source_await(struct fault_source *source, uint32_t count)
{
    pthread_mutex_lock(&source->mutex);
    while (source->waiting < count)
        pthread_cond_wait(&source->changed, &source->mutex);
    pthread_mutex_unlock(&source->mutex);
}

void fault_source_release(struct fault_source *source)
{
    pthread_mutex_lock(&source->mutex);
    source->holds = false;
    pthread_cond_broadcast(&source->changed);
    pthread_mutex_unlock(&source->mutex);
}
