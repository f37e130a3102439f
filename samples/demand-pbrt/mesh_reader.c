#include "mesh_reader.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define MOST_THREADS 8u

enum job_state { JOB_FREE, JOB_WAITS, JOB_RUNS, JOB_DONE };

struct job {
    enum job_state state;
    uint32_t shape;
    uint64_t number; ///< threads take the lowest number first
    struct mesh_read read;
};

struct mesh_reader {
    struct mesh_cache *cache;
    uint32_t device;
    pthread_mutex_t mutex; ///< guards all fields below
    pthread_cond_t asked, done;
    bool ends;
    uint64_t number;
    struct job jobs[MESH_READER_ROOM];
    uint32_t thread_count;
    pthread_t threads[MOST_THREADS];
};

static struct job *next_job(struct mesh_reader *r)
{
    struct job *next = NULL;
    for (uint32_t i = 0; i < MESH_READER_ROOM; i++)
        if (r->jobs[i].state == JOB_WAITS && (!next || r->jobs[i].number < next->number))
            next = &r->jobs[i];
    return next;
}

static void *work(void *user_data)
{
    struct mesh_reader *r = user_data;
    pthread_mutex_lock(&r->mutex);
    while (!r->ends) {
        struct job *job = next_job(r);
        if (!job) {
            pthread_cond_wait(&r->asked, &r->mutex);
            continue;
        }
        job->state = JOB_RUNS;
        pthread_mutex_unlock(&r->mutex);
        mesh_cache_read(r->cache, job->shape, &job->read);
        pthread_mutex_lock(&r->mutex);
        job->state = JOB_DONE;
        pthread_cond_broadcast(&r->done);
    }
    pthread_mutex_unlock(&r->mutex);
    return NULL;
}

static uint32_t choose_count(uint32_t count)
{
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    if (count == 0)
        count = processors > 2 ? (uint32_t)processors - 1 : 1;
    return count < MOST_THREADS ? count : MOST_THREADS;
}

struct mesh_reader *mesh_reader_create(struct mesh_cache *cache, uint32_t device,
                                       uint32_t thread_count)
{
    struct mesh_reader *r = calloc(1, sizeof *r);
    if (!r) {
        fprintf(stderr, "out of memory\n");
        return NULL;
    }
    r->cache = cache;
    r->device = device;
    pthread_mutex_init(&r->mutex, NULL);
    pthread_cond_init(&r->asked, NULL);
    pthread_cond_init(&r->done, NULL);
    /* Any number of threads suffices, even 0: mesh_reader_take reads meshes that no thread has
     * begun. */
    for (uint32_t i = 0; i < choose_count(thread_count); i++)
        if (pthread_create(&r->threads[r->thread_count], NULL, work, r) == 0)
            r->thread_count++;
    return r;
}

void mesh_reader_destroy(struct mesh_reader *r)
{
    if (!r)
        return;
    pthread_mutex_lock(&r->mutex);
    r->ends = true;
    pthread_cond_broadcast(&r->asked);
    pthread_mutex_unlock(&r->mutex);
    for (uint32_t i = 0; i < r->thread_count; i++)
        pthread_join(r->threads[i], NULL);
    for (uint32_t i = 0; i < MESH_READER_ROOM; i++)
        if (r->jobs[i].state == JOB_DONE)
            mesh_reader_give(r, &r->jobs[i].read);
    pthread_cond_destroy(&r->done);
    pthread_cond_destroy(&r->asked);
    pthread_mutex_destroy(&r->mutex);
    free(r);
}

static struct job *find(struct mesh_reader *r, uint32_t shape)
{
    for (uint32_t i = 0; i < MESH_READER_ROOM; i++)
        if (r->jobs[i].state != JOB_FREE && r->jobs[i].shape == shape)
            return &r->jobs[i];
    return NULL;
}

static struct job *find_free(struct mesh_reader *r)
{
    struct job *oldest = NULL;
    for (uint32_t i = 0; i < MESH_READER_ROOM; i++) {
        struct job *job = &r->jobs[i];
        if (job->state == JOB_FREE)
            return job;
        if (job->state == JOB_DONE && (!oldest || job->number < oldest->number))
            oldest = job;
    }
    if (oldest)
        mesh_reader_give(r, &oldest->read);
    return oldest;
}

bool mesh_reader_ask(struct mesh_reader *r, uint32_t shape)
{
    pthread_mutex_lock(&r->mutex);
    struct job *job = find(r, shape);
    if (!job && (job = find_free(r))) {
        *job = (struct job){.state = JOB_WAITS, .shape = shape, .number = r->number++};
        pthread_cond_signal(&r->asked);
    }
    pthread_mutex_unlock(&r->mutex);
    return job != NULL;
}

bool mesh_reader_is_ready(struct mesh_reader *r, uint32_t shape)
{
    pthread_mutex_lock(&r->mutex);
    const struct job *job = find(r, shape);
    const bool ready = job && (job->state == JOB_DONE || r->thread_count == 0);
    pthread_mutex_unlock(&r->mutex);
    return ready;
}

void mesh_reader_take(struct mesh_reader *r, uint32_t shape, struct mesh_read *read)
{
    pthread_mutex_lock(&r->mutex);
    struct job *job = find(r, shape);
    while (job && job->state == JOB_RUNS)
        pthread_cond_wait(&r->done, &r->mutex);
    const bool is_read = job && job->state == JOB_DONE;
    if (is_read)
        *read = job->read;
    if (job)
        job->state = JOB_FREE;
    pthread_mutex_unlock(&r->mutex);
    if (!is_read)
        mesh_cache_read(r->cache, shape, read);
}

void mesh_reader_give(struct mesh_reader *r, struct mesh_read *read)
{
    mesh_cache_give(r->cache, r->device, read);
}
