/**
 * Times single calls of the manager, and weighs it. Each part runs in a process of its own, so that
 * none finds the memory of another.
 */
#define _POSIX_C_SOURCE 200809L
#include "figures.h"
#include "micro.h"

#include "../../tools/common/chosen_names.h"
#include "../../tools/common/shared_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const struct part {
    const char *name;
    void (*run)(void);
} parts[] = {
    {"copy", bench_copy},   {"feedback", bench_feedback}, {"follow", bench_follow},
    {"idle", bench_idle},   {"add", bench_add},           {"memory", bench_memory},
    {"heaps", bench_heaps}, {"growth", bench_growth},
#ifdef WITH_HARNESS
    {"cut", bench_cut},
#endif
};
enum { PARTS = sizeof parts / sizeof *parts };
#ifdef WITH_HARNESS
#define PART_NAMES "copy,feedback,follow,idle,add,memory,heaps,growth,cut,floor"
#else
#define PART_NAMES "copy,feedback,follow,idle,add,memory,heaps,growth"
#endif

static const char *only; ///< NULL: everything
#ifdef WITH_HARNESS
static struct option_texts traces;
#endif

static enum option_outcome parse(int argc, char **argv)
{
    const struct option rows[] = {
        option_json(&options.json),
        {OPTION_FLAG, "quick", .value = &options.quick,
         .help = "a tenth of the repetitions, a tenth of the tiles for memory"},
        option_only(&only, "some of " PART_NAMES),
#ifdef WITH_HARNESS
        {OPTION_REPEATED, "trace", "FILE", "(none)", &traces,
         "trace for floor, which copies its maps"},
#endif
    };
    const struct option_table table = {"micro",
                                       "usage: micro [options]\n"
                                       "Times single calls of the manager, and weighs it.\n",
                                       NULL, rows, sizeof rows / sizeof *rows};
    return options_parse(&table, argc, argv);
}

/** Returns true in the child, which runs a part and exits. The parent waits for the child. */
static bool forked(const char *name, int *status)
{
    fprintf(stderr, "micro: %s\n", name);
    fflush(stdout);
    pid_t child = fork();
    if (child == 0)
        return true;
    int ended = 1;
    if (child < 0 || waitpid(child, &ended, 0) != child || ended != 0)
        *status = 1;
    return false;
}

int main(int argc, char **argv)
{
    int status = 0;
    switch (parse(argc, argv)) {
    case OPTIONS_RUN: break;
    case OPTIONS_HELP: return 0;
    case OPTIONS_ERROR: return 2;
    }
    if (!names_are_known(only, PART_NAMES))
        return 2;
    for (int i = 0; i < PARTS; i++) {
        if (!names_have(only, parts[i].name))
            continue;
        if (forked(parts[i].name, &status)) {
            parts[i].run();
            return 0;
        }
    }
#ifdef WITH_HARNESS
    for (int i = 0; names_have(only, "floor") && i < (int)traces.count; i++) {
        if (forked(traces.items[i], &status)) {
            bench_floor(traces.items[i]);
            return 0;
        }
    }
#endif
    return status;
}
