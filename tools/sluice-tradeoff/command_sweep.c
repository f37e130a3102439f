#define _XOPEN_SOURCE 700
#include "commands.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../common/files.h"
#include "../common/output_file.h"
#include "../common/shared_options.h"
#include "../common/text.h"
#include "folders.h"
#include "foresight.h"
#include "page.h"
#include "recommend.h"
#include "results.h"
#include "run_names.h"
#include "session.h"
#include "table.h"

/* Writes all files, even after one has failed. */
static bool write_files(const struct session *s, const struct sweep_recommendation *recommendations)
{
    char *points = memory_text("%s/points.csv", s->options.results);
    char *runs = memory_text("%s/runs.csv", s->options.results);
    char *page = memory_text("%s/page.html", s->options.results);
    bool good = results_write_points(&s->sweep, points);
    good = results_write_runs(&s->runs, runs) && good;
    good = page_write(&s->sweep, recommendations, RECOMMEND_COUNT, page) && good;
    free(points);
    free(runs);
    free(page);
    return good;
}

/* Writes and prints all results of the runs. */
static int show_results(struct session *s)
{
    struct sweep_recommendation recommendations[RECOMMEND_COUNT];
    const struct scene_roles *roles = &s->options.scene->roles;
    results_collect(&s->runs, &s->sweep);
    const struct recommend_metrics metrics = {results_pick(&s->sweep, roles->quality),
                                              results_pick(&s->sweep, roles->memory),
                                              results_pick(&s->sweep, roles->time)};
    recommend(&s->sweep, &metrics, recommendations);
    bool good = write_files(s, recommendations);
    if (s->options.json)
        table_print_json(&s->runs, recommendations, RECOMMEND_COUNT);
    else
        table_print(&s->sweep, &metrics, recommendations, RECOMMEND_COUNT);
    if (good && !s->options.json)
        printf("\nThe page, with plots and pictures: %s/page.html\n", s->options.results);
    recommend_finish(recommendations);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        text_say("sluice-tradeoff: cannot write: %s", strerror(errno));
        good = false;
    }
    for (uint32_t i = 0; i < s->sweep.point_count; i++)
        good = good && s->sweep.points[i].state == SWEEP_DONE;
    return good ? TRADEOFF_DONE : TRADEOFF_FAILED;
}

/* Returns whether the trace is in a folder that would be removed. */
static bool holds_trace(const char *folder, const char *trace)
{
    char *whole = realpath(folder, NULL), *file = trace ? realpath(trace, NULL) : NULL;
    size_t length = whole ? strlen(whole) : 0;
    bool holds = whole && file && strncmp(file, whole, length) == 0 && file[length] == '/';
    if (holds)
        text_say("sluice-tradeoff: %s: --fresh would remove it with %s; copy it elsewhere first",
                 trace, folder);
    free(whole);
    free(file);
    return holds;
}

/* Removes all folders or none. */
static bool forget(const struct options *o)
{
    static const char *const names[] = {"runs", "reference", "clairvoyant"};
    enum { COUNT = sizeof names / sizeof *names };
    char *paths[COUNT];
    bool may = true, gone = true;
    for (size_t i = 0; i < COUNT; i++) {
        paths[i] = memory_text("%s/%s", o->results, names[i]);
        may = may && folders_may_forget(paths[i]) && !holds_trace(paths[i], o->trace);
    }
    for (size_t i = 0; i < COUNT; i++) {
        gone = may && gone && folders_forget(paths[i]);
        free(paths[i]);
    }
    return gone;
}

/* Returns whether the folder has results but no sweep.words: a sweep writes that file first. */
static bool is_of_somebody_else(const char *results)
{
    static const char *const names[] = {"points.csv", "runs.csv", "page.html", "machine.txt"};
    char *words = memory_text("%s/sweep.words", results);
    bool is_own = access(words, F_OK) == 0, has = false;
    free(words);
    for (size_t i = 0; i < sizeof names / sizeof *names && !is_own && !has; i++) {
        char *path = memory_text("%s/%s", results, names[i]);
        has = access(path, F_OK) == 0;
        if (has)
            text_say("sluice-tradeoff: %s is not of a sweep and would be replaced; name another "
                     "folder with --results",
                     path);
        free(path);
    }
    return has;
}

/* Claims the results folder for this process. */
static bool prepare_folder(const struct options *o)
{
    char *runs = memory_text("%s/runs", o->results);
    bool ready = files_make_folders(o->results) && !is_of_somebody_else(o->results) &&
                 (!o->trace || output_add_input(o->trace));
    if (ready && !folders_lock(o->results)) {
        ready = false;
        if (errno == EACCES || errno == EAGAIN)
            text_say("sluice-tradeoff: another sweep is at work in %s", o->results);
        else
            text_say("sluice-tradeoff: %s: %s", o->results, strerror(errno));
    }
    ready = ready && (!o->fresh || forget(o)) && folders_make_own(runs);
    free(runs);
    return ready;
}

/* Marks the folder before the scene's program writes into it. */
static bool make_reference(const struct session *s)
{
    if (!s->options.scene->keeps_reference || !program_has_option(&s->program, "reference"))
        return true;
    char *path = memory_text("%s/reference", s->options.results);
    bool made = folders_make_own(path);
    free(path);
    return made;
}

static int interrupted(void)
{
    text_say("sluice-tradeoff: interrupted; the same command goes on from here");
    return TRADEOFF_INTERRUPTED;
}

static int make_runs(struct session *s, const char *own_path)
{
    switch (runs_make(&s->runs)) {
    case RUNS_DONE:
        foresight_add(&s->runs, own_path, false);
        if (child_is_interrupted())
            return interrupted();
        return results_remember_machine(&s->runs) ? show_results(s) : TRADEOFF_FAILED;
    case RUNS_INTERRUPTED: return interrupted();
    case RUNS_NO_DEVICE: return TRADEOFF_NO_DEVICE;
    case RUNS_UNWRITABLE: return TRADEOFF_FAILED;
    }
    return TRADEOFF_FAILED;
}

static char *join_words(int argc, char *const *argv)
{
    struct text_list words = {0};
    text_list_add(&words, "sluice-tradeoff");
    for (int i = 1; i < argc; i++)
        text_list_add(&words, argv[i]);
    char *line = text_list_join(&words);
    text_list_finish(&words);
    return line;
}

int command_sweep(int argc, char **argv)
{
    struct session s = {0};
    int status = TRADEOFF_FAILED;
    enum option_outcome outcome = options_parse_sweep(argc, argv, &s.options);
    char *own_path = program_own_path(argv[0]);
    child_watch_interruptions();
    output_set_speaker("sluice-tradeoff: ");
    if (outcome != OPTIONS_RUN) {
        status = outcome == OPTIONS_HELP ? TRADEOFF_DONE : TRADEOFF_USAGE;
    } else if (prepare_folder(&s.options)) {
        s.sweep.command_line = join_words(argc, argv);
        if (session_open(&s, own_path, false) && make_reference(&s) &&
            session_remember(s.options.results, argc, argv) && run_names_write(&s.runs))
            status = make_runs(&s, own_path);
    }
    session_close(&s);
    free(own_path);
    return status;
}

/* Uses the folder's current path: it may have been moved since. */
static int show_again(struct session *s, const struct text_list *words, const char *own_path,
                      const char *results, bool json)
{
    if (options_parse_sweep((int)words->count, words->items, &s->options) != OPTIONS_RUN)
        return TRADEOFF_FAILED;
    s->options.results = results;
    s->options.json = json;
    s->sweep.command_line = join_words((int)words->count, words->items);
    if (!session_open(s, own_path, true))
        return TRADEOFF_FAILED;
    foresight_add(&s->runs, own_path, true);
    return show_results(s);
}

int command_page(int argc, char **argv)
{
    struct session s = {0};
    struct text_list words = {0};
    const char *results = NULL;
    bool json = false;
    const struct option options[] = {
        {OPTION_WORD, .operand = "RESULTS", .value = &results, .minimum = 1,
         .help = "the folder of a sweep"},
        option_json(&json),
    };
    const struct option_table table = {
        "sluice-tradeoff page",
        "usage: sluice-tradeoff page RESULTS [--json]\n"
        "\n"
        "Makes the table, the CSV files and the page of a sweep again, without a run.\n",
        NULL, options, sizeof options / sizeof *options};
    switch (options_parse(&table, argc, argv)) {
    case OPTIONS_RUN: break;
    case OPTIONS_HELP: return TRADEOFF_DONE;
    case OPTIONS_ERROR: return TRADEOFF_USAGE;
    }
    char *own_path = program_own_path(argv[0]);
    output_set_speaker("sluice-tradeoff: ");
    int status = session_recall(results, &words) ? show_again(&s, &words, own_path, results, json)
                                                 : TRADEOFF_FAILED;
    session_close(&s);
    text_list_finish(&words);
    free(own_path);
    return status;
}
