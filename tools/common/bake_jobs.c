#define _XOPEN_SOURCE 700

#include "bake_jobs.h"

#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "files.h"
#include "progress.h"
#include "text.h"

#define MAX_THREADS 256u

struct run {
    const struct bake_conditions *conditions;
    struct bake_job *jobs;
    size_t count;
    SluiceBaker *baker;
    atomic_size_t next;
    atomic_uint_least64_t done; ///< bytes of finished inputs, and the finished shares of others
    atomic_bool is_baking;      ///< true: some picture is not up to date
    pthread_mutex_t mutex;
    pthread_cond_t ended;
    size_t ended_count;
    pthread_mutex_t log_mutex; ///< guards the messages of jobs
};

/** Baking of one picture by a thread. */
struct task {
    struct run *run;
    struct bake_job *job;
    uint64_t counted; ///< bytes already added to `done`
};

static bool is_of_file(const char *message, const char *path, const char *ending)
{
    size_t size = strlen(path), ending_size = strlen(ending);
    return strncmp(message, path, size) == 0 && strncmp(message + size, ending, ending_size) == 0;
}

static bool is_of_layer(const struct bake_job *job, const char *message)
{
    for (uint32_t i = 0; i < job->layer_count; i++)
        if (is_of_file(message, job->layers[i], ":"))
            return true;
    return false;
}

/* Finds the job by the file's name at the start of a message. Messages come from any thread,
 * because every thread helps all pictures. */
static struct bake_job *job_of(const struct run *run, const char *message)
{
    for (size_t i = 0; i < run->count; i++) {
        const struct bake_job *job = &run->jobs[i];
        if (is_of_file(message, job->input, ":") || is_of_file(message, job->output, ":") ||
            is_of_layer(job, message) || is_of_file(message, job->output, ".sluice-part:"))
            return &run->jobs[i];
    }
    return NULL;
}

/* Adds a warning once. A picture may be opened twice and then warns twice. */
static void add_warning(struct bake_job *job, const char *message)
{
    size_t used = strlen(job->warnings), size = strlen(message) + 1;
    if (!strstr(job->warnings, message) && used + size < sizeof job->warnings)
        snprintf(job->warnings + used, sizeof job->warnings - used, "%s\n", message);
}

void bake_job_say_warnings(const struct bake_job *job, const char *speaker)
{
    const char *line = job->warnings;
    while (*line && job->result == SLUICE_SUCCESS) {
        int size = (int)strcspn(line, "\n");
        text_say("%s%.*s", speaker, size, line);
        line += size + 1;
    }
}

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct run *run = user;
    if (severity == SLUICE_LOG_INFO)
        return;
    struct bake_job *job = job_of(run, message);
    if (!job) {
        text_say("%s%s", run->conditions->speaker, message);
        return;
    }
    pthread_mutex_lock(&run->log_mutex);
    if (severity == SLUICE_LOG_ERROR && !job->message[0])
        snprintf(job->message, sizeof job->message, "%s", message);
    else if (severity == SLUICE_LOG_WARNING)
        add_warning(job, message);
    pthread_mutex_unlock(&run->log_mutex);
}

static bool on_progress(void *user, uint64_t done, uint64_t total)
{
    struct task *task = user;
    double share = total ? (double)done / (double)total : 0.0;
    uint64_t reached = (uint64_t)(share * (double)task->job->size);
    atomic_store(&task->run->is_baking, true);
    if (reached > task->counted) {
        atomic_fetch_add(&task->run->done, reached - task->counted);
        task->counted = reached;
    }
    return true;
}

static void bake(struct run *run, struct bake_job *job)
{
    struct task task = {run, job, 0};
    job->settings.structSize = sizeof job->settings;
    job->report.structSize = sizeof job->report;
    SluiceBakeInfo info = {.structSize = sizeof info,
                           .pInputPath = job->layers ? NULL : job->input,
                           .ppLayerPaths = job->layers,
                           .layerPathCount = job->layer_count,
                           .cube = job->cube,
                           .pOutputPath = job->output,
                           .pSettings = &job->settings,
                           .force = job->force,
                           .pUserData = &task,
                           .pfnProgress = on_progress};
    if (files_make_folders_of(job->output)) {
        job->result = sluiceBakeFile(run->baker, &info, &job->report);
    } else {
        job->result = SLUICE_ERROR_IO;
        snprintf(job->message, sizeof job->message, "%s: its folder cannot be made: %s",
                 job->output, strerror(errno));
    }
    job->is_done = true;
    atomic_fetch_add(&run->done, job->size > task.counted ? job->size - task.counted : 0);
}

static void *work(void *user)
{
    struct run *run = user;
    for (size_t i; (i = atomic_fetch_add(&run->next, 1)) < run->count;) {
        bake(run, &run->jobs[i]);
        pthread_mutex_lock(&run->mutex);
        run->ended_count++;
        pthread_cond_signal(&run->ended);
        pthread_mutex_unlock(&run->mutex);
    }
    return NULL;
}

static void wait_a_moment(struct run *run)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += 100000000;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_cond_timedwait(&run->ended, &run->mutex, &until);
}

/* Shows progress until all pictures are done. Pictures that are up to date before the bar appears
 * are left out. */
static void watch(struct run *run)
{
    struct progress progress;
    uint64_t total = 0, before = 0;
    bool is_shown = false, may_show = !run->conditions->quiet || isatty(STDERR_FILENO);
    for (size_t i = 0; i < run->count; i++)
        total += run->jobs[i].size;
    pthread_mutex_lock(&run->mutex);
    while (run->ended_count < run->count) {
        wait_a_moment(run);
        if (may_show && !is_shown && atomic_load(&run->is_baking)) {
            is_shown = true;
            before = atomic_load(&run->done);
            progress_begin(&progress, "baking", "B", total > before ? total - before : 0);
        }
        if (is_shown)
            progress_update(&progress, atomic_load(&run->done) - before);
    }
    pthread_mutex_unlock(&run->mutex);
    if (is_shown)
        progress_end(&progress);
}

static uint32_t count_threads(const struct run *run)
{
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    size_t count = run->conditions->threads ? run->conditions->threads
                   : online > 0             ? (size_t)online
                                            : 1;
    count = count < run->count ? count : run->count;
    return (uint32_t)(count < MAX_THREADS ? count : MAX_THREADS);
}

static bool start(struct run *run)
{
    pthread_t threads[MAX_THREADS];
    uint32_t wanted = count_threads(run), count = 0;
    while (count < wanted && pthread_create(&threads[count], NULL, work, run) == 0)
        count++;
    if (count > 0 || wanted == 0)
        watch(run);
    else
        text_say("%sno thread can be started", run->conditions->speaker);
    for (uint32_t i = 0; i < count; i++)
        pthread_join(threads[i], NULL);
    return count > 0 || wanted == 0;
}

bool bake_jobs_run(struct bake_job *jobs, size_t count, const struct bake_conditions *conditions)
{
    struct run run = {.conditions = conditions, .jobs = jobs, .count = count};
    SluiceBakerCreateInfo info = {.structSize = sizeof info,
                                  .threadCount = conditions->threads,
                                  .maxMemory = conditions->memory,
                                  .log = {&run, on_log}};
    SluiceResult result = sluiceCreateBaker(&info, &run.baker);
    if (result != SLUICE_SUCCESS) {
        text_say("%spictures cannot be baked: %s", conditions->speaker,
                 sluiceGetResultName(result));
        return false;
    }
    pthread_mutex_init(&run.log_mutex, NULL);
    pthread_mutex_init(&run.mutex, NULL);
    pthread_cond_init(&run.ended, NULL);
    bool done = start(&run);
    pthread_cond_destroy(&run.ended);
    pthread_mutex_destroy(&run.mutex);
    pthread_mutex_destroy(&run.log_mutex);
    sluiceDestroyBaker(run.baker);
    return done;
}
