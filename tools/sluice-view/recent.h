/** Files that were opened last, kept in the user's folder of settings. */
#ifndef SLUICE_VIEW_RECENT_H
#define SLUICE_VIEW_RECENT_H

#include "../common/files.h"

#include <stdbool.h>

#define RECENT_MOST 12u

/** Reads the list of the file at `path`, newest first, in place of what is in it; no file is fine.
 *  A damaged file is named on stderr, set aside under the name PATH.damaged, and the list is empty.
 */
void recent_read(const char *path, struct file_list *list);
/** Puts an absolute path, or a URL without a query, in front of the list, which keeps RECENT_MOST
 *  of them. Others are left out: a query may be secret. False without memory. */
bool recent_add(const char *name, struct file_list *list);
/** Says on stderr what failed. */
bool recent_write(const char *path, const struct file_list *list);

#endif /* SLUICE_VIEW_RECENT_H */
