#define _POSIX_C_SOURCE 200809L

#include "open/background.h"

#include "base/alloc.h"
#include "platform/time_now.h"

#define A_WHILE 50000000 /* nanoseconds */

struct worker {
    struct slc_background *background;
    enum slc_stream_job_kind kind;
    struct slc_thread thread;
    bool has_started;
    struct slc_picture_stream *first, *last; ///< its queue
};

struct slc_background {
    SluiceAllocationCallbacks allocator;
    SluiceBaker *baker;
    struct slc_mutex mutex; ///< guards the fields below and the jobs of streams
    struct slc_condition changed;
    bool is_ending;
    struct worker workers[SLC_JOB_KIND_COUNT];
};

/* Appends a stream to the queue. The mutex is held. */
static void append(struct worker *worker, struct slc_picture_stream *stream)
{
    struct slc_stream_job *job = &stream->jobs[worker->kind];
    job->is_queued = true;
    job->next = NULL;
    if (worker->last)
        worker->last->jobs[worker->kind].next = stream;
    else
        worker->first = stream;
    worker->last = stream;
}

/* Takes the first stream from the queue. The mutex is held. */
static struct slc_picture_stream *take_first(struct worker *worker)
{
    struct slc_picture_stream *stream = worker->first;
    struct slc_stream_job *job = &stream->jobs[worker->kind];
    worker->first = job->next;
    if (!worker->first)
        worker->last = NULL;
    *job = (struct slc_stream_job){.is_running = true};
    return stream;
}

/* Waits A_WHILE, or until a stream is queued or canceled. The mutex is held. */
static void wait_a_while(struct slc_background *background)
{
    slc_condition_wait_until(&background->changed, &background->mutex,
                             slc_monotonic_time() + A_WHILE);
}

/* Tells whether a job can begin now; otherwise waits a while first. The mutex is held. */
static bool wait_for_job(struct worker *worker)
{
    struct slc_background *background = worker->background;
    struct slc_picture_stream *first = worker->first;
    if (!first) {
        slc_condition_wait(&background->changed, &background->mutex);
        return false;
    }
    if (!first->jobs[worker->kind].is_later)
        return true;
    wait_a_while(background);
    if (worker->first == first)
        first->jobs[worker->kind].is_later = false;
    return false;
}

/* Runs the job of a stream. False: try again later. */
static bool run(struct worker *worker, struct slc_picture_stream *stream)
{
    if (worker->kind == SLC_JOB_BAKE)
        return slc_make_store(worker->background, stream);
    slc_make_preview(worker->background, stream);
    slc_background_queue(worker->background, stream, SLC_JOB_BAKE);
    return true;
}

static void *work(void *argument)
{
    struct worker *worker = argument;
    struct slc_background *background = worker->background;
    slc_mutex_lock(&background->mutex);
    while (!background->is_ending) {
        if (!wait_for_job(worker))
            continue;
        struct slc_picture_stream *stream = take_first(worker);
        struct slc_stream_job *job = &stream->jobs[worker->kind];
        slc_mutex_unlock(&background->mutex);
        bool has_ended = run(worker, stream);
        slc_mutex_lock(&background->mutex);
        job->is_running = false;
        if (!has_ended && !atomic_load(&stream->is_canceled)) {
            append(worker, stream);
            job->is_later = true;
        } else {
            slc_condition_broadcast(&background->changed);
        }
    }
    slc_mutex_unlock(&background->mutex);
    return NULL;
}

SluiceResult slc_background_create(SluiceImageOpener *opener, struct slc_background **out)
{
    struct slc_background *background = slc_calloc(&opener->allocator, 1, sizeof *background);
    if (!background)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    background->allocator = opener->allocator;
    slc_mutex_init(&background->mutex);
    slc_condition_init(&background->changed);
    SluiceBakerCreateInfo info = {.structSize = sizeof info,
                                  .threadCount = opener->bake_thread_count,
                                  .maxMemory = opener->max_bake_memory,
                                  .pAllocator = &opener->allocator,
                                  .log = opener->log};
    SluiceResult result = sluiceCreateBaker(&info, &background->baker);
    for (int i = 0; i < SLC_JOB_KIND_COUNT && result == SLUICE_SUCCESS; i++) {
        struct worker *worker = &background->workers[i];
        worker->background = background;
        worker->kind = (enum slc_stream_job_kind)i;
        worker->has_started = slc_thread_start(&worker->thread, work, worker);
        result = worker->has_started ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    if (result != SLUICE_SUCCESS) {
        slc_background_destroy(background);
        return result;
    }
    *out = background;
    return SLUICE_SUCCESS;
}

void slc_background_destroy(struct slc_background *background)
{
    if (!background)
        return;
    SluiceAllocationCallbacks cb = background->allocator;
    slc_mutex_lock(&background->mutex);
    background->is_ending = true;
    slc_condition_broadcast(&background->changed);
    slc_mutex_unlock(&background->mutex);
    for (int i = 0; i < SLC_JOB_KIND_COUNT; i++)
        if (background->workers[i].has_started)
            slc_thread_join(&background->workers[i].thread);
    sluiceDestroyBaker(background->baker);
    slc_condition_finish(&background->changed);
    slc_mutex_finish(&background->mutex);
    slc_free(&cb, background, 1, sizeof *background);
}

SluiceBaker *slc_background_baker(struct slc_background *background)
{
    return background->baker;
}

void slc_background_queue(struct slc_background *background, struct slc_picture_stream *stream,
                          enum slc_stream_job_kind kind)
{
    slc_mutex_lock(&background->mutex);
    if (!stream->jobs[kind].is_queued && !atomic_load(&stream->is_canceled)) {
        append(&background->workers[kind], stream);
        slc_condition_broadcast(&background->changed);
    }
    slc_mutex_unlock(&background->mutex);
}

static void take_out(struct worker *worker, struct slc_picture_stream *stream)
{
    struct slc_picture_stream *before = NULL;
    for (struct slc_picture_stream *s = worker->first; s; s = s->jobs[worker->kind].next) {
        if (s == stream) {
            struct slc_picture_stream *next = s->jobs[worker->kind].next;
            *(before ? &before->jobs[worker->kind].next : &worker->first) = next;
            if (worker->last == s)
                worker->last = before;
            break;
        }
        before = s;
    }
    stream->jobs[worker->kind].is_queued = false;
}

void slc_background_cancel(struct slc_background *background, struct slc_picture_stream *stream)
{
    slc_mutex_lock(&background->mutex);
    atomic_store(&stream->is_canceled, true);
    slc_condition_broadcast(&background->changed);
    for (int kind = 0; kind < SLC_JOB_KIND_COUNT; kind++) {
        if (stream->jobs[kind].is_queued)
            take_out(&background->workers[kind], stream);
        while (stream->jobs[kind].is_running)
            slc_condition_wait(&background->changed, &background->mutex);
    }
    slc_mutex_unlock(&background->mutex);
}
