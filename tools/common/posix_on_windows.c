#include "posix_on_windows.h"

#include <stdlib.h>
#include <string.h>

char *strndup(const char *text, size_t length)
{
    size_t size = strnlen(text, length);
    char *copy = malloc(size + 1);
    if (!copy)
        return NULL;
    memcpy(copy, text, size);
    copy[size] = '\0';
    return copy;
}

int alphasort(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static int compare_names(const void *a, const void *b)
{
    return alphasort((const struct dirent **)a, (const struct dirent **)b);
}

static struct dirent *copy_entry(const struct dirent *entry)
{
    struct dirent *copy = malloc(sizeof *copy);
    if (copy)
        *copy = *entry;
    return copy;
}

static void free_entries(struct dirent **entries, int count)
{
    for (int i = 0; i < count; i++)
        free(entries[i]);
    free(entries);
}

int scandir(const char *folder, struct dirent ***entries, int (*select)(const struct dirent *),
            int (*compare)(const struct dirent **, const struct dirent **))
{
    struct dirent **list = NULL;
    int count = 0;
    DIR *stream = opendir(folder);
    (void)select;
    (void)compare;
    if (!stream)
        return -1;
    for (struct dirent *entry; (entry = readdir(stream));) {
        struct dirent **more = realloc(list, ((size_t)count + 1) * sizeof *list);
        struct dirent *copy = more ? copy_entry(entry) : NULL;
        list = more ? more : list;
        if (!copy) {
            free_entries(list, count);
            closedir(stream);
            errno = ENOMEM;
            return -1;
        }
        list[count++] = copy;
    }
    closedir(stream);
    if (count)
        qsort(list, (size_t)count, sizeof *list, compare_names);
    *entries = list;
    return count;
}
