/*
 * test_differential [SEQUENCES] [FIRST SEED] [--log]
 *
 * Random sequences of calls, the same for the manager and for the naive one. On a difference the
 * calls of that sequence are printed, and the program ends; SEQUENCES 1 with the seed that is named
 * and --log prints a sequence that passes. DEFAULT_SEQUENCES or more have to reach every rule.
 */
#include "core/differential.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_SEQUENCES 10000u

static struct choice seeded(uint64_t seed)
{
    return (struct choice){.state = seed * 0xD1342543DE82EF95u + 1};
}

static uint32_t length_of(uint64_t seed)
{
    struct choice c = seeded(~seed);
    return choice_range(&c, 100, 300);
}

/* Prints the sequence up to where the two differ. */
static void explain(struct differential *d, uint64_t seed, uint64_t number)
{
    const char *message;
    printf("not ok 1 - the_two_managers_agree_after_every_call\n# seed %" PRIu64 "\n", seed);
    fflush(stdout);
    differential_run(d, seeded(seed), length_of(seed), stderr, &message);
    fprintf(stderr, "seed %" PRIu64 ", sequence %" PRIu64 ", %s\n", seed, number, message);
    printf("# %s\n", message);
}

static int report_reach(const struct differential *d, uint64_t sequences)
{
    const char *fact = "random_calls_reach_every_rule";
    const char *missing = differential_missing_event(d);
    if (sequences < DEFAULT_SEQUENCES) {
        printf("ok 2 - %s # SKIP too few sequences\n", fact);
        return EXIT_SUCCESS;
    }
    if (missing)
        printf("not ok 2 - %s\n# none: %s\n", fact, missing);
    else
        printf("ok 2 - %s\n", fact);
    return missing ? EXIT_FAILURE : EXIT_SUCCESS;
}

static int run(struct differential *d, uint64_t sequences, uint64_t first_seed, bool log)
{
    uint64_t calls = 0;
    printf("1..2\n");
    for (uint64_t i = 0; i < sequences; i++) {
        const char *message;
        const uint64_t seed = first_seed + i;
        int made =
            differential_run(d, seeded(seed), length_of(seed), log ? stdout : NULL, &message);
        if (made < 0) {
            explain(d, seed, i);
            return EXIT_FAILURE;
        }
        calls += (uint64_t)made;
        if ((i + 1) % 1000 == 0) {
            printf("# %" PRIu64 " sequences, %" PRIu64 " calls\n", i + 1, calls);
            fflush(stdout);
        }
    }
    differential_print_coverage(d, stdout);
    printf("# %" PRIu64 " sequences from seed %" PRIu64 ", %" PRIu64 " calls\n", sequences,
           first_seed, calls);
    printf("ok 1 - the_two_managers_agree_after_every_call\n");
    return report_reach(d, sequences);
}

int main(int argc, char **argv)
{
    uint64_t numbers[2] = {DEFAULT_SEQUENCES, 1};
    int count = 0;
    bool log = false;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--log") == 0)
            log = true;
        else if (count < 2)
            numbers[count++] = strtoull(argv[i], NULL, 10);
    }
    struct differential *d = differential_create();
    int status = run(d, numbers[0], numbers[1], log);
    differential_destroy(d);
    return status;
}
