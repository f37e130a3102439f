/**
 * Allocation that cannot fail: without memory the program prints a message and exits with 1.
 * Complete runs stay in their folders, so no measurement is lost.
 */
#ifndef SLUICE_TRADEOFF_MEMORY_H
#define SLUICE_TRADEOFF_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Returns zeroed memory. The caller frees it. */
void *memory_take(size_t count, size_t size);
/** Resizes a block like realloc. New bytes are not zeroed. */
void *memory_grow(void *block, size_t count, size_t size);
char *memory_copy_text(const char *text);
/** Formats a text like printf. The caller frees it. */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
char *
memory_text(const char *format, ...);

/** A growing list of texts, such as a command line. A zeroed struct is empty. */
struct text_list {
    char **items; ///< owned; NULL after the last one
    size_t count, capacity;
};

/** Copies `text`. */
void text_list_add(struct text_list *list, const char *text);
void text_list_add_all(struct text_list *list, const struct text_list *more);
/** Splits a text at `separator`, and adds all parts, including empty ones. */
void text_list_add_parts(struct text_list *list, const char *text, char separator);
/** Joins with spaces; quotes for a shell where necessary. The caller frees the text. */
char *text_list_join(const struct text_list *list);
void text_list_finish(struct text_list *list);

#endif /* SLUICE_TRADEOFF_MEMORY_H */
