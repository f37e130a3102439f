/** Folders that are there or are not: written under another name first. */
#ifndef SLUICE_TRADEOFF_FOLDERS_H
#define SLUICE_TRADEOFF_FOLDERS_H

#include <stdbool.h>

/** With all that is in it. True if it is not there afterwards; errno says why it is. */
bool folders_remove(const char *path);
/** Makes it anew, empty. False with errno. */
bool folders_make_empty(const char *path);
/** Puts a folder in the place of another, which is removed. False with errno. */
bool folders_replace(const char *from, const char *to);
bool folders_exists(const char *path);
/** For one process at a time, until it ends. False with errno: EACCES or EAGAIN if another one has
 * it. */
bool folders_lock(const char *folder);

#endif /* SLUICE_TRADEOFF_FOLDERS_H */
