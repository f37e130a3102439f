/** Finds the known word that a user may have meant. */
#ifndef TOOLS_COMMON_NEAREST_H
#define TOOLS_COMMON_NEAREST_H

#include <stddef.h>

/** Best candidate so far. Set the typed word, and zero the rest. */
struct nearest {
    const char *word;
    size_t word_length;
    const char *best; ///< NULL: no candidate is similar; not terminated
    size_t best_length;
    unsigned distance;
};

/** Compares with a candidate. The first of several equally near ones is kept. */
void nearest_try(struct nearest *nearest, const char *candidate, size_t length);

/**
 * Writes "; did you mean PREFIX and the best candidate?", or an empty text without a candidate.
 * `text` has room for `size` bytes. Returns `text`.
 */
const char *nearest_question(const struct nearest *nearest, const char *prefix, char *text,
                             size_t size);

#endif /* TOOLS_COMMON_NEAREST_H */
