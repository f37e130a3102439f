/** Folders: making them, and finding the files in them. Sizes of files. */
#ifndef TOOLS_COMMON_FILES_H
#define TOOLS_COMMON_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Makes a folder and those above it. Reports errors on stderr. */
bool files_make_folders(const char *path);

/** Makes the folders above a file. Sets errno on failure. */
bool files_make_folders_of(const char *path);

/** Returns the size of a file in bytes. 0: there is no such file. */
uint64_t files_size(const char *path);

/** A growing list of paths. Zeroed is empty. */
struct file_list {
    char **paths; ///< owned
    size_t count, capacity;
    size_t unreadable_count; ///< files and folders, named or found, that are missing from the list
    const char *speaker;     ///< prefix of messages; NULL: ""
};

/** Returns whether a file's name ends in one of `suffixes`, separated by '|'. Ignores case. */
bool files_has_suffix(const char *path, const char *suffixes);

/**
 * Adds a file as it is, or all files with one of the suffixes in a folder and those below it,
 * sorted by name. Links to folders are not followed there. Reports on stderr what cannot be read,
 * and counts it in `unreadable_count`. Returns false only when out of memory.
 */
bool files_collect(const char *path, const char *suffixes, struct file_list *list);
/** Adds a file without opening it. Returns false when out of memory. */
bool files_add(const char *path, struct file_list *list);
void files_finish(struct file_list *list);

#endif /* TOOLS_COMMON_FILES_H */
