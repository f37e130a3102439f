/** Lists of names on the command line: --only fill,budget. */
#ifndef TOOLS_COMMON_CHOSEN_NAMES_H
#define TOOLS_COMMON_CHOSEN_NAMES_H

#include <stdbool.h>

/** Whether `list`, names with commas between them, has `name`. NULL has every name. */
bool names_have(const char *list, const char *name);

/** Whether `known` has every name of `list`. If not, says on stderr which one it lacks. */
bool names_are_known(const char *list, const char *known);

#endif /* TOOLS_COMMON_CHOSEN_NAMES_H */
