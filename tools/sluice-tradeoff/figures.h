/** Figures that a program prints with --json, one per line. */
#ifndef SLUICE_TRADEOFF_FIGURES_H
#define SLUICE_TRADEOFF_FIGURES_H

#include <stdbool.h>
#include <stddef.h>

struct figure {
    char *name, *unit; ///< owned
    double value;      ///< NaN: null, or the value is a text
    char *text;        ///< owned; NULL unless the value is a string
};

/** Zeroed is empty. */
struct figures {
    struct figure *items; ///< owned
    size_t count, capacity;
    size_t rubbish_count; ///< non-empty lines that are no figures
};

/**
 * Reads {"name": "x", "value": 1.5, "unit": "ms"}. Members may have any order; others are ignored.
 * Returns false for any other line; `figure` is empty then.
 */
bool figure_parse(const char *line, struct figure *figure);
void figure_finish(struct figure *figure);

/** Reads a file, and counts lines that are no figures. Returns false and sets errno if the file
 * cannot be read. */
bool figures_read(const char *path, struct figures *figures);
void figures_add(struct figures *figures, const char *name, double value, const char *unit);
/** Returns the last figure of that name. */
const struct figure *figures_find(const struct figures *figures, const char *name);
/** Returns NaN if there is no such figure. Infinite decibels are 999, as the samples print them. */
double figures_value(const struct figures *figures, const char *name);
void figures_finish(struct figures *figures);

#endif /* SLUICE_TRADEOFF_FIGURES_H */
