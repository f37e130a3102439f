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
/**
 * Makes a folder, and a file in it that marks it as made by this tool. A folder that is there is
 * marked if it is empty, and otherwise taken as it is. Says on stderr why it failed.
 */
bool folders_make_own(const char *path);
/** Whether the tool may remove a folder: it is not there, or has the mark. Says on stderr if not.
 */
bool folders_may_forget(const char *path);
/** Removes a folder with the mark, the mark last. True if it is not there afterwards; else stderr
 *  says why. */
bool folders_forget(const char *path);
/** An empty folder below `results`/runs, for folders_remove_scratch. NULL if it cannot be made, and
 *  stderr says why. */
char *folders_make_scratch(const char *results);
/** NULL is fine. */
void folders_remove_scratch(char *path);
/** For one process at a time, until it ends. False with errno: EACCES or EAGAIN if another one has
 * it. */
bool folders_lock(const char *folder);

#endif /* SLUICE_TRADEOFF_FOLDERS_H */
