/* memory, numbers and sorting. aligned_alloc since macOS 10.15. */
#ifndef MACOS_STUB_STDLIB_H
#define MACOS_STUB_STDLIB_H

#include <stddef.h>

_Noreturn void abort(void);
int abs(int value);
void *aligned_alloc(size_t alignment, size_t size);
void *bsearch(const void *key, const void *items, size_t count, size_t size,
              int (*compare)(const void *, const void *));
void *calloc(size_t count, size_t size);
_Noreturn void exit(int status);
void free(void *memory);
char *getenv(const char *name);
long long llabs(long long value);
void *malloc(size_t size);
void qsort(void *items, size_t count, size_t size, int (*compare)(const void *, const void *));
void *realloc(void *memory, size_t size);
char *realpath(const char *path, char *resolved);
double strtod(const char *text, char **end);
float strtof(const char *text, char **end);
long strtol(const char *text, char **end, int base);
unsigned long strtoul(const char *text, char **end, int base);
unsigned long long strtoull(const char *text, char **end, int base);

#endif /* MACOS_STUB_STDLIB_H */
