/* memory and strings. macOS has no mempcpy, memrchr and strchrnul; memmem and strlcpy are there. */
#ifndef MACOS_STUB_STRING_H
#define MACOS_STUB_STRING_H

#include <stddef.h>

void *memchr(const void *memory, int value, size_t size);
int memcmp(const void *a, const void *b, size_t size);
void *memcpy(void *restrict to, const void *restrict from, size_t size);
void *memmove(void *to, const void *from, size_t size);
void *memset(void *memory, int value, size_t size);
char *strchr(const char *text, int letter);
int strcmp(const char *a, const char *b);
size_t strcspn(const char *text, const char *set);
char *strerror(int error);
size_t strlen(const char *text);
int strncmp(const char *a, const char *b, size_t size);
char *strncat(char *restrict to, const char *restrict from, size_t size);
char *strncpy(char *restrict to, const char *restrict from, size_t size);
char *strpbrk(const char *text, const char *set);
char *strrchr(const char *text, int letter);
size_t strspn(const char *text, const char *set);
char *strstr(const char *text, const char *part);

#endif /* MACOS_STUB_STRING_H */
