/** Folders: making them, and finding the files in them. Sizes of files. */
#ifndef TOOLS_COMMON_FILES_H
#define TOOLS_COMMON_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Makes a folder and those above it. Says on stderr why it failed. */
bool files_make_folders(const char *path);

/** Makes the folders above a file. errno says why it failed. */
bool files_make_folders_of(const char *path);

/** Bytes of a file; 0 if there is none. */
uint64_t files_size(const char *path);

/** A growing list of paths. Zeroed is empty. */
struct file_list {
    char **paths; ///< owned
    size_t count, capacity;
    size_t unreadable_count; ///< files and folders that were named or found and are not in the list
    const char *speaker;     ///< stands in front of messages; NULL: ""
};

/** Whether a file's name ends in one of `suffixes`, which are separated by '|'; in any case. */
bool files_has_suffix(const char *path, const char *suffixes);

/**
 * Adds a file as it is, or all files with one of the suffixes in a folder and those below it,
 * sorted by name; links to folders are not followed there. Says on stderr what cannot be read and
 * counts it in `unreadable_count`; false only when out of memory.
 */
bool files_collect(const char *path, const char *suffixes, struct file_list *list);
/** Adds a file without looking at it. False when out of memory. */
bool files_add(const char *path, struct file_list *list);
void files_finish(struct file_list *list);

#endif /* TOOLS_COMMON_FILES_H */
