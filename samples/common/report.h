/** A self-contained HTML page: headings, tables, plots as inline SVG, pictures inlined. */
#ifndef SAMPLES_COMMON_REPORT_H
#define SAMPLES_COMMON_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct report {
    struct output_file *output; ///< owned
    FILE *file;                 ///< file of `output`
};

/** Line of a plot. Non-finite values leave a gap; +infinity reaches the top. */
struct report_series {
    const char *name;
    const double *values; ///< one per frame
};

struct report_plot {
    const char *title, *unit;
    size_t value_count, series_count;
    const struct report_series *series;
    double maximum; ///< end of the axis; 0: the largest value
    double mark;    ///< frame of a vertical line; negative: none
    const char *mark_name;
};

/** Reports on stderr if the file cannot be written. */
bool report_begin(struct report *report, const char *path, const char *title);
void report_heading(struct report *report, const char *text);
/** Adds a paragraph. Escapes `text`. */
void report_text(struct report *report, const char *text);
/** Adds a paragraph in a fixed-width font. Escapes `text`. */
void report_code(struct report *report, const char *text);
/** Begins a table with rows of name, value, unit and meaning. `meaning` may be NULL. */
void report_begin_table(struct report *report);
void report_row(struct report *report, const char *name, const char *value, const char *unit,
                const char *meaning);
void report_end_table(struct report *report);
void report_plot(struct report *report, const struct report_plot *plot);

/** A bar whose length is its value relative to the largest. Its first part has another color. */
struct report_bar {
    const char *name;
    double value;     ///< NaN: leaves out the bar
    double first;     ///< 0 to value
    const char *text; ///< text behind the bar
};

void report_bars(struct report *report, const struct report_bar *bars, size_t count);
/** Begins pictures in a row that wraps. */
void report_begin_pictures(struct report *report);
/** Begins pictures in a row that does not wrap: pictures shrink if there is no room. */
void report_begin_row(struct report *report);
/** Inlines a PNG file. */
void report_picture(struct report *report, const char *png_path, const char *caption);
void report_end_pictures(struct report *report);
bool report_end(struct report *report);

#endif /* SAMPLES_COMMON_REPORT_H */
