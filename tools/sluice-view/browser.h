/**
 * State of the file browser: a folder, the files in it that the viewer reads, and a filter of
 * words. A second list has places: recent files, scenes that come with the viewer, and scenes
 * beside the shown one.
 */
#ifndef SLUICE_VIEW_BROWSER_H
#define SLUICE_VIEW_BROWSER_H

#include "../common/files.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BROWSER_PATH 4096u

struct browser_entry {
    char *name; ///< owned
    uint64_t size;
    bool is_folder;
};

enum browser_place_kind { PLACE_RECENT, PLACE_SHIPPED, PLACE_BESIDE };

struct browser_place {
    enum browser_place_kind kind;
    char *path; ///< owned; "": the room of computed pictures
    bool is_missing;
};

enum browser_side { BROWSER_FILES, BROWSER_PLACES };

struct browser {
    char folder[BROWSER_PATH]; ///< absolute
    char problem[512];         ///< why the folder cannot be shown; "": it can
    struct browser_entry *entries;
    size_t entry_count, entry_capacity;
    uint32_t *shown; ///< indices of entries that match the filter
    uint32_t shown_count;
    struct browser_place *places;
    uint32_t place_count;
    char filter[256];
    enum browser_side side;
    uint32_t selected[2]; ///< selected line of `shown` and of `places`
    bool moved;           ///< the selection was moved by a key
    struct file_list recent;
    char scene[BROWSER_PATH];  ///< path of the scene that is shown; "": the room
    char chosen[BROWSER_PATH]; ///< path to open; see browser_take
    bool is_chosen;
};

/** Frees the lists. A zeroed struct is allowed. */
void browser_finish(struct browser *browser);
/** Reads the folder and the places again. The first call begins in the folder of the scene. */
void browser_begin(struct browser *browser);
/** Reads a folder. Sorts its entries, folders first. On failure `problem` has the cause. */
void browser_enter(struct browser *browser, const char *folder);
void browser_set_filter(struct browser *browser, const char *filter);
/** Returns true if the viewer reads files of this name. */
bool browser_reads(const char *name);
/** Writes the path of the selection; "" without one. Returns `path`. */
const char *browser_selected(const struct browser *browser, char *path, size_t size);
/** Enters the selected folder, or chooses the selected file. A filter with '/' is a path. */
void browser_activate(struct browser *browser);
/** Chooses a path; "": the room. */
void browser_choose(struct browser *browser, const char *path);
/** Chooses the folder itself: its pictures hang in the room. */
void browser_choose_folder(struct browser *browser);
/** Moves the selection by `by` lines, within the list. */
void browser_move(struct browser *browser, int64_t by);
/** Enters the parent folder, and selects the folder that was left. */
void browser_up(struct browser *browser);
/** Moves out the chosen path; "": the room. False if no path was chosen. */
bool browser_take(struct browser *browser, char *path, size_t size);

/** Finds the places, as part of browser_begin (browser_places.c). */
void browser_find_places(struct browser *browser);

#endif /* SLUICE_VIEW_BROWSER_H */
