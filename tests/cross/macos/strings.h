/* comparisons without case */
#ifndef MACOS_STUB_STRINGS_H
#define MACOS_STUB_STRINGS_H

#include <stddef.h>

int strcasecmp(const char *a, const char *b);
int strncasecmp(const char *a, const char *b, size_t size);

#endif /* MACOS_STUB_STRINGS_H */
