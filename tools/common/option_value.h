/** Reads values of options, and describes valid ones. */
#ifndef TOOLS_COMMON_OPTION_VALUE_H
#define TOOLS_COMMON_OPTION_VALUE_H

#include "option_table.h"

/** Reads the value of an option. On failure returns false and leaves `*option->value` undefined. */
bool option_value_read(const struct option *option, const char *text);

/**
 * Writes a description of valid values: "a whole number from 1 to 8". For a choice, `text` (may be
 * empty) adds the nearest word. Returns `words`, which has room for `size` bytes.
 */
const char *option_value_wanted(const struct option *option, const char *text, char *words,
                                size_t size);

#endif /* TOOLS_COMMON_OPTION_VALUE_H */
