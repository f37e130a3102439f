/** Runs a sequence of calls on the manager and on the naive one, and compares after every call. */
#ifndef TESTS_CORE_DIFFERENTIAL_H
#define TESTS_CORE_DIFFERENTIAL_H

#include "core/call_sequence.h"

#include <stdio.h>

struct differential;

/** Exits when out of memory. */
struct differential *differential_create(void);
void differential_destroy(struct differential *d);

/**
 * Returns the number of calls, or -1 at the first difference. `*message` then describes the call
 * and the difference, until the next run. `log`: gets a line per call, unless NULL.
 */
int differential_run(struct differential *d, struct choice choice, uint32_t call_count, FILE *log,
                     const char **message);

/** Prints counts of calls and results by kind, over all runs. */
void differential_print_coverage(const struct differential *d, FILE *file);

/** Returns an event of the rules that no run has reached, or NULL. */
const char *differential_missing_event(const struct differential *d);

#endif /* TESTS_CORE_DIFFERENTIAL_H */
