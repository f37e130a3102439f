#define _POSIX_C_SOURCE 200809L
#include "page_series.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "page_frames.h"
#include "page_json.h"

#define NAME_SIZE_MAX 64

static uint32_t bin_step(uint32_t rows)
{
    return (rows + PAGE_BINS_MAX - 1) / PAGE_BINS_MAX;
}

/* Returns the extreme of the rows first .. first + step. NaN if no row has a value. */
static double extreme(const struct page_frames *frames, uint32_t column, uint32_t first,
                      uint32_t step, bool least)
{
    double found = NAN;
    for (uint32_t row = first; row < frames->row_count && row - first < step; row++) {
        double value = frames->cells[(size_t)row * frames->column_count + column];
        found = least ? fmin(found, value) : fmax(found, value);
    }
    return found;
}

static void put_bins(FILE *file, const struct page_frames *frames, uint32_t column, bool least)
{
    uint32_t step = bin_step(frames->row_count);
    fprintf(file, ",\"%s\":[", least ? "least" : "most");
    for (uint32_t row = 0; row < frames->row_count; row += step) {
        fputs(row > 0 ? "," : "", file);
        page_put_number(file, extreme(frames, column, row, step, least));
    }
    fputc(']', file);
}

static bool is_shown(const struct page_frames *frames, uint32_t column)
{
    return strcmp(frames->names[column], "frame") != 0 &&
           strlen(frames->names[column]) < NAME_SIZE_MAX;
}

/* Returns an upper bound, because a run's size is counted before it is written. */
static size_t size_bound(const struct page_frames *frames)
{
    size_t parts = bin_step(frames->row_count) > 1 ? 2 : 1;
    size_t column = PAGE_BINS_MAX * parts * (PAGE_NUMBER_SIZE + 1) + 6 * NAME_SIZE_MAX + 64;
    return frames->column_count * column + 128;
}

static void put_run(FILE *file, uint32_t point, const struct page_frames *frames)
{
    bool first = true;
    fprintf(file, "{\"point\":%" PRIu32 ",\"frames\":%" PRIu32 ",\"step\":%" PRIu32, point,
            frames->row_count, bin_step(frames->row_count));
    fputs(",\"columns\":[", file);
    for (uint32_t i = 0; i < frames->column_count; i++) {
        if (!is_shown(frames, i))
            continue;
        fputs(first ? "{\"name\":" : ",\n{\"name\":", file);
        page_put_text(file, frames->names[i]);
        put_bins(file, frames, i, false);
        if (bin_step(frames->row_count) > 1)
            put_bins(file, frames, i, true);
        fputc('}', file);
        first = false;
    }
    fputs("]}", file);
}

static void put_left_out(FILE *file, bool *first, uint32_t point, const char *why)
{
    fprintf(file, "%s{\"point\":%" PRIu32 ",\"why\":", *first ? "" : ",\n", point);
    page_put_text(file, why);
    fputc('}', file);
    *first = false;
}

/* Writes the runs. Collects reasons in memory, because they follow the runs. */
static bool put_runs(FILE *file, FILE *reasons, const struct sweep *sweep,
                     const struct page_choice *choices, uint32_t choice_count, size_t size_max)
{
    bool first_run = true, first_reason = true;
    for (uint32_t i = 0; i < choice_count; i++) {
        struct page_frames frames;
        char why[PAGE_REASON_SIZE];
        uint32_t point = choices[i].point;
        enum page_read read = page_frames_init(&frames, sweep->points[point].folder, why);
        if (read == PAGE_OUT_OF_MEMORY)
            return false;
        if (read == PAGE_READ && size_bound(&frames) > size_max) {
            snprintf(why, sizeof why, "the page has no room for it");
            read = PAGE_LEFT_OUT;
        }
        if (read == PAGE_READ) {
            long before = ftell(file);
            fputs(first_run ? "" : ",\n", file);
            put_run(file, point, &frames);
            size_max -= (size_t)(ftell(file) - before);
            first_run = false;
        } else {
            put_left_out(reasons, &first_reason, point, why);
        }
        page_frames_finish(&frames);
    }
    return true;
}

bool page_put_series(FILE *file, const struct sweep *sweep, const struct page_choice *choices,
                     uint32_t choice_count, size_t size_max)
{
    char *text = NULL;
    size_t size = 0;
    FILE *reasons = open_memstream(&text, &size);
    if (!reasons)
        return false;
    fputs("{\"runs\":[", file);
    bool enough_memory = put_runs(file, reasons, sweep, choices, choice_count, size_max);
    enough_memory = fclose(reasons) == 0 && enough_memory;
    if (enough_memory)
        fprintf(file, "],\n\"left_out\":[%s]}\n", text);
    free(text);
    return enough_memory;
}
