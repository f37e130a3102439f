#define _POSIX_C_SOURCE 200809L
#include "files.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text.h"

static bool make_folder(const char *path)
{
    struct stat info;
    if (mkdir(path, 0777) == 0)
        return true;
    int error = errno;
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
        return true;
    errno = error == EEXIST ? ENOTDIR : error;
    return false;
}

/* Makes all folders of the first `length` bytes of a path. */
static bool make_folders(const char *path, size_t length)
{
    char *part = strndup(path, length);
    bool made = part != NULL;
    for (size_t i = 1; i <= length && made; i++) {
        if (part[i] != '/' && part[i] != '\0')
            continue;
        part[i] = '\0';
        made = make_folder(part);
        if (i < length)
            part[i] = '/';
    }
    int error = errno;
    free(part);
    errno = error;
    return made;
}

bool files_make_folders(const char *path)
{
    bool made = make_folders(path, strlen(path));
    if (!made)
        text_say("%s: %s", path, strerror(errno));
    return made;
}

bool files_make_folders_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return !slash || slash == path || make_folders(path, (size_t)(slash - path));
}

uint64_t files_size(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 ? (uint64_t)info.st_size : 0;
}

bool files_add(const char *path, struct file_list *list)
{
    if (list->count == list->capacity) {
        size_t capacity = list->capacity ? 2 * list->capacity : 64;
        char **paths = realloc(list->paths, capacity * sizeof *paths);
        if (!paths)
            return false;
        list->paths = paths;
        list->capacity = capacity;
    }
    list->paths[list->count] = strdup(path);
    return list->paths[list->count] && ++list->count;
}

bool files_has_suffix(const char *path, const char *suffixes)
{
    size_t length = strlen(path);
    for (const char *suffix = suffixes;;) {
        size_t suffix_length = strcspn(suffix, "|");
        if (suffix_length <= length &&
            strncasecmp(path + length - suffix_length, suffix, suffix_length) == 0)
            return true;
        if (suffix[suffix_length] == '\0')
            return false;
        suffix += suffix_length + 1;
    }
}

static bool unreadable(const char *path, struct file_list *list)
{
    text_say("%s%s: %s", list->speaker ? list->speaker : "", path, strerror(errno));
    list->unreadable_count++;
    return true;
}

static bool collect_folder(const char *folder, const char *suffixes, struct file_list *list);

/* Skips links to folders, which may form cycles, and special files such as pipes. */
static bool collect_entry(const char *folder, const char *name, const char *suffixes,
                          struct file_list *list)
{
    struct stat info;
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (!path)
        return false;
    snprintf(path, size, "%s%s%s", folder, folder[strlen(folder) - 1] == '/' ? "" : "/", name);
    bool enough_memory = true;
    if (lstat(path, &info) != 0)
        enough_memory = unreadable(path, list);
    else if (S_ISDIR(info.st_mode))
        enough_memory = collect_folder(path, suffixes, list);
    else if (files_has_suffix(name, suffixes) && stat(path, &info) != 0)
        enough_memory = unreadable(path, list);
    else if (files_has_suffix(name, suffixes) && S_ISREG(info.st_mode))
        enough_memory = files_add(path, list);
    free(path);
    return enough_memory;
}

static bool collect_folder(const char *folder, const char *suffixes, struct file_list *list)
{
    struct dirent **entries;
    int count = scandir(folder, &entries, NULL, alphasort);
    if (count < 0)
        return unreadable(folder, list);
    bool enough_memory = true;
    for (int i = 0; i < count; i++) {
        if (entries[i]->d_name[0] != '.' && enough_memory)
            enough_memory = collect_entry(folder, entries[i]->d_name, suffixes, list);
        free(entries[i]);
    }
    free(entries);
    return enough_memory;
}

bool files_collect(const char *path, const char *suffixes, struct file_list *list)
{
    struct stat info;
    if (stat(path, &info) != 0)
        return unreadable(path, list);
    return S_ISDIR(info.st_mode) ? collect_folder(path, suffixes, list) : files_add(path, list);
}

void files_finish(struct file_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->paths[i]);
    free(list->paths);
    memset(list, 0, sizeof *list);
}
