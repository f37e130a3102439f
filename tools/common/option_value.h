/** Values of options: reading them, and saying what they must be. */
#ifndef TOOLS_COMMON_OPTION_VALUE_H
#define TOOLS_COMMON_OPTION_VALUE_H

#include "option_table.h"

/** Reads a value of any kind that takes one. False leaves `*option->value` undefined. */
bool option_value_read(const struct option *option, const char *text);

/**
 * Writes what an option takes: "a whole number from 1 to 8". For a choice, `text` (may be empty)
 * adds the word that is nearest to it. Returns `words`, which has room for `size` bytes.
 */
const char *option_value_wanted(const struct option *option, const char *text, char *words,
                                size_t size);

#endif /* TOOLS_COMMON_OPTION_VALUE_H */
