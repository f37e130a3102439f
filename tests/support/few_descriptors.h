/** A program that has hardly any file descriptors left. */
#ifndef TESTS_SUPPORT_FEW_DESCRIPTORS_H
#define TESTS_SUPPORT_FEW_DESCRIPTORS_H

#include <assert.h>
#include <sys/resource.h>
#include <unistd.h>

#define FEW_DESCRIPTORS_LIMIT 64

struct few_descriptors {
    struct rlimit before;
    int taken[FEW_DESCRIPTORS_LIMIT];
    int count;
};

/** Lowers the soft limit to 64 and takes all descriptors below it but `left`. */
static inline void few_descriptors_begin(struct few_descriptors *few, int left)
{
    int result = getrlimit(RLIMIT_NOFILE, &few->before);
    struct rlimit lower = {FEW_DESCRIPTORS_LIMIT, few->before.rlim_max};
    assert(result == 0);
    result = setrlimit(RLIMIT_NOFILE, &lower);
    assert(result == 0);
    (void)result;
    few->count = 0;
    for (int taken; (taken = dup(STDERR_FILENO)) >= 0;)
        few->taken[few->count++] = taken;
    assert(few->count >= left);
    while (left-- > 0)
        close(few->taken[--few->count]);
}

static inline void few_descriptors_end(struct few_descriptors *few)
{
    while (few->count > 0)
        close(few->taken[--few->count]);
    setrlimit(RLIMIT_NOFILE, &few->before);
}

#endif /* TESTS_SUPPORT_FEW_DESCRIPTORS_H */
