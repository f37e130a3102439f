/** Small pictures of the first launches side by side: how the picture fills. */
#ifndef SAMPLES_COMMON_CONTACT_SHEET_H
#define SAMPLES_COMMON_CONTACT_SHEET_H

#include "picture.h"

#define CONTACT_SHEET_COLUMNS 4u
#define CONTACT_SHEET_ROWS 3u
#define CONTACT_SHEET_CELLS (CONTACT_SHEET_COLUMNS * CONTACT_SHEET_ROWS)

/** Zeroed is empty. */
struct contact_sheet {
    bool marks_missing;                  ///< pixels that are not complete are magenta
    uint32_t cell_width, cell_height;    ///< pixels of a small picture
    uint32_t count;                      ///< small pictures so far
    uint8_t *cells[CONTACT_SHEET_CELLS]; ///< owned; RGBA, with the caption below
};

/** Returns whether there is room for one more small picture besides the last. */
bool contact_sheet_has_room(const struct contact_sheet *sheet);
/**
 * Adds a small picture. If there is no room, it replaces the last one. Reports on stderr when out
 * of memory.
 */
bool contact_sheet_add(struct contact_sheet *sheet, const struct picture *picture, double exposure,
                       const char *caption);
/** Reports errors on stderr. */
bool contact_sheet_write(const struct contact_sheet *sheet, const char *path);
void contact_sheet_finish(struct contact_sheet *sheet);

#endif /* SAMPLES_COMMON_CONTACT_SHEET_H */
