/**
 * What the generated tests share. The including file defines `struct fixture`, whose member `out`
 * is zeroed before each call, and the two functions below.
 */
#ifndef TESTS_NULL_ARGUMENTS_CALLS_H
#define TESTS_NULL_ARGUMENTS_CALLS_H

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

struct fixture;

/** `f` is zeroed. */
static void fixture_init(struct fixture *f, void **state);
static void fixture_finish(struct fixture *f);
static void calls_begin(struct fixture *f);

static struct fixture *calls_setup(void **state);
static void calls_finish(struct fixture *f);

#define CALLS_FUNCTIONS                                                                            \
    static void calls_begin(struct fixture *f)                                                     \
    {                                                                                              \
        memset(&f->out, 0, sizeof f->out);                                                         \
    }                                                                                              \
    static struct fixture *calls_setup(void **state)                                               \
    {                                                                                              \
        struct fixture *f = calloc(1, sizeof *f);                                                  \
        assert_non_null(f);                                                                        \
        fixture_init(f, state);                                                                    \
        return f;                                                                                  \
    }                                                                                              \
    static void calls_finish(struct fixture *f)                                                    \
    {                                                                                              \
        fixture_finish(f);                                                                         \
        free(f);                                                                                   \
    }

static inline void check_null(const char *what, SluiceResult result)
{
    if (result != SLUICE_ERROR_NULL_POINTER)
        fail_msg("%s: %s", what, sluiceResultString(result));
}

static inline void check_error(const char *what, SluiceResult result)
{
    if (result >= 0)
        fail_msg("%s: %s", what, sluiceResultString(result));
}

static inline void check_good(const char *what, SluiceResult result)
{
    if (result < 0)
        fail_msg("%s: %s", what, sluiceResultString(result));
}

/* It came back. */
static inline void check_any(const char *what, SluiceResult result)
{
    if (strcmp(sluiceResultString(result), "SLUICE_RESULT_UNKNOWN") == 0)
        fail_msg("%s: %d", what, (int)result);
}

#endif /* TESTS_NULL_ARGUMENTS_CALLS_H */
