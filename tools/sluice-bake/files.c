#define _XOPEN_SOURCE 700

#include "files.h"

#include "text.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static bool fail(const char *path, const char *why)
{
    text_say("sluice-bake: %s: %s", path, why);
    return false;
}

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* "folder/name", malloc'd; NULL without memory. */
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

static bool is_picture(const char *name)
{
    static const char *const extensions[] = {
        ".png", ".jpg",  ".jpeg", ".tif",  ".tiff", ".webp", ".exr", ".dds", ".ktx2",
        ".hdr", ".gif",  ".ppm",  ".pgm",  ".pfm",  ".pnm",  ".bmp", ".tga", ".jp2",
        ".jxl", ".heic", ".v",    ".avif", ".vips", ".heif", ".j2k", ".psd", ".tx"};
    for (size_t i = 0; i < sizeof extensions / sizeof extensions[0]; i++)
        if (strcasecmp(extension(name), extensions[i]) == 0)
            return true;
    return false;
}

/* Takes both strings, which may be NULL for want of memory. */
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

/* The same name in `folder` with .store instead of its own ending. */
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

static bool search(struct files *files, const char *input, const char *output);

static bool add_entry(struct files *files, const char *input, const char *output, const char *name)
{
    struct stat status;
    char *path = join(input, name);
    if (!path)
        return add(files, NULL, NULL);
    if (lstat(path, &status) == 0 && S_ISDIR(status.st_mode)) { /* links may lead in circles */
        char *below = join(output, name);
        bool done = below ? search(files, path, below) : add(files, NULL, NULL);
        free(below);
        free(path);
        return done;
    }
    if (is_picture(name))
        return add(files, path, output_in(output, name));
    free(path);
    return true;
}

static bool search(struct files *files, const char *input, const char *output)
{
    DIR *folder = opendir(input);
    struct dirent *entry;
    bool done = true;
    if (!folder)
        return fail(input, strerror(errno));
    while (done && (entry = readdir(folder)))
        if (entry->d_name[0] != '.')
            done = add_entry(files, input, output, entry->d_name);
    closedir(folder);
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

static char *copy(const char *text)
{
    char *own = malloc(strlen(text) + 1);
    return own ? strcpy(own, text) : NULL;
}

static bool add_input(struct files *files, char *input, const char *output, bool to_folder)
{
    const char *slash = strrchr(input, '/');
    if (is_folder(input))
        return search(files, input, output);
    return add(files, copy(input),
               to_folder ? output_in(output, slash ? slash + 1 : input) : copy(output));
}

bool find_files(struct files *files, char **inputs, int input_count, const char *output)
{
    bool to_folder = input_count > 1 || is_folder(output) || is_folder(inputs[0]) ||
                     output[strlen(output) - 1] == '/';
    *files = (struct files){0};
    for (int i = 0; i < input_count; i++)
        if (!add_input(files, inputs[i], output, to_folder))
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

bool make_folders_of(const char *path)
{
    char *own = copy(path);
    bool done = own != NULL;
    for (char *slash = own ? strchr(own + 1, '/') : NULL; slash && done;
         slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        done = mkdir(own, 0777) == 0 || errno == EEXIST || is_folder(own);
        *slash = '/';
    }
    free(own);
    return done;
}
