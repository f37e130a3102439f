/** Lists of names on the command line: --only fill,budget. */
#ifndef TOOLS_COMMON_CHOSEN_NAMES_H
#define TOOLS_COMMON_CHOSEN_NAMES_H

#include <stdbool.h>

/** Returns whether `list`, comma-separated names, has `name`. A list of NULL has every name. */
bool names_have(const char *list, const char *name);

/** Returns whether `known` has every name of `list`. Reports the first unknown name on stderr. */
bool names_are_known(const char *list, const char *known);

#endif /* TOOLS_COMMON_CHOSEN_NAMES_H */
