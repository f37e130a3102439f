/**
 * Memory and texts of a program that ends when there is none left: it says so and exits with 1.
 * Runs that are complete stay in their folders, so nothing that was measured is lost.
 */
#ifndef SLUICE_TRADEOFF_MEMORY_H
#define SLUICE_TRADEOFF_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Zeroed; to be freed. */
void *memory_take(size_t count, size_t size);
/** As realloc; what is new is not zeroed. */
void *memory_grow(void *block, size_t count, size_t size);
char *memory_copy_text(const char *text);
/** As printf makes it; to be freed. */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
char *
memory_text(const char *format, ...);

/** A growing list of texts, for one a command line. Zeroed is empty. */
struct text_list {
    char **items; ///< owned; NULL stands behind the last one
    size_t count, capacity;
};

/** Copies `text`. */
void text_list_add(struct text_list *list, const char *text);
void text_list_add_all(struct text_list *list, const struct text_list *more);
/** Adds the parts of a text that `separator` separates, empty ones too. */
void text_list_add_parts(struct text_list *list, const char *text, char separator);
/** With spaces between, quoted for a shell where need be; to be freed. */
char *text_list_join(const struct text_list *list);
void text_list_finish(struct text_list *list);

#endif /* SLUICE_TRADEOFF_MEMORY_H */
