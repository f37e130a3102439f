/* Places of the browser: recent files, and scenes. */
#define _XOPEN_SOURCE 700

#include "browser.h"

#include "scene_hall.h"

#include "../common/remote.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SCENE_SUFFIXES ".gltf|.glb|.obj|.pbrt"
#define MOST_BESIDE 32u
#define MOST_ENTRIES 4096u /* entries read, in all folders together */

static bool is_listed(const struct browser *b, const char *path)
{
    for (uint32_t i = 0; i < b->place_count; i++)
        if (b->places[i].kind != PLACE_RECENT && strcmp(b->places[i].path, path) == 0)
            return true;
    return false;
}

static void add(struct browser *b, enum browser_place_kind kind, const char *path)
{
    struct browser_place *places = realloc(b->places, (b->place_count + 1) * sizeof *places);
    if (places)
        b->places = places;
    char *copy = places ? strdup(path) : NULL;
    if (!copy) /* out of memory: the list stays shorter */
        return;
    b->places[b->place_count++] = (struct browser_place){
        kind, copy, path[0] && !remote_is_url(path) && access(path, F_OK) != 0};
}

/* Finds scenes in a folder, and in its subfolders if `below`. */
static void find_scenes(struct browser *b, const char *folder, bool below, uint32_t most,
                        uint32_t *looked)
{
    char path[BROWSER_PATH + 512];
    struct stat about;
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name;
        if (name[0] != '.' && b->place_count < most && (*looked)++ < MOST_ENTRIES) {
            snprintf(path, sizeof path, "%s/%s", folder, name);
            const bool is_scene = files_has_suffix(name, SCENE_SUFFIXES);
            if ((is_scene || below) && strlen(path) < BROWSER_PATH && stat(path, &about) == 0) {
                if (is_scene && S_ISREG(about.st_mode) && !is_listed(b, path))
                    add(b, PLACE_BESIDE, path);
                else if (below && S_ISDIR(about.st_mode))
                    find_scenes(b, path, false, most, looked);
            }
        }
        free(entries[i]);
    }
    free(entries);
}

/* Finds scenes beside the shown one. Scenes often have neighboring folders of their own. */
static void find_beside(struct browser *b)
{
    char folder[BROWSER_PATH];
    uint32_t looked = 0;
    if (!b->scene[0] || remote_is_url(b->scene) || !realpath(b->scene, folder))
        return;
    const uint32_t most = b->place_count + MOST_BESIDE;
    char *slash = strrchr(folder, '/');
    if (!slash || slash == folder)
        return;
    *slash = '\0';
    find_scenes(b, folder, false, most, &looked);
    slash = strrchr(folder, '/');
    if (!slash || slash == folder)
        return;
    *slash = '\0';
    find_scenes(b, folder, true, most, &looked);
}

void browser_find_places(struct browser *b)
{
    char path[4200];
    for (size_t i = 0; i < b->recent.count; i++)
        add(b, PLACE_RECENT, b->recent.paths[i]);
    if (scene_hall_look(path, sizeof path))
        add(b, PLACE_SHIPPED, path);
    add(b, PLACE_SHIPPED, "");
    find_beside(b);
}
