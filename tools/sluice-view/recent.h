/** List of recent files, kept in the user's folder of settings. */
#ifndef SLUICE_VIEW_RECENT_H
#define SLUICE_VIEW_RECENT_H

#include "../common/files.h"

#include <stdbool.h>

#define RECENT_MOST 12u

/** Replaces `list` by the list in the file at `path`, newest first. A missing file is allowed. A
 *  damaged file is reported on stderr and renamed to PATH.damaged; the list is empty then. */
void recent_read(const char *path, struct file_list *list);
/** Puts an absolute path, or a URL without a query, in front of the list. The list keeps
 * RECENT_MOST names. Ignores other names: a query may be secret. False without memory. */
bool recent_add(const char *name, struct file_list *list);
/** Writes the list. False, with a line on stderr, on failure. */
bool recent_write(const char *path, const struct file_list *list);

#endif /* SLUICE_VIEW_RECENT_H */
