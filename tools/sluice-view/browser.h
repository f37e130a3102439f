/**
 * The file browser, without its picture: a folder, what of it the viewer reads, a filter of words,
 * and places: recent files, the scenes that come with the viewer, and those beside the one that is
 * shown.
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
    char problem[512];         ///< why the folder cannot be shown; "": nothing
    struct browser_entry *entries;
    size_t entry_count, entry_capacity;
    uint32_t *shown; ///< entries that the filter leaves
    uint32_t shown_count;
    struct browser_place *places;
    uint32_t place_count;
    char filter[256];
    enum browser_side side;
    uint32_t selected[2]; ///< of `shown` and of `places`
    bool moved;           ///< the selection was moved by a key
    struct file_list recent;
    char scene[BROWSER_PATH];  ///< that is shown; "": the room
    char chosen[BROWSER_PATH]; ///< to open; see browser_take
    bool is_chosen;
};

/** A zeroed struct is fine. */
void browser_finish(struct browser *browser);
/** Reads the folder anew, of the scene at first, and the places. */
void browser_begin(struct browser *browser);
/** Reads a folder, with folders first, sorted. If that fails, `problem` says why. */
void browser_enter(struct browser *browser, const char *folder);
void browser_set_filter(struct browser *browser, const char *filter);
/** Whether the viewer reads files of this name. */
bool browser_reads(const char *name);
/** Writes the path of the selection, "" if there is none. Returns `path`. */
const char *browser_selected(const struct browser *browser, char *path, size_t size);
/** Enters the selected folder, or chooses the selected file. A filter with '/' is a path. */
void browser_activate(struct browser *browser);
/** Chooses a path; "": the room. */
void browser_choose(struct browser *browser, const char *path);
/** Chooses the folder itself: its pictures hang in the room. */
void browser_choose_folder(struct browser *browser);
/** Moves the selection, and stays within the list. */
void browser_move(struct browser *browser, int64_t by);
/** Enters the folder above, with the one that is left selected. */
void browser_up(struct browser *browser);
/** Moves out what was chosen: a path, "" for the room. False if nothing was. */
bool browser_take(struct browser *browser, char *path, size_t size);

/** Part of browser_begin: browser_places.c. */
void browser_find_places(struct browser *browser);

#endif /* SLUICE_VIEW_BROWSER_H */
