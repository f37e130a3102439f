#define _XOPEN_SOURCE 700

#include "run.h"

#include "progress.h"
#include "text.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define MAX_THREADS 256u

struct run {
    const struct options *options;
    const struct files *files;
    struct outcome *outcomes;
    SluiceBaker *baker;
    atomic_size_t next;
    atomic_uint_least64_t done; /* bytes of inputs, shares of those under way included */
    pthread_mutex_t mutex;
    pthread_cond_t ended;
    size_t ended_count; /* files */
};

/* A file on its thread. */
struct task {
    struct run *run;
    const struct file *file;
    struct outcome *outcome;
    uint64_t size, counted; /* bytes of the input, and how many are in `done` */
};

static _Thread_local struct task *current;

static bool begins_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

/* Messages begin with a file's name. On a thread that waits they may be of another one that it
 * helps. */
static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    const struct task *task = current;
    bool is_own = task && (begins_with(message, task->file->input) ||
                           begins_with(message, task->file->output));
    if (severity == SLUICE_LOG_ERROR && is_own && !task->outcome->message[0])
        snprintf(task->outcome->message, sizeof task->outcome->message, "%s", message);
    else if (severity != SLUICE_LOG_INFO && !is_own)
        text_say("sluice-bake: %s", message);
}

static bool on_progress(void *user, uint64_t done, uint64_t total)
{
    struct task *task = user;
    uint64_t reached = total ? (uint64_t)((double)done / (double)total * (double)task->size) : 0;
    if (reached > task->counted) {
        atomic_fetch_add(&task->run->done, reached - task->counted);
        task->counted = reached;
    }
    return true;
}

static void bake_one(struct run *run, size_t index)
{
    const struct file *file = &run->files->files[index];
    struct outcome *outcome = &run->outcomes[index];
    struct task task = {run, file, outcome, file->size, 0};
    SluiceBakeInfo info = {.pInputPath = file->input,
                           .pOutputPath = file->output,
                           .settings = run->options->settings,
                           .force = run->options->force,
                           .pUserData = &task,
                           .pfnProgress = on_progress};
    current = &task;
    if (make_folders_of(file->output)) {
        outcome->result = sluiceBakeFile(run->baker, &info, &outcome->report);
    } else {
        outcome->result = SLUICE_ERROR_IO;
        snprintf(outcome->message, sizeof outcome->message, "%s: its folder cannot be made",
                 file->output);
    }
    current = NULL;
    outcome->is_done = true;
    atomic_fetch_add(&run->done, file->size - task.counted);
}

static void *work(void *user)
{
    struct run *run = user;
    for (size_t i; (i = atomic_fetch_add(&run->next, 1)) < run->files->count;) {
        bake_one(run, i);
        pthread_mutex_lock(&run->mutex);
        run->ended_count++;
        pthread_cond_signal(&run->ended);
        pthread_mutex_unlock(&run->mutex);
    }
    return NULL;
}

static uint64_t total_size(const struct files *files)
{
    uint64_t size = 0;
    for (size_t i = 0; i < files->count; i++)
        size += files->files[i].size;
    return size;
}

/* Until all files are done; shows how far it is on a terminal. */
static void watch(struct run *run)
{
    struct progress progress;
    progress_begin(&progress, "baking", "B", total_size(run->files));
    pthread_mutex_lock(&run->mutex);
    while (run->ended_count < run->files->count) {
        struct timespec until;
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += 100000000;
        until.tv_sec += until.tv_nsec / 1000000000;
        until.tv_nsec %= 1000000000;
        pthread_cond_timedwait(&run->ended, &run->mutex, &until);
        if (progress.terminal)
            progress_update(&progress, atomic_load(&run->done));
    }
    pthread_mutex_unlock(&run->mutex);
    if (progress.terminal)
        progress_end(&progress);
}

static uint32_t count_threads(const struct options *options, const struct files *files)
{
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    size_t count = options->threads ? options->threads : online > 0 ? (size_t)online : 1;
    count = count < files->count ? count : files->count;
    return (uint32_t)(count < MAX_THREADS ? count : MAX_THREADS);
}

static bool start(struct run *run)
{
    pthread_t threads[MAX_THREADS];
    uint32_t wanted = count_threads(run->options, run->files), count = 0;
    while (count < wanted && pthread_create(&threads[count], NULL, work, run) == 0)
        count++;
    if (count > 0 || wanted == 0)
        watch(run);
    else
        fprintf(stderr, "sluice-bake: no thread can be started\n");
    for (uint32_t i = 0; i < count; i++)
        pthread_join(threads[i], NULL);
    return count > 0 || wanted == 0;
}

bool bake_files(const struct options *options, const struct files *files, struct outcome *outcomes)
{
    struct run run = {.options = options, .files = files, .outcomes = outcomes};
    SluiceBakerCreateInfo info = {
        .threadCount = options->threads, .maxMemory = options->memory, .log = {NULL, on_log}};
    SluiceResult result = sluiceCreateBaker(&info, &run.baker);
    if (result != SLUICE_SUCCESS) {
        text_say("sluice-bake: %s", sluiceResultString(result));
        return false;
    }
    pthread_mutex_init(&run.mutex, NULL);
    pthread_cond_init(&run.ended, NULL);
    bool done = start(&run);
    pthread_cond_destroy(&run.ended);
    pthread_mutex_destroy(&run.mutex);
    sluiceDestroyBaker(run.baker);
    return done;
}
