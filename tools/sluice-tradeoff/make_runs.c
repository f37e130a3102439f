/* Makes missing runs. Points take turns within each repeat, so a machine that slows down during a
 * sweep affects all points alike. */
#include "runs.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "../common/clock.h"
#include "../common/progress.h"
#include "../common/text.h"
#include "core_time.h"
#include "folders.h"

#define EXIT_NO_DEVICE 77

/** A run in progress. `run` is NULL between runs. */
struct job {
    struct run *run;
    char *partial, *out, *error; ///< owned
    struct text_list arguments;
    struct child child;
};

struct maker {
    struct runs *runs;
    struct job *jobs;
    uint32_t next, running, made;
    enum runs_outcome outcome;
    struct progress progress;
};

static void cannot_write(struct maker *maker, const char *path)
{
    text_say("sluice-tradeoff: %s: %s", path, strerror(errno));
    maker->outcome = RUNS_UNWRITABLE;
}

static void finish_job(struct job *job)
{
    free(job->partial);
    free(job->out);
    free(job->error);
    text_list_finish(&job->arguments);
    *job = (struct job){0};
}

static void begin_job(struct maker *maker, struct job *job, struct run *run)
{
    job->run = run;
    job->partial = memory_text("%s.partial", run->folder);
    job->out = memory_text("%s/figures.jsonl", job->partial);
    job->error = memory_text("%s/messages.txt", job->partial);
    runs_add_arguments(maker->runs, run, job->partial, &job->arguments);
    const struct child_info info = {
        .arguments = job->arguments.items,
        .out = job->out,
        .error = job->error,
        .limit = maker->runs->options->run_limit,
    };
    if (!folders_make_empty(job->partial) || !child_begin(&info, &job->child)) {
        cannot_write(maker, job->partial);
        finish_job(job);
        return;
    }
    maker->running++;
}

/* Appends figures that the tool itself measures to the program's output. */
static bool add_own_figures(const struct job *job, double seconds)
{
    char *trace = memory_text("%s/manager.trace", job->partial);
    double core = core_time_per_frame(trace);
    free(trace);
    FILE *file = fopen(job->out, "a");
    if (!file)
        return false;
    fprintf(file, "\n{\"name\": \"run_seconds\", \"value\": %.3f, \"unit\": \"s\"}\n", seconds);
    if (!isnan(core))
        fprintf(file, "{\"name\": \"core_us_per_frame\", \"value\": %.4f, \"unit\": \"us\"}\n",
                core);
    bool written = !ferror(file);
    return (fclose(file) == 0) & written;
}

static bool has_figures(const struct job *job)
{
    struct figures figures = {0};
    bool has = figures_read(job->out, &figures) && figures.count > 0;
    figures_finish(&figures);
    return has;
}

static bool write_reason(const struct job *job, const char *reason)
{
    char *path = memory_text("%s/reason.txt", job->partial);
    FILE *file = fopen(path, "w");
    bool written = file && fprintf(file, "%s\n", reason) > 0;
    free(path);
    return file && (fclose(file) == 0) & written;
}

/* Renames the folder last, when all its files are complete. */
static void end_job(struct maker *maker, struct job *job, char *reason)
{
    struct run *run = job->run;
    double seconds = clock_seconds() - job->child.started;
    char *failed = memory_text("%s.failed", run->folder);
    bool kept;
    if (!reason)
        kept = add_own_figures(job, seconds) && folders_remove(failed) &&
               folders_replace(job->partial, run->folder);
    else
        kept = write_reason(job, reason) && folders_replace(job->partial, failed);
    if (!kept)
        cannot_write(maker, run->folder);
    runs_look(run);
    if (reason)
        text_say("%s, run %u: %s", maker->runs->sweep->points[run->point].label, run->repeat + 1,
                 reason);
    free(failed);
    free(reason);
    finish_job(job);
    maker->running--;
    maker->made++;
}

static void look_after(struct maker *maker, struct job *job)
{
    int status = 0;
    enum child_state state = child_poll(&job->child, &status);
    if (state == CHILD_RUNS)
        return;
    bool base = job->run->point == maker->runs->sweep->base;
    if (state == CHILD_FAILED && base && WIFEXITED(status) && WEXITSTATUS(status) == EXIT_NO_DEVICE)
        maker->outcome = RUNS_NO_DEVICE;
    end_job(maker, job,
            state == CHILD_FAILED ? child_reason(&job->child, status)
            : !has_figures(job)   ? memory_copy_text("it printed no figures")
                                  : NULL);
}

/* Skips other runs of a failed point: they would fail too, and may take the whole time limit. */
static bool is_needed(const struct runs *runs, const struct run *run)
{
    for (uint32_t i = run->point; i < runs->count; i += runs->sweep->point_count)
        if (runs->items[i].state == SWEEP_FAILED)
            return false;
    return run->state == SWEEP_PENDING;
}

static void begin_jobs(struct maker *maker)
{
    struct runs *runs = maker->runs;
    /* The first run is alone: it makes the files that all runs share. */
    uint32_t most = maker->made == 0 ? 1 : runs->options->jobs;
    while (maker->running < most && maker->next < runs->count && maker->outcome == RUNS_DONE) {
        struct run *run = &runs->items[maker->next++];
        struct job *job = maker->jobs;
        while (job->run)
            job++;
        if (is_needed(runs, run))
            begin_job(maker, job, run);
    }
}

static void stop_jobs(struct maker *maker)
{
    for (uint32_t i = 0; i < maker->runs->options->jobs; i++) {
        struct job *job = &maker->jobs[i];
        if (!job->run)
            continue;
        child_kill(&job->child);
        folders_remove(job->partial);
        finish_job(job);
        maker->running--;
    }
}

/* Counts runs to make, including runs that failed before. */
static uint32_t count_wanted(struct runs *runs)
{
    uint32_t wanted = 0;
    for (uint32_t i = 0; i < runs->count; i++) {
        if (runs->items[i].state == SWEEP_FAILED)
            runs->items[i].state = SWEEP_PENDING;
        wanted += runs->items[i].state == SWEEP_PENDING;
    }
    return wanted;
}

enum runs_outcome runs_make(struct runs *runs)
{
    struct maker maker = {.runs = runs};
    uint32_t wanted = count_wanted(runs);
    if (wanted == 0)
        return RUNS_DONE;
    maker.jobs = memory_take(runs->options->jobs, sizeof *maker.jobs);
    progress_begin(&maker.progress, "sweeping", "runs", wanted);
    do {
        begin_jobs(&maker);
        if (child_is_interrupted())
            maker.outcome = RUNS_INTERRUPTED;
        for (uint32_t i = 0; i < runs->options->jobs && maker.outcome == RUNS_DONE; i++)
            if (maker.jobs[i].run)
                look_after(&maker, &maker.jobs[i]);
        progress_update(&maker.progress, maker.made);
        clock_sleep_until(clock_seconds() + 0.005);
    } while (maker.outcome == RUNS_DONE && (maker.running > 0 || maker.next < runs->count));
    stop_jobs(&maker);
    if (maker.outcome == RUNS_DONE)
        progress_end(&maker.progress);
    free(maker.jobs);
    return maker.outcome;
}
