/**
 * Finds an option in a --help text that tools/common/option_help.c or a like printer has written:
 * "  --name OPERAND   words over lines [default]".
 */
#ifndef SLUICE_TRADEOFF_HELP_TEXT_H
#define SLUICE_TRADEOFF_HELP_TEXT_H

#include <stdbool.h>

/** Parts of an option's entry; empty texts where there is nothing. */
struct help_entry {
    char *operand;       ///< "MIB"; owned
    char *meaning;       ///< in one line, without the default; owned
    char *default_value; ///< what stands in brackets at the end, not in parentheses; owned
};

/** False if the text has no such option; then `entry` is zeroed. */
bool help_text_find(const char *help, const char *name, struct help_entry *entry);
void help_entry_finish(struct help_entry *entry);

#endif /* SLUICE_TRADEOFF_HELP_TEXT_H */
