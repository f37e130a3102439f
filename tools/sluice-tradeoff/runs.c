#include "runs.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "../sluice-replay/file.h"
#include "folders.h"
#include "frames.h"
#include "plan.h"
#include "run_names.h"

#define LONGEST_PREFIX 48

/* Adds the arguments that decide a run's figures. Output paths are not among them. */
static void add_deciding_arguments(const struct runs *runs, const struct run *run,
                                   struct text_list *arguments)
{
    const struct options *o = runs->options;
    text_list_add_all(arguments, &runs->program->arguments);
    options_add_scene(o, arguments);
    o->scene->add_repeat_arguments(runs->program, run->repeat, arguments);
    text_list_add_all(arguments, &o->scene_arguments);
    plan_add_arguments(runs->sweep, &runs->sweep->points[run->point], runs->program, arguments);
}

void runs_add_arguments(const struct runs *runs, const struct run *run, const char *folder,
                        struct text_list *arguments)
{
    char *reference = memory_text("%s/reference", runs->results);
    const struct run *base = &runs->items[runs->sweep->base];
    const struct scene_run place = {folder, reference, run == base ? NULL : base->folder,
                                    run->repeat};
    add_deciding_arguments(runs, run, arguments);
    runs->options->scene->add_run_arguments(runs->program, &place, arguments);
    free(reference);
}

/* Makes a key: a readable prefix, then a hash that makes it unique. */
static char *make_key(const struct runs *runs, const struct run *run)
{
    char prefix[LONGEST_PREFIX + 1];
    const char *label = runs->sweep->points[run->point].label;
    size_t length = 0;
    for (; label[length] && length < LONGEST_PREFIX; length++)
        prefix[length] = isalnum((unsigned char)label[length]) ? label[length] : '-';
    prefix[length] = '\0';

    struct text_list arguments = {0};
    add_deciding_arguments(runs, run, &arguments);
    uint64_t hash = runs->program->build;
    for (size_t i = 1; i < arguments.count; i++)
        hash = program_hash(hash, arguments.items[i], strlen(arguments.items[i]) + 1);
    hash = program_hash(hash, &run->repeat, sizeof run->repeat);
    text_list_finish(&arguments);
    return memory_text("%s-r%u-%016" PRIx64, prefix, run->repeat + 1, hash);
}

/* Reads the figures that the run printed, and derives figures from its frames. */
static bool read_figures(const char *folder, struct figures *figures)
{
    struct frames frames;
    char *path = memory_text("%s/figures.jsonl", folder);
    bool read = figures_read(path, figures) && figures->count > 0;
    free(path);
    path = memory_text("%s/frames.csv", folder);
    if (frames_read(path, &frames))
        frames_derive(&frames, figures);
    frames_finish(&frames);
    free(path);
    return read;
}

static char *read_reason(const char *folder)
{
    size_t size;
    char *reason = NULL, *path = memory_text("%s.failed/reason.txt", folder);
    read_file(path, &reason, &size);
    free(path);
    if (reason)
        reason[strcspn(reason, "\n")] = '\0';
    return reason;
}

void runs_look(struct run *run)
{
    free(run->reason);
    figures_finish(&run->figures);
    run->reason = NULL;
    run->state = SWEEP_PENDING;
    if (folders_exists(run->folder)) {
        if (read_figures(run->folder, &run->figures))
            run->state = SWEEP_DONE;
    } else if ((run->reason = read_reason(run->folder))) {
        run->state = SWEEP_FAILED;
    }
}

void runs_init(struct runs *runs, bool recall)
{
    char *names = recall ? run_names_read(runs->results) : NULL;
    uint32_t point_count = runs->sweep->point_count;
    runs->count = point_count * runs->sweep->repeats;
    runs->items = memory_take(runs->count, sizeof *runs->items);
    for (uint32_t i = 0; i < runs->count; i++) {
        struct run *run = &runs->items[i];
        run->point = i % point_count;
        run->repeat = i / point_count;
        run->key = run_names_find(names, runs->sweep->points[run->point].label, run->repeat);
        if (!run->key)
            run->key = make_key(runs, run);
        run->folder = memory_text("%s/runs/%s", runs->results, run->key);
        runs_look(run);
        run->was_there = run->state == SWEEP_DONE;
    }
    free(names);
}

void runs_finish(struct runs *runs)
{
    for (uint32_t i = 0; i < runs->count; i++) {
        struct run *run = &runs->items[i];
        free(run->key);
        free(run->folder);
        free(run->reason);
        figures_finish(&run->figures);
    }
    free(runs->items);
    runs->items = NULL;
    runs->count = 0;
}
