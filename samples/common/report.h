/** A self-contained HTML page: headings, tables, plots as inline SVG, pictures inlined. */
#ifndef SAMPLES_COMMON_REPORT_H
#define SAMPLES_COMMON_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct report {
    struct output_file *output; ///< Owned.
    FILE *file;                 ///< Of `output`.
};

/** One line of a plot. Values that are not finite leave a gap, +infinity touches the top. */
struct report_series {
    const char *name;
    const double *values; ///< one per frame
};

struct report_plot {
    const char *title, *unit;
    size_t value_count, series_count;
    const struct report_series *series;
    double maximum; ///< of the axis; 0: the largest value
    double mark;    ///< a vertical line at this frame, unless negative
    const char *mark_name;
};

/** Says on stderr if the file cannot be written. */
bool report_begin(struct report *report, const char *path, const char *title);
void report_heading(struct report *report, const char *text);
/** A paragraph; `text` is escaped. */
void report_text(struct report *report, const char *text);
/** The same in fixed-width letters. */
void report_code(struct report *report, const char *text);
/** Rows of name, value, unit, and what it means, which may be NULL. */
void report_begin_table(struct report *report);
void report_row(struct report *report, const char *name, const char *value, const char *unit,
                const char *meaning);
void report_end_table(struct report *report);
void report_plot(struct report *report, const struct report_plot *plot);

/** A bar as long as its value beside the largest; the first part of it is in another color. */
struct report_bar {
    const char *name;
    double value;     ///< NaN: the bar is left out
    double first;     ///< 0 to value
    const char *text; ///< behind it
};

void report_bars(struct report *report, const struct report_bar *bars, size_t count);
/** Pictures stand beside each other between begin and end. */
void report_begin_pictures(struct report *report);
/** The same, and they stay beside each other, smaller if there is no room. */
void report_begin_row(struct report *report);
/** Inlines a PNG file. */
void report_picture(struct report *report, const char *png_path, const char *caption);
void report_end_pictures(struct report *report);
bool report_end(struct report *report);

#endif /* SAMPLES_COMMON_REPORT_H */
