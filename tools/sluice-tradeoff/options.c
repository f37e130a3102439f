#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/input.h"
#include "../common/text.h"

#define DEFAULT_RESULTS "tradeoff-out"
#define QUICK_REPEATS 3u
#define FULL_REPEATS 5u
#define DEFAULT_RUN_LIMIT 600.0

static void print_settings(const struct scene *scene)
{
    printf("\nSettings of %s, with the values of the full plan\n", scene->name);
    for (uint32_t i = 0; i < scene->setting_count; i++) {
        const struct scene_setting *setting = &scene->settings[i];
        printf("  %-20s %s%s%s%s\n", setting->setting.name, setting->setting.meaning,
               setting->full ? ": " : "", setting->full ? setting->full : "",
               setting->quick ? "" : " (not in the quick plan)");
    }
}

static void print_help(void)
{
    printf(
        "usage: sluice-tradeoff [sweep] SCENE [OPTION ...] [-- OPTION OF THE SCENE'S PROGRAM ...]\n"
        "       sluice-tradeoff page RESULTS [--json]\n"
        "       sluice-tradeoff play TRACE [OPTION ...]\n"
        "\n"
        "Runs a scene with many settings and shows what each costs in time, in memory and in the\n"
        "picture: a table, points.csv, runs.csv and page.html. SCENE is\n"
        "  gallery          a walk past pictures whose textures are streamed\n"
        "  demand-tracer    a garden whose textures are loaded when rays hit them\n"
        "  trace FILE       recorded feedback, played without a device\n"
        "Runs that are complete are kept, so that the same command goes on after an interruption;\n"
        "`page` makes the results again of what is there.\n"
        "Numbers in brackets are defaults.\n"
        "\n"
        "Plan\n"
        "  --quick              a small scene and few values [this one]\n"
        "  --full               the scene as its program has it, all settings and a grid\n"
        "  --sweep NAME=V,V...  these values of a setting instead of the plan's; may be given for\n"
        "                       several. Any option of the scene's program is a setting\n"
        "  --grid               all combinations of what --sweep names, not each by itself\n"
        "  --base NAME=V        the value that a setting has in all other points\n"
        "  --repeats N          runs of each point [%u; %u with --full]\n"
        "\n"
        "Runs\n"
        "  --results DIR        where everything is written [" DEFAULT_RESULTS "]\n"
        "  --fresh              forget the runs that are there\n"
        "  --program PATH       what draws the scene [as built or installed with this tool]\n"
        "  --run-limit SECONDS  for a run; longer ones fail [%g]\n"
        "  --jobs N             runs at a time; more than one disturb each other's times [1]\n"
        "  --json               figures as JSON lines on stdout instead of a table\n"
        "  --help               this text\n",
        QUICK_REPEATS, FULL_REPEATS, DEFAULT_RUN_LIMIT);
    print_settings(&scene_gallery);
    print_settings(&scene_demand_tracer);
    print_settings(&scene_trace);
    printf("\nExit status: 0 all points were measured; 1 some failed, they are named in the table, "
           "or\n"
           "results cannot be written; 2 wrong usage; 77 no device can draw the scene; 130\n"
           "interrupted.\n");
}

static bool parse_count(const char *name, const char *text, uint32_t most, uint32_t *value)
{
    char *end;
    unsigned long number = strtoul(text, &end, 10);
    bool good = *text >= '0' && *text <= '9' && *end == '\0' && number >= 1 && number <= most;
    if (!good)
        text_say("sluice-tradeoff: %s takes a whole number from 1 to %u, not '%s'", name, most,
                 text);
    *value = (uint32_t)number;
    return good;
}

static bool parse_seconds(const char *name, const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    bool good = end != text && *end == '\0' && *value > 0.0 && *value <= 1e9;
    if (!good)
        text_say("sluice-tradeoff: %s takes seconds up to 1e9, not '%s'", name, text);
    return good;
}

/* 0: no such option; 1: a flag; 2: one with a value. */
static int parse_option(struct options *o, const char *name, const char *value, bool *good)
{
    const struct flag {
        const char *name;
        bool *place, is;
    } flags[] = {{"--quick", &o->full, false},
                 {"--full", &o->full, true},
                 {"--grid", &o->grid, true},
                 {"--fresh", &o->fresh, true},
                 {"--json", &o->json, true}};
    static const char *const with_value[] = {"--sweep",   "--base", "--repeats",   "--results",
                                             "--program", "--jobs", "--run-limit", NULL};
    size_t i = 0;
    for (size_t f = 0; f < sizeof flags / sizeof *flags; f++)
        if (strcmp(name, flags[f].name) == 0) {
            *flags[f].place = flags[f].is;
            return 1;
        }
    while (with_value[i] && strcmp(name, with_value[i]) != 0)
        i++;
    *good = *good && with_value[i] && value && *value;
    if (with_value[i] && !*good)
        text_say("sluice-tradeoff: %s needs a value", name);
    if (!*good)
        return with_value[i] ? 2 : 0;
    switch (i) {
    case 0: text_list_add(&o->sweeps, value); break;
    case 1: text_list_add(&o->bases, value); break;
    case 2: *good = parse_count(name, value, 1000, &o->repeats); break;
    case 3: o->results = value; break;
    case 4: o->program = value; break;
    case 5: *good = parse_count(name, value, 256, &o->jobs); break;
    default: *good = parse_seconds(name, value, &o->run_limit); break;
    }
    return 2;
}

static bool take_word(struct options *o, const char *word)
{
    if (!o->scene) {
        o->scene = scene_find(word);
        if (!o->scene)
            text_say(
                "sluice-tradeoff: there is no scene '%s': gallery, demand-tracer or trace FILE",
                word);
        return o->scene != NULL;
    }
    if (o->scene == &scene_trace && !o->trace) {
        o->trace = word;
        return true;
    }
    text_say("sluice-tradeoff: '%s' is one word too many", word);
    return false;
}

/* Better said once, before anything is run. */
static bool is_readable(const char *path)
{
    FILE *file = input_open(path);
    if (!file) {
        text_say("sluice-tradeoff: %s: %s", path, input_reason(errno));
        return false;
    }
    fclose(file);
    return true;
}

static bool is_complete(struct options *o)
{
    if (!o->scene)
        text_say("sluice-tradeoff: a scene is needed: gallery, demand-tracer or trace FILE; --help "
                 "says more");
    else if (o->scene == &scene_trace && !o->trace)
        text_say("sluice-tradeoff: trace needs a file");
    else if (o->trace && !is_readable(o->trace))
        return false;
    else if (o->grid && o->sweeps.count == 0)
        text_say("sluice-tradeoff: --grid needs --sweep");
    else
        return true;
    return false;
}

enum options_outcome options_parse_sweep(int argc, char *const *argv, struct options *o)
{
    bool good = true;
    *o = (struct options){.results = DEFAULT_RESULTS, .jobs = 1, .run_limit = DEFAULT_RUN_LIMIT};
    int i = 1;
    for (; i < argc && good && strcmp(argv[i], "--") != 0; i++) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            print_help();
            return SWEEP_OPTIONS_HELP;
        }
        int taken = argv[i][0] == '-' ? parse_option(o, argv[i], argv[i + 1], &good) : 1;
        if (taken == 0)
            text_say("sluice-tradeoff: there is no option %s", argv[i]);
        good = good && taken > 0 && (argv[i][0] == '-' || take_word(o, argv[i]));
        i += taken == 2;
    }
    for (i++; i < argc; i++)
        text_list_add(&o->scene_arguments, argv[i]);
    if (o->repeats == 0)
        o->repeats = o->full ? FULL_REPEATS : QUICK_REPEATS;
    return good && is_complete(o) ? SWEEP_OPTIONS_RUN : SWEEP_OPTIONS_ERROR;
}

static bool has_word(const struct text_list *list, const char *word)
{
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->items[i], word) == 0)
            return true;
    return false;
}

/* All of them are options with one value. */
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
