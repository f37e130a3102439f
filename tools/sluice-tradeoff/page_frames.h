/** What a run left in its folder: frames.csv, and pictures of some frames. All of it is outside. */
#ifndef SLUICE_TRADEOFF_PAGE_FRAMES_H
#define SLUICE_TRADEOFF_PAGE_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PAGE_FILE_SIZE_MAX (16u << 20) ///< bytes; larger files are left out
#define PAGE_COLUMNS_MAX 48
#define PAGE_REASON_SIZE 160

/** A table of numbers with named columns. Zeroed is empty. */
struct page_frames {
    char *text;                          ///< owned; the names are in it
    const char *names[PAGE_COLUMNS_MAX]; ///< not of use as file names or markup as they are
    uint32_t column_count, row_count;
    double *cells; ///< [row][column], owned; NaN where the file has nothing, infinity is possible
};

enum page_read { PAGE_READ, PAGE_LEFT_OUT, PAGE_OUT_OF_MEMORY };

/**
 * Reads a whole file. `bytes` is for the caller to free and has a NUL behind it. If it is left out,
 * or memory is, `bytes` is NULL and `reason` says why.
 */
enum page_read page_read_file(const char *folder, const char *name, uint8_t **bytes, size_t *size,
                              char reason[PAGE_REASON_SIZE]);

/**
 * Reads frames.csv. A file that is damaged anywhere is left out, `reason` says why, and `frames` is
 * empty.
 */
enum page_read page_frames_init(struct page_frames *frames, const char *folder,
                                char reason[PAGE_REASON_SIZE]);
void page_frames_finish(struct page_frames *frames);

/** Index of a column, -1 if there is none of that name. */
int page_frames_find(const struct page_frames *frames, const char *name);
/** Of the row whose `frame` is that, or NaN. `column` may be -1. */
double page_frames_get(const struct page_frames *frames, uint32_t frame, int column);

#endif /* SLUICE_TRADEOFF_PAGE_FRAMES_H */
