#define _POSIX_C_SOURCE 200809L
#include "files.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

bool files_make_folders(const char *path)
{
    char part[4096];
    size_t length = strlen(path);
    if (length >= sizeof part) {
        fprintf(stderr, "%s: too long\n", path);
        return false;
    }
    for (size_t i = 1; i <= length; i++) {
        if (path[i] != '/' && path[i] != '\0')
            continue;
        memcpy(part, path, i);
        part[i] = '\0';
        if (mkdir(part, 0777) != 0 && errno != EEXIST) {
            fprintf(stderr, "%s: %s\n", part, strerror(errno));
            return false;
        }
    }
    return true;
}

static bool add_path(const char *path, struct file_list *list)
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
    fprintf(stderr, "%s: %s\n", path, strerror(errno));
    list->unreadable_count++;
    return true;
}

static bool collect_folder(const char *folder, const char *suffixes, struct file_list *list)
{
    struct dirent **entries;
    int count = scandir(folder, &entries, NULL, alphasort);
    if (count < 0)
        return unreadable(folder, list);
    bool enough_memory = true;
    for (int i = 0; i < count; i++) {
        char path[4096];
        struct stat info;
        int length = snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
        /* Links to folders may lead in circles. */
        bool usable =
            entries[i]->d_name[0] != '.' && (size_t)length < sizeof path && lstat(path, &info) == 0;
        if (usable && enough_memory && S_ISDIR(info.st_mode))
            enough_memory = collect_folder(path, suffixes, list);
        else if (usable && enough_memory && files_has_suffix(path, suffixes) &&
                 stat(path, &info) == 0 && S_ISREG(info.st_mode))
            enough_memory = add_path(path, list);
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
    return S_ISDIR(info.st_mode) ? collect_folder(path, suffixes, list) : add_path(path, list);
}

void files_finish(struct file_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->paths[i]);
    free(list->paths);
    memset(list, 0, sizeof *list);
}
