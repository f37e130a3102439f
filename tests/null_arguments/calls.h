/**
 * Shared by the generated tests. The including file defines `struct fixture`, whose member `out` is
 * zeroed before each call, and the two functions below.
 */
#ifndef TESTS_NULL_ARGUMENTS_CALLS_H
#define TESTS_NULL_ARGUMENTS_CALLS_H

#include "support/test.h"

#include <stdalign.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

struct fixture;

/** `f` is zeroed before. */
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
        fail_msg("%s: %s", what, sluiceGetResultName(result));
}

static inline void check_error(const char *what, SluiceResult result)
{
    if (result >= 0)
        fail_msg("%s: %s", what, sluiceGetResultName(result));
}

static inline void check_good(const char *what, SluiceResult result)
{
    if (result < 0)
        fail_msg("%s: %s", what, sluiceGetResultName(result));
}

/* Accepts any result: the call has returned. */
static inline void check_any(const char *what, SluiceResult result)
{
    if (strcmp(sluiceGetResultName(result), "SLUICE_RESULT_UNKNOWN") == 0)
        fail_msg("%s: %d", what, (int)result);
}

/** Values of structSize: this version's, the first release's, a newer version's, and wrong ones. */
enum sized_case {
    SIZED_PRESENT,
    SIZED_LEAST,
    SIZED_LARGER,  ///< extra bytes of a struct to read are 0
    SIZED_NEWER,   ///< to read: one of the extra bytes is not 0
    SIZED_SMALLER, ///< a byte less than the first release
    SIZED_EMPTY    ///< 0: not set by the caller
};

/** A struct with structSize, between guard bytes. */
struct sized {
    _Alignas(max_align_t) unsigned char bytes[4096];
    unsigned char before[4096];
    uint32_t known, given; ///< bytes in this version; value of structSize
    enum sized_case kind;
    bool read; ///< true: the call reads the struct; false: it writes it
};

enum { SIZED_EXTRA = 24, SIZED_UNTOUCHED = 0xa5 };

static inline struct sized sized_make(const void *from, size_t known, size_t least,
                                      enum sized_case kind, bool read)
{
    struct sized sized = {.known = (uint32_t)known, .kind = kind, .read = read};
    memset(sized.bytes, SIZED_UNTOUCHED, sizeof sized.bytes);
    memcpy(sized.bytes, from, known);
    switch (kind) {
    case SIZED_PRESENT: sized.given = (uint32_t)known; break;
    case SIZED_LEAST: sized.given = (uint32_t)least; break;
    case SIZED_LARGER:
    case SIZED_NEWER: sized.given = (uint32_t)known + SIZED_EXTRA; break;
    case SIZED_SMALLER: sized.given = (uint32_t)least - 1; break;
    case SIZED_EMPTY: sized.given = 0; break;
    }
    if (read && sized.given > known)
        memset(sized.bytes + known, 0, SIZED_EXTRA);
    if (kind == SIZED_NEWER)
        sized.bytes[known + SIZED_EXTRA - 1] = 1;
    memcpy(sized.bytes, &sized.given, sizeof sized.given);
    memcpy(sized.before, sized.bytes, sizeof sized.before);
    return sized;
}

/** Checks the result, and that only bytes below structSize were written. */
static inline void sized_check(const char *what, const struct sized *sized, SluiceResult result)
{
    static const char *const names[] = {"present", "least", "larger", "newer", "smaller", "empty"};
    const char *name = names[sized->kind];
    bool wrong = sized->kind == SIZED_SMALLER || sized->kind == SIZED_EMPTY;
    if (wrong                        ? result != SLUICE_ERROR_INVALID_ARGUMENT
        : sized->kind == SIZED_NEWER ? result != SLUICE_ERROR_UNSUPPORTED
                                     : result < 0)
        fail_msg("%s, %s structSize %u: %s", what, name, sized->given, sluiceGetResultName(result));
    uint32_t end = sized->read || result < 0 ? 0 : sized->given;
    if (memcmp(sized->bytes, &sized->given, sizeof sized->given) != 0)
        fail_msg("%s, %s: structSize has changed", what, name);
    if (memcmp(sized->bytes + end, sized->before + end, sizeof sized->bytes - end) != 0)
        fail_msg("%s, %s: a byte beyond structSize %u was written", what, name, end);
    for (uint32_t i = sized->known; i < end; i++)
        if (sized->bytes[i])
            fail_msg("%s, %s: byte %u, which no field has, is %u", what, name, i, sized->bytes[i]);
}

#endif /* TESTS_NULL_ARGUMENTS_CALLS_H */
