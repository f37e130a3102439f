#include "foresight.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../common/output_file.h"
#include "../common/text.h"
#include "../sluice-replay/file.h"
#include "folders.h"
#include "help_text.h"

#define ROUNDS "100" ///< rounds of the search; more hardly improve the result

/** A trace, and the settings that bound the policy. */
struct question {
    const char *own_path;
    char *trace, *answer;    ///< paths; owned
    struct text_list bounds; ///< options of `play`
};

/* Returns a setting's value: of the point, else of the command line, else the program's default.
 * NULL: unknown. */
static char *find_value(const struct runs *runs, uint32_t point, const char *name)
{
    const struct sweep *sweep = runs->sweep;
    const struct text_list *told = &runs->options->scene_arguments;
    struct help_entry entry;
    char *value = NULL;
    for (uint32_t i = 0; i < sweep->setting_count; i++)
        if (strcmp(sweep->settings[i].name, name) == 0)
            return *sweep->points[point].values[i]
                       ? memory_copy_text(sweep->points[point].values[i])
                       : NULL;
    for (size_t i = 0; i + 1 < told->count; i++)
        if (strncmp(told->items[i], "--", 2) == 0 && strcmp(told->items[i] + 2, name) == 0)
            return memory_copy_text(told->items[i + 1]);
    if (help_text_find(runs->program->help, name, &entry) && *entry.default_value)
        value = memory_copy_text(entry.default_value);
    help_entry_finish(&entry);
    return value;
}

/* Adds bounds: heaps of the same size and number, and the same time for loads. */
static void add_bounds(const struct runs *runs, uint32_t point, struct text_list *bounds)
{
    static const char *const names[] = {"heap-tiles", "max-heaps", "budget", "tiles-per-frame",
                                        "latency"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char *value = find_value(runs, point, names[i]);
        char *option = memory_text("--%s", names[i]);
        if (value) {
            text_list_add(bounds, option);
            text_list_add(bounds, value);
        }
        free(option);
        free(value);
    }
}

/* Returns false if there is no such trace. */
static bool make_question(const struct runs *runs, uint32_t point, struct question *question)
{
    const char *own_trace = runs->options->trace;
    char *data;
    size_t size;
    question->trace = own_trace ? memory_copy_text(own_trace)
                                : memory_text("%s/needs.trace", runs->items[point].folder);
    add_bounds(runs, point, &question->bounds);
    if (!read_file(question->trace, &data, &size))
        return false;
    uint64_t hash = program_hash(PROGRAM_HASH_START, data, size);
    free(data);
    for (size_t i = 0; i < question->bounds.count; i++)
        hash = program_hash(hash, question->bounds.items[i], strlen(question->bounds.items[i]) + 1);
    question->answer = memory_text("%s/clairvoyant/%016" PRIx64 ".jsonl", runs->results, hash);
    return true;
}

static void keep_answer(const char *path, const char *answer)
{
    size_t size;
    char *text;
    if (read_file(path, &text, &size))
        output_file_print(answer, "%s", text);
    else
        text_say("sluice-tradeoff: %s: %s", path, strerror(errno));
    free(text);
}

static void ask(const struct question *question, double limit, const char *folder)
{
    struct text_list arguments = {0};
    char *out = memory_text("%s/answer.jsonl", folder);
    char *error = memory_text("%s/messages.txt", folder);
    struct child child;
    int status = 0;
    text_list_add(&arguments, question->own_path);
    text_list_add(&arguments, "play");
    text_list_add(&arguments, question->trace);
    text_list_add_parts(&arguments, "--clairvoyant --json --rounds " ROUNDS, ' ');
    text_list_add_all(&arguments, &question->bounds);
    const struct child_info info = {arguments.items, out, error, limit, NULL};
    if (!child_begin(&info, &child)) {
        text_say("sluice-tradeoff: %s: %s", out, strerror(errno));
    } else if (child_wait(&child, &status) == CHILD_DONE) {
        keep_answer(out, question->answer);
    } else if (!child_is_interrupted()) {
        char *reason = child_reason(&child, status);
        text_say("%s, clairvoyant: %s", question->trace, reason);
        free(reason);
    }
    free(out);
    free(error);
    text_list_finish(&arguments);
}

static void ask_anew(const struct runs *runs, const struct question *question)
{
    char *scratch = folders_make_scratch(runs->results);
    if (scratch)
        ask(question, runs->options->run_limit, scratch);
    folders_remove_scratch(scratch);
}

static void add_answer(struct runs *runs, uint32_t point, const char *path)
{
    static const char *const names[] = {"clairvoyant_tiles", "clairvoyant_levels_too_coarse"};
    struct figures answer = {0};
    if (!figures_read(path, &answer))
        return;
    for (uint32_t i = point; i < runs->count; i += runs->sweep->point_count)
        for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
            const struct figure *figure = figures_find(&answer, names[n]);
            if (figure && runs->items[i].state == SWEEP_DONE)
                figures_add(&runs->items[i].figures, names[n], figure->value, figure->unit);
        }
    figures_finish(&answer);
}

void foresight_add(struct runs *runs, const char *own_path, bool recall)
{
    char *folder = memory_text("%s/clairvoyant", runs->results);
    for (uint32_t point = 0; point < runs->sweep->point_count; point++) {
        struct question question = {.own_path = own_path};
        if (runs->items[point].state == SWEEP_DONE && make_question(runs, point, &question)) {
            if (!recall && access(question.answer, F_OK) != 0 && !child_is_interrupted() &&
                folders_make_own(folder))
                ask_anew(runs, &question);
            add_answer(runs, point, question.answer);
        }
        text_list_finish(&question.bounds);
        free(question.trace);
        free(question.answer);
    }
    free(folder);
}
