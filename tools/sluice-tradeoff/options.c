#include "options.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/input.h"
#include "../common/nearest.h"
#include "../common/shared_options.h"

#define QUICK_REPEATS 3u
#define FULL_REPEATS 5u

static const char usage[] =
    "usage: sluice-tradeoff [sweep] SCENE [OPTION ...] [-- OPTION OF THE SCENE'S PROGRAM ...]\n"
    "       sluice-tradeoff page RESULTS [--json]\n"
    "       sluice-tradeoff play TRACE [OPTION ...]\n"
    "\n"
    "Runs a scene with many settings and shows what each costs in time, in memory and in the\n"
    "picture: a table, points.csv, runs.csv and page.html. SCENE is\n"
    "  gallery          a walk past pictures whose textures are streamed\n"
    "  demand-tracer    a garden whose textures are loaded when rays hit them\n"
    "  neural           a neural set that hangs in the gallery: -- --neural-set FILE.ntc\n"
    "  view             any scene of sluice-view: -- SCENE.gltf --play CAMERA-PATH\n"
    "  trace FILE       recorded feedback, played without a device\n"
    "Runs that are complete are kept, so that the same command goes on after an interruption;\n"
    "`page` makes the results again of what is there. `play --help` lists its options.\n";

static const char notes[] =
    "Exit status: 0 all points were measured; 1 some failed, they are named in the table, or\n"
    "results cannot be written; 2 wrong usage; 77 no device can draw the scene; 130\n"
    "interrupted.\n";

static void print_settings(const struct scene *scene)
{
    printf("\nSettings of %s, with the values of the full plan\n", scene->name);
    for (uint32_t i = 0; i < scene->setting_count; i++) {
        const struct scene_setting *setting = &scene->settings[i];
        printf("  %-20s %s\n", setting->setting.name, setting->setting.meaning);
        if (setting->full)
            printf("  %-20s %s%s\n", "", setting->full,
                   setting->quick ? "" : " (not in the quick plan)");
    }
}

static bool refuse_scene(const struct option_table *table, const char *word)
{
    static const char *const names[] = {"gallery", "demand-tracer", "neural", "view",
                                        "trace",   "sweep",         "page",   "play"};
    char question[64];
    struct nearest nearest = {.word = word, .word_length = strlen(word)};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        nearest_try(&nearest, names[i], strlen(names[i]));
    return options_refuse(
        table, "there is no scene '%s': gallery, demand-tracer, neural, view or trace FILE%s", word,
        nearest_question(&nearest, "", question, sizeof question));
}

/* Checks a file before anything runs, so that the error comes early and once. */
static bool is_readable(const struct option_table *table, const char *path)
{
    FILE *file = input_open(path);
    if (!file)
        return options_refuse(table, "%s: %s", path, input_reason(errno));
    fclose(file);
    return true;
}

static bool has_word(const struct text_list *list, const char *word)
{
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->items[i], word) == 0)
            return true;
    return false;
}

static bool is_complete(const struct option_table *table, struct options *o, const char *scene)
{
    o->scene = scene_find(scene);
    if (!o->scene)
        return refuse_scene(table, scene);
    if (o->scene != &scene_trace && o->trace)
        return options_refuse(table, "'%s' is one word too many; --help says more", o->trace);
    if (o->scene == &scene_trace && !o->trace)
        return options_refuse(table, "trace needs a file");
    if (o->trace && !is_readable(table, o->trace))
        return false;
    if (o->scene == &scene_neural && !has_word(&o->scene_arguments, "--neural-set"))
        return options_refuse(table, "neural needs a set: -- --neural-set FILE.ntc");
    if (o->grid && o->sweeps.count == 0)
        return options_refuse(table, "--grid needs --sweep");
    return true;
}

static void add_texts(struct text_list *list, const char *const *texts, size_t count)
{
    for (size_t i = 0; i < count; i++)
        text_list_add(list, texts[i]);
}

enum option_outcome options_parse_sweep(int argc, char **argv, struct options *o)
{
    struct option_texts sweeps = {0}, bases = {0};
    struct option_list rest = {0};
    const char *scene = NULL;
    bool quick = false;
    *o = (struct options){0};
    const struct option options[] = {
        {OPTION_WORD, .operand = "SCENE", .value = &scene, .minimum = 1,
         .help = "a scene (gallery, demand-tracer, neural, view or trace FILE)"},
        {OPTION_WORD, .operand = "FILE", .value = &o->trace},
        {OPTION_REST, .value = &rest},
        {OPTION_SECTION, .help = "Plan"},
        {OPTION_FLAG, "quick", .value = &quick,
         .help = "a small scene and few values, which is the default"},
        {OPTION_FLAG, "full", .value = &o->full,
         .help = "the scene as its program has it, all settings and a grid"},
        {OPTION_REPEATED, "sweep", "NAME=V,V...", "(the plan's)", &sweeps,
         "values of a setting, instead of the plan's. May be given for several. Any option of the "
         "scene's program is a setting"},
        {OPTION_FLAG, "grid", .value = &o->grid,
         .help = "all combinations of what --sweep names, not each by itself"},
        {OPTION_REPEATED, "base", "NAME=V", "(the program's)", &bases,
         "value that a setting has in all other points"},
        {OPTION_UINT, "repeats", "N", "(3; 5 with --full)", &o->repeats, "runs of each point", 1,
         1000},
        {OPTION_SECTION, .help = "Runs"},
        {OPTION_TEXT, "results", "DIR", "tradeoff-out", &o->results,
         "folder where everything is written"},
        {OPTION_FLAG, "fresh", .value = &o->fresh, .help = "forget the runs that are there"},
        {OPTION_TEXT, "program", "PATH", "(as built or installed with this tool)", &o->program,
         "program that draws the scene"},
        {OPTION_SECONDS, "run-limit", "SECONDS", "600", &o->run_limit,
         "most time for a run; longer ones fail", 1e-3, 1e9},
        {OPTION_UINT, "jobs", "N", "1", &o->jobs,
         "runs at a time; more than one disturb each other's times", 1, 256},
        option_json(&o->json),
    };
    const struct option_table table = {"sluice-tradeoff", usage, notes, options,
                                       sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    if (outcome == OPTIONS_HELP) {
        print_settings(&scene_gallery);
        print_settings(&scene_demand_tracer);
        print_settings(&scene_neural);
        print_settings(&scene_view);
        print_settings(&scene_trace);
    }
    if (outcome != OPTIONS_RUN)
        return outcome;
    add_texts(&o->sweeps, sweeps.items, sweeps.count);
    add_texts(&o->bases, bases.items, bases.count);
    add_texts(&o->scene_arguments, (const char *const *)rest.items, rest.count);
    if (o->repeats == 0)
        o->repeats = o->full ? FULL_REPEATS : QUICK_REPEATS;
    if (quick && o->full)
        options_refuse(&table, "--quick or --full, not both");
    else if (is_complete(&table, o, scene))
        return OPTIONS_RUN;
    return OPTIONS_ERROR;
}

/* Adds the scene's options. Each has one value. */
void options_add_scene(const struct options *o, struct text_list *arguments)
{
    const char *scene = o->full ? o->scene->full_arguments : o->scene->quick_arguments;
    struct text_list words = {0};
    if (*scene)
        text_list_add_parts(&words, scene, ' ');
    for (size_t i = 0; i + 1 < words.count; i += 2) {
        if (has_word(&o->scene_arguments, words.items[i]))
            continue;
        text_list_add(arguments, words.items[i]);
        text_list_add(arguments, words.items[i + 1]);
    }
    text_list_finish(&words);
}

void options_finish(struct options *o)
{
    text_list_finish(&o->sweeps);
    text_list_finish(&o->bases);
    text_list_finish(&o->scene_arguments);
}
