/** What a program printed with --json: a figure per line. */
#ifndef SLUICE_TRADEOFF_FIGURES_H
#define SLUICE_TRADEOFF_FIGURES_H

#include <stdbool.h>
#include <stddef.h>

struct figure {
    char *name, *unit; ///< owned
    double value;      ///< NaN: null, or a text
    char *text;        ///< owned; NULL unless the value is a string
};

/** Zeroed is empty. */
struct figures {
    struct figure *items; ///< owned
    size_t count, capacity;
    size_t rubbish_count; ///< lines that were no figures and not empty
};

/**
 * Reads {"name": "x", "value": 1.5, "unit": "ms"}; the members may stand in any order, others are
 * passed over. False for anything else; then `figure` is empty.
 */
bool figure_parse(const char *line, struct figure *figure);
void figure_finish(struct figure *figure);

/** Lines that are no figures are counted. False with errno if the file cannot be read. */
bool figures_read(const char *path, struct figures *figures);
void figures_add(struct figures *figures, const char *name, double value, const char *unit);
/** The last one of that name. */
const struct figure *figures_find(const struct figures *figures, const char *name);
/** NaN if there is none. Infinite decibels count as 999, as the samples print them. */
double figures_value(const struct figures *figures, const char *name);
void figures_finish(struct figures *figures);

#endif /* SLUICE_TRADEOFF_FIGURES_H */
