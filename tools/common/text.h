/**
 * Words that come from elsewhere, names of files among them, so that no terminal and no program
 * takes them for something else. Texts are UTF-8, or what claims to be.
 */
#ifndef TOOLS_COMMON_TEXT_H
#define TOOLS_COMMON_TEXT_H

#include <stdbool.h>
#include <stdio.h>

/**
 * For people: \n, \t, \x1b and \u202e stand for characters that move the cursor, change colors or
 * turn the direction of writing, \xff for a byte that is no UTF-8. Nothing else is changed.
 */
void text_write(FILE *out, const char *text);

/**
 * Whether all that was printed on stdout got there, which a full disk or a closed pipe may prevent;
 * if not, says so on stderr with `speaker` in front. To be asked before a program ends with
 * success.
 */
bool text_flush(const char *speaker);

/** Returns `status`, or EXIT_FAILURE instead of EXIT_SUCCESS if text_flush("") fails. */
int text_exit_status(int status);

/** A line on stderr, as printf makes it, written as above; at most 8 KiB of it. */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
void
text_say(const char *format, ...);

/** Calls `listen` with each line of text_say, from any thread and without its '\n'; NULL: nobody.
 *  No other thread may say anything during the call. */
void text_set_listener(void (*listen)(void *user_data, const char *line), void *user_data);

/**
 * A JSON string with its quotes; U+FFFD stands for bytes that are no UTF-8. No '<' is in it, so
 * that it ends no element of a web page that it is put into.
 */
void text_write_json(FILE *out, const char *text);

#endif /* TOOLS_COMMON_TEXT_H */
