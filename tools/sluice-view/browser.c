/* realpath, scandir's d_type */
#define _DEFAULT_SOURCE
#define _XOPEN_SOURCE 700

#include "browser.h"

#include "../common/picture_names.h"
#include "../common/remote.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* Suffixes of listed files. Assimp reads more formats: a typed path opens any file. */
#define READ_SUFFIXES                                                                              \
    ".gltf|.glb|.obj|.pbrt|.pbrt.gz|.trace|.fbx|.dae|.ply|.stl|.3ds|.store|.ntc|."                 \
    "tsv|" PICTURE_SUFFIXES

bool browser_reads(const char *name)
{
    return files_has_suffix(name, READ_SUFFIXES);
}

static void drop_entries(struct browser *b)
{
    for (size_t i = 0; i < b->entry_count; i++)
        free(b->entries[i].name);
    free(b->entries);
    free(b->shown);
    b->entries = NULL;
    b->shown = NULL;
    b->entry_count = b->entry_capacity = 0;
    b->shown_count = b->selected[BROWSER_FILES] = 0;
}

static void drop_places(struct browser *b)
{
    for (uint32_t i = 0; i < b->place_count; i++)
        free(b->places[i].path);
    free(b->places);
    b->places = NULL;
    b->place_count = b->selected[BROWSER_PLACES] = 0;
}

void browser_finish(struct browser *b)
{
    drop_entries(b);
    drop_places(b);
    files_finish(&b->recent);
    *b = (struct browser){.side = BROWSER_FILES};
}

/* Adds an entry, and takes its name. */
static bool add_entry(struct browser *b, char *name, bool is_folder, uint64_t size)
{
    if (b->entry_count == b->entry_capacity) {
        const size_t capacity = 2 * b->entry_capacity + 64;
        struct browser_entry *entries = realloc(b->entries, capacity * sizeof *entries);
        if (!entries) {
            free(name);
            return false;
        }
        b->entries = entries;
        b->entry_capacity = capacity;
    }
    b->entries[b->entry_count++] = (struct browser_entry){name, size, is_folder};
    return true;
}

static bool look_at(struct browser *b, const char *name)
{
    char path[BROWSER_PATH + 512];
    struct stat about;
    snprintf(path, sizeof path, "%s/%s", b->folder, name);
    if (stat(path, &about) != 0) /* deleted meanwhile, or a dangling link */
        return true;
    const bool is_folder = S_ISDIR(about.st_mode);
    if (!is_folder && (!S_ISREG(about.st_mode) || !browser_reads(name)))
        return true;
    char *copy = strdup(name);
    return copy && add_entry(b, copy, is_folder, is_folder ? 0 : (uint64_t)about.st_size);
}

static int compare(const void *left, const void *right)
{
    const struct browser_entry *a = left, *b = right;
    if (a->is_folder != b->is_folder)
        return a->is_folder ? -1 : 1;
    const int order = strcasecmp(a->name, b->name);
    return order ? order : strcmp(a->name, b->name);
}

static bool fail(struct browser *b, int error)
{
    snprintf(b->problem, sizeof b->problem, "%.400s: %s", b->folder, strerror(error));
    return false;
}

static bool read_folder(struct browser *b)
{
    DIR *folder = opendir(b->folder);
    bool good = folder != NULL;
    if (!folder)
        return fail(b, errno);
    errno = 0;
    for (struct dirent *entry; good && (entry = readdir(folder)); errno = 0)
        if (entry->d_name[0] != '.' && (entry->d_type != DT_REG || browser_reads(entry->d_name)) &&
            !look_at(b, entry->d_name))
            good = fail(b, ENOMEM);
    if (good && errno)
        good = fail(b, errno);
    closedir(folder);
    return good;
}

/* Returns true if the name has all words of the filter, ignoring case. */
static bool matches(const char *name, const char *filter)
{
    char word[256];
    while (*(filter += strspn(filter, " "))) {
        const size_t length = strcspn(filter, " ");
        bool found = false;
        snprintf(word, sizeof word, "%.*s", (int)length, filter);
        for (const char *at = name; *at && !found; at++)
            found = strncasecmp(at, word, length) == 0;
        if (!found)
            return false;
        filter += length;
    }
    return true;
}

static void apply_filter(struct browser *b)
{
    const bool is_path = strchr(b->filter, '/') != NULL;
    b->shown_count = 0;
    for (size_t i = 0; b->shown && i < b->entry_count; i++)
        if (is_path || matches(b->entries[i].name, b->filter))
            b->shown[b->shown_count++] = (uint32_t)i;
    b->selected[BROWSER_FILES] = 0;
}

void browser_enter(struct browser *b, const char *folder)
{
    char resolved[BROWSER_PATH];
    const char *path = realpath(folder, resolved);
    b->problem[0] = b->filter[0] = '\0';
    b->side = BROWSER_FILES;
    b->moved = true;
    drop_entries(b);
    snprintf(b->folder, sizeof b->folder, "%s", path ? path : folder);
    if (!path)
        fail(b, errno);
    else
        read_folder(b);
    if (b->entry_count > 0)
        qsort(b->entries, b->entry_count, sizeof *b->entries, compare);
    b->shown = malloc((b->entry_count + 1) * sizeof *b->shown);
    if (!b->shown)
        fail(b, ENOMEM);
    apply_filter(b);
}

void browser_begin(struct browser *b)
{
    char folder[BROWSER_PATH];
    if (!b->folder[0]) {
        char *slash = NULL;
        snprintf(folder, sizeof folder, "%s", b->scene);
        if (!remote_is_url(folder))
            slash = strrchr(folder, '/');
        if (slash)
            slash[slash == folder] = '\0';
        snprintf(b->folder, sizeof b->folder, "%s", slash ? folder : ".");
    }
    memcpy(folder, b->folder, sizeof folder);
    browser_enter(b, folder);
    drop_places(b);
    browser_find_places(b);
}

void browser_set_filter(struct browser *b, const char *filter)
{
    snprintf(b->filter, sizeof b->filter, "%s", filter);
    b->side = BROWSER_FILES;
    b->moved = true;
    apply_filter(b);
}

const char *browser_selected(const struct browser *b, char *path, size_t size)
{
    const uint32_t i = b->selected[b->side];
    path[0] = '\0';
    if (b->side == BROWSER_PLACES && i < b->place_count)
        snprintf(path, size, "%s", b->places[i].path);
    else if (b->side == BROWSER_FILES && i < b->shown_count)
        snprintf(path, size, "%s%s%s", b->folder, strcmp(b->folder, "/") == 0 ? "" : "/",
                 b->entries[b->shown[i]].name);
    return path;
}

void browser_choose(struct browser *b, const char *path)
{
    snprintf(b->chosen, sizeof b->chosen, "%s", path);
    b->is_chosen = true;
}

static bool is_folder(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

/* Resolves a typed path: "~/a" from home, "/a" from the root, "a/b" from the folder. */
static void write_typed(const struct browser *b, char *path, size_t size)
{
    const char *home = getenv("HOME"), *typed = b->filter;
    if (strstr(typed, "://") || typed[0] == '/')
        snprintf(path, size, "%s", typed);
    else if (strncmp(typed, "~/", 2) == 0 && home)
        snprintf(path, size, "%s%s", home, typed + 1);
    else
        snprintf(path, size, "%s/%s", b->folder, typed);
}

void browser_activate(struct browser *b)
{
    char path[2 * BROWSER_PATH];
    if (b->side == BROWSER_FILES && strchr(b->filter, '/')) {
        write_typed(b, path, sizeof path);
    } else {
        browser_selected(b, path, sizeof path);
        if (b->side == BROWSER_PLACES && b->selected[b->side] < b->place_count) {
            browser_choose(b, path);
            return;
        }
        if (!path[0])
            return;
    }
    if (is_folder(path))
        browser_enter(b, path);
    else
        browser_choose(b, path);
}

void browser_choose_folder(struct browser *b)
{
    browser_choose(b, b->folder);
}

void browser_move(struct browser *b, int64_t by)
{
    const int64_t count = b->side == BROWSER_FILES ? b->shown_count : b->place_count;
    int64_t at = (int64_t)b->selected[b->side] + by;
    at = at >= count ? count - 1 : at;
    b->selected[b->side] = at > 0 ? (uint32_t)at : 0;
    b->moved = true;
}

void browser_up(struct browser *b)
{
    char left[BROWSER_PATH], above[BROWSER_PATH];
    memcpy(above, b->folder, sizeof above);
    char *slash = strrchr(above, '/');
    if (!slash || !slash[1])
        return;
    snprintf(left, sizeof left, "%s", slash + 1);
    slash[slash == above] = '\0';
    browser_enter(b, above);
    for (uint32_t i = 0; i < b->shown_count; i++)
        if (strcmp(b->entries[b->shown[i]].name, left) == 0)
            b->selected[BROWSER_FILES] = i;
}

bool browser_take(struct browser *b, char *path, size_t size)
{
    const bool chosen = b->is_chosen;
    snprintf(path, size, "%s", chosen ? b->chosen : "");
    b->is_chosen = false;
    return chosen;
}
