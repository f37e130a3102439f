/**
 * Finds an option in the --help text of tools/common/option_help.c or a similar printer: "  --name
 * OPERAND   words over lines [default]".
 */
#ifndef SLUICE_TRADEOFF_HELP_TEXT_H
#define SLUICE_TRADEOFF_HELP_TEXT_H

#include <stdbool.h>

/** Parts of an option's entry. Absent parts are empty texts. */
struct help_entry {
    char *operand;       ///< "MIB"; owned
    char *meaning;       ///< in one line, without the default; owned
    char *default_value; ///< text in the brackets at the end; parentheses do not count; owned
};

/** Returns false if the text lacks the option; `entry` is zeroed then. */
bool help_text_find(const char *help, const char *name, struct help_entry *entry);
void help_entry_finish(struct help_entry *entry);

#endif /* SLUICE_TRADEOFF_HELP_TEXT_H */
