/**
 * Output of texts from elsewhere, such as file names, so that no terminal and no program
 * misinterprets them. Texts should be UTF-8 and may be anything.
 */
#ifndef TOOLS_COMMON_TEXT_H
#define TOOLS_COMMON_TEXT_H

#include <stdbool.h>
#include <stdio.h>

/**
 * Writes a text for people. Escapes characters that move the cursor, change colors or turn the
 * direction of writing, as \n, \t, \x1b and \u202e, and bytes that are not UTF-8 as \xff. Writes
 * all others as they are.
 */
void text_write(FILE *out, const char *text);

/**
 * Flushes stdout. Returns whether all output arrived, which a full disk or a closed pipe may
 * prevent. If not, reports it on stderr with the prefix `speaker`. Call before the program ends
 * with success.
 */
bool text_flush(const char *speaker);

/** Returns `status`, but EXIT_FAILURE instead of EXIT_SUCCESS if text_flush("") fails. */
int text_exit_status(int status);

/** Formats a line like printf, at most 8 KiB, and writes it to stderr with text_write. */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
void
text_say(const char *format, ...);

/** Sets a function that gets each line of text_say, without its '\n', on any thread. NULL: none.
 * Call while no other thread uses text_say. */
void text_set_listener(void (*listen)(void *user_data, const char *line), void *user_data);

/**
 * Writes a JSON string with its quotes. Replaces bytes that are not UTF-8 by U+FFFD. Escapes '<',
 * so that the string cannot end an HTML element.
 */
void text_write_json(FILE *out, const char *text);

#endif /* TOOLS_COMMON_TEXT_H */
