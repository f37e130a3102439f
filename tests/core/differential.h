/** Runs one sequence of calls on the manager and on the naive one, and compares after every call.
 */
#ifndef TESTS_CORE_DIFFERENTIAL_H
#define TESTS_CORE_DIFFERENTIAL_H

#include "core/call_sequence.h"

#include <stdio.h>

struct differential;

/** Ends the program if memory runs out. */
struct differential *differential_create(void);
void differential_destroy(struct differential *d);

/**
 * Returns the number of calls made, or -1 at the first difference: then *message says, until the
 * next run, what differs at which call. `log` gets a line per call, if not NULL.
 */
int differential_run(struct differential *d, struct choice choice, uint32_t call_count, FILE *log,
                     const char **message);

/** How often each kind of call was made and each result came back, over all runs. */
void differential_print_coverage(const struct differential *d, FILE *file);

/** What the rules name and no run has reached; NULL: nothing. */
const char *differential_missing_event(const struct differential *d);

#endif /* TESTS_CORE_DIFFERENTIAL_H */
