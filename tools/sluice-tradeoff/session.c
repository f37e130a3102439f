#include "session.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/output_file.h"
#include "../common/text.h"
#include "../sluice-replay/file.h"
#include "plan.h"

/* Finds the scene's program. A scene without one uses this tool, which plays traces. */
static bool find_program(struct session *s, const char *own_path, bool recall)
{
    const struct scene *scene = s->options.scene;
    struct text_list *arguments = &s->program.arguments;
    if (s->options.program) {
        text_list_add(arguments, s->options.program);
    } else if (scene->program) {
        char *path = program_find(own_path, scene->program, scene->installed);
        if (!path && !recall) {
            text_say("sluice-tradeoff: %s was neither built nor installed with this tool: "
                     "build the samples, or name it with --program",
                     scene->installed);
            return false;
        }
        text_list_add(arguments, path ? path : scene->installed);
        free(path);
    } else {
        text_list_add(arguments, own_path);
    }
    if (s->options.trace) {
        text_list_add(arguments, "play");
        text_list_add(arguments, s->options.trace);
    }
    return true;
}

static char *describe_scene(const struct options *o)
{
    struct text_list words = {0};
    if (o->trace)
        text_list_add(&words, o->trace);
    options_add_scene(o, &words);
    text_list_add_all(&words, &o->scene_arguments);
    char *line = text_list_join(&words);
    text_list_finish(&words);
    return line;
}

bool session_open(struct session *s, const char *own_path, bool recall)
{
    const struct options *o = &s->options;
    if (!find_program(s, own_path, recall) ||
        !(recall ? program_recall(&s->program, o->results) : program_ask(&s->program, o->results)))
        return false;
    s->sweep.title = memory_copy_text(o->scene->title);
    s->sweep.scene = describe_scene(o);
    s->sweep.repeats = o->repeats;
    if (!plan_build(o, o->scene, &s->program, &s->sweep))
        return false;
    s->runs = (struct runs){
        .options = o, .program = &s->program, .sweep = &s->sweep, .results = o->results};
    runs_init(&s->runs, recall);
    return true;
}

static void finish_point(const struct sweep *sweep, struct sweep_point *point)
{
    for (uint32_t i = 0; i < sweep->setting_count; i++)
        free(point->values[i]);
    free(point->values);
    free(point->label);
    free(point->command_line);
    free(point->folder);
    free(point->reason);
    free(point->estimates);
    free(point->deltas);
    free(point->measured);
}

/* Frees a block that the session owns and lends as constant. */
static void free_const(const void *block)
{
    free((void *)(uintptr_t)block);
}

static void finish_sweep(struct sweep *sweep)
{
    for (uint32_t i = 0; i < sweep->point_count; i++)
        finish_point(sweep, &sweep->points[i]);
    for (uint32_t i = 0; i < sweep->setting_count; i++) {
        free_const(sweep->settings[i].name);
        free_const(sweep->settings[i].meaning);
        free_const(sweep->settings[i].unit);
    }
    free_const(sweep->settings);
    free_const(sweep->metrics);
    free(sweep->points);
    free(sweep->title);
    free(sweep->scene);
    free(sweep->machine);
    free(sweep->command_line);
}

void session_close(struct session *s)
{
    runs_finish(&s->runs);
    finish_sweep(&s->sweep);
    program_finish(&s->program);
    options_finish(&s->options);
    *s = (struct session){0};
}

/* Writes the words of the command line, each ended by a NUL. */
bool session_remember(const char *results, int argc, char *const *argv)
{
    char *path = memory_text("%s/sweep.words", results);
    struct output_file *output = output_file_begin(path);
    for (int i = 0; i < argc && output; i++)
        fwrite(argv[i], strlen(argv[i]) + 1, 1, output_file_stream(output));
    free(path);
    return output_file_end(output, true);
}

bool session_recall(const char *results, struct text_list *arguments)
{
    char *path = memory_text("%s/sweep.words", results), *words = NULL;
    size_t size = 0;
    bool read = read_file(path, &words, &size);
    if (!read)
        text_say("sluice-tradeoff: %s: %s", path, strerror(errno));
    for (size_t at = 0; read && at < size; at += strlen(words + at) + 1)
        text_list_add(arguments, words + at);
    free(words);
    free(path);
    return read && arguments->count > 0;
}
