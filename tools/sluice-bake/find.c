#define _XOPEN_SOURCE 700

#include "find.h"

#include "../common/files.h"
#include "../common/picture_names.h"
#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static char *copy(const char *text)
{
    char *own = malloc(strlen(text) + 1);
    return own ? strcpy(own, text) : NULL;
}

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* Returns "folder/name", allocated; NULL when out of memory. */
static char *join(const char *folder, const char *name)
{
    size_t length = strlen(folder), size = length + strlen(name) + 2;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s%s%s", folder, length && folder[length - 1] == '/' ? "" : "/",
                 name);
    return path;
}

static const char *extension(const char *name)
{
    const char *slash = strrchr(name, '/'), *dot = strrchr(name, '.');
    return dot && dot != name && (!slash || dot > slash + 1) ? dot : name + strlen(name);
}

/* Takes both strings. NULL: an allocation has failed before. */
static bool add(struct files *files, char *input, char *output)
{
    if (files->count == files->capacity) {
        size_t capacity = files->capacity ? 2 * files->capacity : 64;
        struct file *more = realloc(files->files, capacity * sizeof *more);
        if (more) {
            files->files = more;
            files->capacity = capacity;
        }
    }
    if (!input || !output || files->count == files->capacity) {
        free(input);
        free(output);
        fprintf(stderr, "sluice-bake: out of memory\n");
        return false;
    }
    struct stat status;
    uint64_t size = stat(input, &status) == 0 ? (uint64_t)status.st_size : 0;
    files->files[files->count++] = (struct file){input, output, size};
    return true;
}

/* Returns the path of `name` in `folder`, with .store instead of its extension. */
static char *output_in(const char *folder, const char *name)
{
    int length = (int)(extension(name) - name);
    size_t size = (size_t)length + sizeof ".store";
    char *store = malloc(size), *path = NULL;
    if (store) {
        snprintf(store, size, "%.*s.store", length, name);
        path = join(folder, store);
    }
    free(store);
    return path;
}

/* Adds all pictures of a folder and its subfolders. */
static bool search(struct files *files, const char *input, const char *output)
{
    struct file_list found = {.speaker = "sluice-bake: "};
    size_t skipped = strlen(input) + (input[strlen(input) - 1] != '/');
    bool done = files_collect(input, PICTURE_SUFFIXES, &found) || add(files, NULL, NULL);
    for (size_t i = 0; i < found.count && done; i++)
        done = add(files, copy(found.paths[i]), output_in(output, found.paths[i] + skipped));
    files->unreadable_count += found.unreadable_count;
    files_finish(&found);
    return done;
}

static int by_output(const void *a, const void *b)
{
    return strcmp(((const struct file *)a)->output, ((const struct file *)b)->output);
}

static bool outputs_differ(const struct files *files)
{
    for (size_t i = 1; i < files->count; i++)
        if (strcmp(files->files[i - 1].output, files->files[i].output) == 0) {
            text_say("sluice-bake: %s and %s would both become %s", files->files[i - 1].input,
                     files->files[i].input, files->files[i].output);
            return false;
        }
    return true;
}

static bool add_input(struct files *files, char *input, const char *output, bool to_folder)
{
    const char *slash = strrchr(input, '/');
    if (is_folder(input))
        return search(files, input, output);
    return add(files, copy(input),
               to_folder ? output_in(output, slash ? slash + 1 : input) : copy(output));
}

bool find_files(struct files *files, const struct option_list *inputs, const char *output)
{
    bool to_folder = inputs->count > 1 || is_folder(output) || is_folder(inputs->items[0]) ||
                     output[strlen(output) - 1] == '/';
    *files = (struct files){0};
    for (size_t i = 0; i < inputs->count; i++)
        if (!add_input(files, inputs->items[i], output, to_folder))
            return false;
    if (files->count)
        qsort(files->files, files->count, sizeof *files->files, by_output);
    return outputs_differ(files);
}

void free_files(struct files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        free(files->files[i].input);
        free(files->files[i].output);
    }
    free(files->files);
    *files = (struct files){0};
}
