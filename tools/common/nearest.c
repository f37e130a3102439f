#include "nearest.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define LONGEST 40u

static unsigned least_of(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

/* Returns the number of insertions, deletions, replacements and swaps of neighbors that turn one
 * word into the other. */
static unsigned edit_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    unsigned cost[LONGEST + 1][LONGEST + 1];
    for (unsigned i = 0; i <= a_length; i++)
        for (unsigned j = 0; j <= b_length; j++) {
            if (i == 0 || j == 0) {
                cost[i][j] = i + j;
                continue;
            }
            unsigned replaced = cost[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            cost[i][j] = least_of(replaced, 1 + least_of(cost[i - 1][j], cost[i][j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                cost[i][j] = least_of(cost[i][j], cost[i - 2][j - 2] + 1);
        }
    return cost[a_length][b_length];
}

/* Matches "threads" in "loader-threads". Such a pair counts as two typing errors. */
static bool begins_or_ends_with(const char *whole, size_t whole_length, const char *part,
                                size_t part_length)
{
    return part_length >= 4 && part_length < whole_length &&
           (memcmp(whole, part, part_length) == 0 ||
            memcmp(whole + whole_length - part_length, part, part_length) == 0);
}

void nearest_try(struct nearest *nearest, const char *candidate, size_t length)
{
    const char *word = nearest->word;
    size_t word_length = nearest->word_length;
    if (word_length > LONGEST || length > LONGEST || word_length == 0)
        return;
    unsigned distance = edit_distance(word, word_length, candidate, length);
    unsigned most = 1 + (unsigned)(word_length < length ? word_length : length) / 4;
    if (begins_or_ends_with(word, word_length, candidate, length) ||
        begins_or_ends_with(candidate, length, word, word_length))
        distance = least_of(distance, 2);
    else if (distance > most || distance >= length)
        return;
    if (nearest->best && nearest->distance <= distance)
        return;
    nearest->best = candidate;
    nearest->best_length = length;
    nearest->distance = distance;
}

const char *nearest_question(const struct nearest *nearest, const char *prefix, char *text,
                             size_t size)
{
    *text = '\0';
    if (nearest->best)
        snprintf(text, size, "; did you mean %s%.*s?", prefix, (int)nearest->best_length,
                 nearest->best);
    return text;
}
