/** Settings and bookmarks of a scene, kept between runs. */
#ifndef SLUICE_VIEW_SETTINGS_FILE_H
#define SLUICE_VIEW_SETTINGS_FILE_H

#include "app.h"

/** Writes the path of a file in the user's folder of settings: "view-recent.list". False without
 *  such a folder. */
bool settings_file_named(const char *name, char *path, size_t size);
/** Renames a damaged file to PATH.damaged, and reports it on stderr. `outcome`: end of the report.
 */
void settings_file_set_aside(const char *path, const char *outcome);
/** Writes the path of a scene's file in the user's folder of settings. False without the folder. */
bool settings_file_path(const char *scene, char *path, size_t size);
/** Reads settings of A and B, and bookmarks, from a file. A missing file is allowed. Settings that
 *  the file does not name stay. A damaged file changes nothing: it is reported on stderr and
 * renamed to PATH.damaged. */
void settings_file_read(const char *path, struct view_app *app);
/** Writes the file. False, with a line on stderr, on failure. */
bool settings_file_write(const char *path, const struct view_app *app);

#endif /* SLUICE_VIEW_SETTINGS_FILE_H */
