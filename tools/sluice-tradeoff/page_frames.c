#define _POSIX_C_SOURCE 200809L
#include "page_frames.h"

#include "../common/input.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static FILE *open_file(const char *folder, const char *name, size_t *size,
                       char reason[PAGE_REASON_SIZE], enum page_read *result)
{
    struct stat info;
    size_t path_size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(path_size);
    if (!path) {
        *result = PAGE_OUT_OF_MEMORY;
        return NULL;
    }
    snprintf(path, path_size, "%s/%s", folder, name);
    FILE *file = NULL;
    if (stat(path, &info) != 0)
        snprintf(reason, PAGE_REASON_SIZE, "%s: %s", name, strerror(errno));
    else if (!S_ISREG(info.st_mode))
        snprintf(reason, PAGE_REASON_SIZE, "%s is no file", name);
    else if (info.st_size > (off_t)PAGE_FILE_SIZE_MAX)
        snprintf(reason, PAGE_REASON_SIZE, "%s is larger than %u MiB", name,
                 PAGE_FILE_SIZE_MAX >> 20);
    else if (!(file = input_open(path)))
        snprintf(reason, PAGE_REASON_SIZE, "%s: %s", name, strerror(errno));
    *size = file ? (size_t)info.st_size : 0;
    *result = file ? PAGE_READ : PAGE_LEFT_OUT;
    free(path);
    return file;
}

enum page_read page_read_file(const char *folder, const char *name, uint8_t **bytes, size_t *size,
                              char reason[PAGE_REASON_SIZE])
{
    enum page_read result;
    *bytes = NULL;
    FILE *file = open_file(folder, name, size, reason, &result);
    if (file) {
        *bytes = malloc(*size + 1);
        if (!*bytes) {
            result = PAGE_OUT_OF_MEMORY;
        } else if (fread(*bytes, 1, *size, file) != *size) {
            snprintf(reason, PAGE_REASON_SIZE, "%s could not be read", name);
            free(*bytes);
            *bytes = NULL;
            result = PAGE_LEFT_OUT;
        } else {
            (*bytes)[*size] = '\0';
        }
        fclose(file);
    }
    if (result == PAGE_OUT_OF_MEMORY)
        snprintf(reason, PAGE_REASON_SIZE, "out of memory");
    return result;
}

/* Takes the first line from the text and cuts its end. Returns NULL after the last line. */
static char *take_line(char **text)
{
    char *line = *text;
    if (!line || *line == '\0')
        return NULL;
    char *end = strchr(line, '\n');
    *text = end ? end + 1 : NULL;
    if (end)
        *end = '\0';
    size_t length = strlen(line);
    if (length > 0 && line[length - 1] == '\r')
        line[length - 1] = '\0';
    return line;
}

static bool take_names(struct page_frames *frames, char *line, char reason[PAGE_REASON_SIZE])
{
    for (char *name = line; name;) {
        char *comma = strchr(name, ',');
        if (comma)
            *comma = '\0';
        if (frames->column_count == PAGE_COLUMNS_MAX) {
            snprintf(reason, PAGE_REASON_SIZE, "frames.csv has more than %d columns",
                     PAGE_COLUMNS_MAX);
            return false;
        }
        frames->names[frames->column_count++] = name;
        name = comma ? comma + 1 : NULL;
    }
    return true;
}

/* Parses a line of cells. Each is a number or empty. */
static bool take_cells(double *cells, uint32_t count, const char *line)
{
    for (uint32_t i = 0; i < count; i++) {
        char *end = NULL;
        cells[i] = *line == ',' || *line == '\0' ? NAN : strtod(line, &end);
        if (end == line)
            return false;
        line = end ? end : line;
        if (*line != (i + 1 < count ? ',' : '\0'))
            return false;
        line++;
    }
    return true;
}

static size_t count_lines(const char *text)
{
    size_t count = 0;
    for (; text && *text; count++) {
        text = strchr(text, '\n');
        text = text ? text + 1 : NULL;
    }
    return count;
}

static enum page_read take_rows(struct page_frames *frames, char *text,
                                char reason[PAGE_REASON_SIZE])
{
    /* Does not overflow, because the file's size limits lines and columns. */
    frames->cells = malloc((count_lines(text) + 1) * frames->column_count * sizeof *frames->cells);
    if (!frames->cells) {
        snprintf(reason, PAGE_REASON_SIZE, "out of memory");
        return PAGE_OUT_OF_MEMORY;
    }
    for (char *line; (line = take_line(&text)); frames->row_count++) {
        double *row = frames->cells + (size_t)frames->row_count * frames->column_count;
        if (!take_cells(row, frames->column_count, line)) {
            snprintf(reason, PAGE_REASON_SIZE, "line %u of frames.csv is not %u numbers",
                     frames->row_count + 2, frames->column_count);
            return PAGE_LEFT_OUT;
        }
    }
    if (frames->row_count == 0) {
        snprintf(reason, PAGE_REASON_SIZE, "frames.csv has no frames");
        return PAGE_LEFT_OUT;
    }
    return PAGE_READ;
}

enum page_read page_frames_init(struct page_frames *frames, const char *folder,
                                char reason[PAGE_REASON_SIZE])
{
    memset(frames, 0, sizeof *frames);
    uint8_t *bytes;
    size_t size;
    enum page_read result = page_read_file(folder, "frames.csv", &bytes, &size, reason);
    if (result != PAGE_READ)
        return result;
    frames->text = (char *)bytes;
    char *text = frames->text, *line = take_line(&text);
    if (!line) {
        snprintf(reason, PAGE_REASON_SIZE, "frames.csv is empty");
        result = PAGE_LEFT_OUT;
    } else {
        result = take_names(frames, line, reason) ? take_rows(frames, text, reason) : PAGE_LEFT_OUT;
    }
    if (result != PAGE_READ)
        page_frames_finish(frames);
    return result;
}

void page_frames_finish(struct page_frames *frames)
{
    free(frames->text);
    free(frames->cells);
    memset(frames, 0, sizeof *frames);
}

int page_frames_find(const struct page_frames *frames, const char *name)
{
    for (uint32_t i = 0; i < frames->column_count; i++)
        if (strcmp(frames->names[i], name) == 0)
            return (int)i;
    return -1;
}

double page_frames_get(const struct page_frames *frames, uint32_t frame, int column)
{
    int frame_column = page_frames_find(frames, "frame");
    for (uint32_t row = 0; row < frames->row_count && column >= 0; row++) {
        const double *cells = frames->cells + (size_t)row * frames->column_count;
        if (frame_column >= 0 ? cells[frame_column] == (double)frame : row == frame)
            return cells[column];
    }
    return NAN;
}
