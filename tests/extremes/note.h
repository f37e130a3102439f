/** Shared by tests of extremes: a line for the table of results, and a long form. */
#ifndef TESTS_EXTREMES_NOTE_H
#define TESTS_EXTREMES_NOTE_H

#include "support/test.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/** Prints "# extremes: name | cases | worst | bound". */
static inline void note(const char *name, uint64_t cases, double worst, double bound)
{
    print_message("# extremes: %s | %llu | %.6g | %.6g\n", name, (unsigned long long)cases, worst,
                  bound);
}

/** Returns whether the program was started with --long. */
static inline bool is_long(int argc, char **argv)
{
    return argc > 1 && strcmp(argv[1], "--long") == 0;
}

/** Returns the resident memory of the process in bytes. Returns 0 if unknown, and under sanitizers,
 * which keep freed memory. */
static inline uint64_t resident_size(void)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return 0;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    return 0;
#endif
#endif
    unsigned long long all, resident;
    FILE *file = fopen("/proc/self/statm", "r");
    int found = file ? fscanf(file, "%llu %llu", &all, &resident) : 0;
    if (file)
        fclose(file);
    return found == 2 ? resident * 4096 : 0;
}

#endif /* TESTS_EXTREMES_NOTE_H */
