/** Folders that appear complete or not at all, because they are written under another name
 * first. */
#ifndef SLUICE_TRADEOFF_FOLDERS_H
#define SLUICE_TRADEOFF_FOLDERS_H

#include <stdbool.h>

/** Removes a folder with its contents. Returns true if it does not exist afterwards; otherwise
 * errno tells why. */
bool folders_remove(const char *path);
/** Replaces a folder by an empty one. Returns false with errno. */
bool folders_make_empty(const char *path);
/** Moves a folder to the place of another, which is removed. Returns false with errno. */
bool folders_replace(const char *from, const char *to);
bool folders_exists(const char *path);
/**
 * Makes a folder with a file that marks it as made by this tool. An existing folder is marked if it
 * is empty, and otherwise left as it is. Reports errors on stderr.
 */
bool folders_make_own(const char *path);
/** Returns whether the tool may remove a folder: it does not exist, or has the mark. If not,
 * reports it on stderr. */
bool folders_may_forget(const char *path);
/** Removes a marked folder, the mark last. Returns true if it does not exist afterwards; otherwise
 * reports errors on stderr. */
bool folders_forget(const char *path);
/** Makes an empty folder in `results`/runs, for folders_remove_scratch. Reports errors on stderr
 * and returns NULL. */
char *folders_make_scratch(const char *results);
/** NULL is allowed. */
void folders_remove_scratch(char *path);
/** Locks a folder for this process until it ends. Returns false with errno: EACCES or EAGAIN if
 * another process has the lock. */
bool folders_lock(const char *folder);

#endif /* SLUICE_TRADEOFF_FOLDERS_H */
