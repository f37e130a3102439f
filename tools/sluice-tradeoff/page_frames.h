/** Reads a run's folder: frames.csv, and pictures of some frames. The files are not trusted. */
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
    const char *names[PAGE_COLUMNS_MAX]; ///< not safe as file names or markup
    uint32_t column_count, row_count;
    double *cells; ///< owned; [row][column]; NaN: absent; may be infinite
};

enum page_read { PAGE_READ, PAGE_LEFT_OUT, PAGE_OUT_OF_MEMORY };

/**
 * Reads a whole file. The caller frees `bytes`, which ends with a NUL. If the file is left out, or
 * when out of memory, `bytes` is NULL and `reason` says why.
 */
enum page_read page_read_file(const char *folder, const char *name, uint8_t **bytes, size_t *size,
                              char reason[PAGE_REASON_SIZE]);

/**
 * Reads frames.csv. A damaged file is left out: `reason` says why, and `frames` is empty.
 */
enum page_read page_frames_init(struct page_frames *frames, const char *folder,
                                char reason[PAGE_REASON_SIZE]);
void page_frames_finish(struct page_frames *frames);

/** Returns a column's index, or -1 if there is none of that name. */
int page_frames_find(const struct page_frames *frames, const char *name);
/** Returns the cell in the row of `frame`, or NaN. `column` may be -1. */
double page_frames_get(const struct page_frames *frames, uint32_t frame, int column);

#endif /* SLUICE_TRADEOFF_PAGE_FRAMES_H */
