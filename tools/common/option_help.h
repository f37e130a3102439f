/** Help text of a table of options. */
#ifndef TOOLS_COMMON_OPTION_HELP_H
#define TOOLS_COMMON_OPTION_HELP_H

#include "option_table.h"

#include <stdio.h>

/**
 * Prints usage, a row "  --name OPERAND  words [default]" for each option, and notes. A default
 * that cannot be typed is in parentheses.
 */
void option_help_print(const struct option_table *table, FILE *out);

#endif /* TOOLS_COMMON_OPTION_HELP_H */
