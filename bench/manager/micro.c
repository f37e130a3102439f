/**
 * Times single calls of the manager, and weighs it. Each part runs in a process of its own, so that
 * none finds the memory of another.
 */
#define _POSIX_C_SOURCE 200809L
#include "figures.h"
#include "micro.h"

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
enum { PARTS = sizeof parts / sizeof *parts, MAX_TRACES = 8 };

static const char *only; ///< NULL: everything
static const char *traces[MAX_TRACES];
static int trace_count;

static void usage(void)
{
    printf("usage: micro [--json] [--quick] [--only NAME] [--trace FILE]...\n"
           "  --json         one object per line: name, value, unit (default: a table)\n"
           "  --quick        a tenth of the repetitions, a tenth of the tiles for memory\n"
           "  --only NAME    one part alone (default: all of them):");
    for (int i = 0; i < PARTS; i++)
        printf(" %s", parts[i].name);
#ifdef WITH_HARNESS
    printf(" floor\n  --trace FILE   a trace for floor, which copies its maps (default: none)\n");
#else
    printf("\n  built without the harness: no cut, no floor\n");
#endif
}

static void parse(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--json") == 0) {
            options.json = true;
        } else if (strcmp(argv[i], "--quick") == 0) {
            options.quick = true;
        } else if (strcmp(argv[i], "--only") == 0 && i + 1 < argc) {
            only = argv[++i];
        } else if (strcmp(argv[i], "--trace") == 0 && i + 1 < argc && trace_count < MAX_TRACES) {
            traces[trace_count++] = argv[++i];
        } else if (strcmp(argv[i], "--help") == 0) {
            usage();
            exit(0);
        } else {
            fprintf(stderr, "unknown option %s (see --help)\n", argv[i]);
            exit(2);
        }
    }
}

static bool chosen(const char *name)
{
    return !only || strcmp(only, name) == 0;
}

/** True in the child, which runs a part and exits; the parent waits for it. */
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
    bool any = false;
    parse(argc, argv);
    for (int i = 0; i < PARTS; i++) {
        if (!chosen(parts[i].name))
            continue;
        any = true;
        if (forked(parts[i].name, &status)) {
            parts[i].run();
            return 0;
        }
    }
#ifdef WITH_HARNESS
    any = any || chosen("floor");
    for (int i = 0; chosen("floor") && i < trace_count; i++) {
        if (forked(traces[i], &status)) {
            bench_floor(traces[i]);
            return 0;
        }
    }
#endif
    if (!any) {
        fprintf(stderr, "there is no part named %s (see --help)\n", only);
        return 2;
    }
    return status;
}
