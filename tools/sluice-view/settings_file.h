/** Settings, cameras and bookmarks of a scene, kept from one time to the next. */
#ifndef SLUICE_VIEW_SETTINGS_FILE_H
#define SLUICE_VIEW_SETTINGS_FILE_H

#include "app.h"

/** Path of a file in the user's folder of settings: "view-recent.list". False without such a
 * folder.
 */
bool settings_file_named(const char *name, char *path, size_t size);
/** Renames a damaged file to PATH.damaged, and says so on stderr. `outcome`: what follows. */
void settings_file_set_aside(const char *path, const char *outcome);
/** Path of the file of a scene in the user's folder of settings. False without such a folder. */
bool settings_file_path(const char *scene, char *path, size_t size);
/** Reads a file into the settings of A and B, and bookmarks; no file is fine. What the file does
 * not name stays. A damaged file is named on stderr, set aside under the name PATH.damaged, and
 * changes nothing. */
void settings_file_read(const char *path, struct view_app *app);
/** Says on stderr what failed. */
bool settings_file_write(const char *path, const struct view_app *app);

#endif /* SLUICE_VIEW_SETTINGS_FILE_H */
