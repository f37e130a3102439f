#include "frames.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../sluice-replay/file.h"
#include "memory.h"

static double cell_value(const char *cell)
{
    char *end;
    double value = strtod(cell, &end);
    return end != cell && *end == '\0' ? value : NAN;
}

static void add_row(struct frames *frames, const char *line, size_t *capacity)
{
    struct text_list cells = {0};
    if (frames->row_count == *capacity) {
        *capacity = *capacity ? 2 * *capacity : 64;
        frames->values =
            memory_grow(frames->values, *capacity, frames->column_count * sizeof *frames->values);
    }
    double *row = frames->values + frames->row_count * frames->column_count;
    text_list_add_parts(&cells, line, ',');
    for (size_t i = 0; i < frames->column_count; i++)
        row[i] = i < cells.count ? cell_value(cells.items[i]) : NAN;
    frames->row_count++;
    text_list_finish(&cells);
}

bool frames_read(const char *path, struct frames *frames)
{
    char *text;
    size_t size, capacity = 0;
    *frames = (struct frames){0};
    if (!read_file(path, &text, &size))
        return false;
    for (char *line = text; line < text + size;) {
        char *end = line + strcspn(line, "\r\n");
        char *next = end + strcspn(end, "\n") + 1;
        *end = '\0';
        if (*line && !frames->names) {
            struct text_list names = {0};
            text_list_add_parts(&names, line, ',');
            frames->names = names.items;
            frames->column_count = names.count;
        } else if (*line) {
            add_row(frames, line, &capacity);
        }
        line = next;
    }
    free(text);
    return true;
}

int frames_column(const struct frames *frames, const char *name)
{
    for (size_t i = 0; i < frames->column_count; i++)
        if (strcmp(frames->names[i], name) == 0)
            return (int)i;
    return -1;
}

static double cell(const struct frames *frames, size_t row, int column)
{
    return column < 0 ? NAN : frames->values[row * frames->column_count + (size_t)column];
}

/* Computes the mean over the frames that have the value. */
static double mean_of(const struct frames *frames, const char *name)
{
    int column = frames_column(frames, name);
    double sum = 0.0, count = 0.0;
    for (size_t row = 0; row < frames->row_count; row++)
        if (!isnan(cell(frames, row, column))) {
            sum += cell(frames, row, column);
            count++;
        }
    return sum / count;
}

/* Averages squared errors, because decibels do not add up. Equal frames have an error of 0. */
static double mean_psnr(const struct frames *frames)
{
    int column = frames_column(frames, "psnr_db");
    double sum = 0.0, count = 0.0;
    for (size_t row = 0; row < frames->row_count; row++)
        if (!isnan(cell(frames, row, column))) {
            sum += cell(frames, row, column) >= 999.0 ? 0.0
                                                      : pow(10.0, -0.1 * cell(frames, row, column));
            count++;
        }
    return count == 0.0 ? NAN : sum == 0.0 ? 999.0 : -10.0 * log10(sum / count);
}

static double missing_percent(const struct frames *frames)
{
    int missing = frames_column(frames, "missing_pixels");
    int sampled = frames_column(frames, "sampled_pixels");
    double sum = 0.0, count = 0.0;
    for (size_t row = 0; row < frames->row_count; row++) {
        double share = cell(frames, row, missing) / cell(frames, row, sampled);
        if (isfinite(share)) {
            sum += 100.0 * share;
            count++;
        }
    }
    return sum / count;
}

static void add_missing(struct figures *figures, const char *name, double value, const char *unit)
{
    if (!isnan(value) && isnan(figures_value(figures, name)))
        figures_add(figures, name, value, unit);
}

void frames_derive(const struct frames *frames, struct figures *figures)
{
    add_missing(figures, "psnr_mean_db", mean_psnr(frames), "dB");
    add_missing(figures, "ssim_mean", mean_of(frames, "ssim"), "");
    add_missing(figures, "flip_mean", mean_of(frames, "flip"), "");
    add_missing(figures, "missing_pixels_percent", missing_percent(frames), "%");
}

void frames_finish(struct frames *frames)
{
    for (size_t i = 0; i < frames->column_count; i++)
        free(frames->names[i]);
    free(frames->names);
    free(frames->values);
    *frames = (struct frames){0};
}
