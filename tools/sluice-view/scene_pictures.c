/* stat */
#define _XOPEN_SOURCE 700

#include "scene_pictures.h"

#include "scene_catalogue.h"
#include "scene_images.h"
#include "scene_room.h"

#include "../../samples/streaming/cache.h"
#include "../common/files.h"
#include "../common/log.h"
#include "../common/picture_names.h"
#include "../common/text.h"

#include <sluice/store.h>

#include <vulkan/vulkan_core.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define NEURAL ".ntc" /* its first texture; "set.ntc#name": another one */
#define SUFFIXES SLUICE_STORE_EXTENSION "|" NEURAL "|" PICTURE_SUFFIXES
#define SCENES ".gltf|.glb|.obj|.pbrt"
#define MAX_PICTURES 8192u

static bool is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

bool scene_pictures_takes(const char *path)
{
    return remote_is_url(path) || is_folder(path) || files_has_suffix(path, SUFFIXES) ||
           strstr(path, NEURAL "#") || scene_catalogue_takes(path);
}

static void say_scene(const char *path)
{
    const char *slash = strrchr(path, '/');
    text_say("sluice-view: %s is a scene: sluice-view %s", slash ? slash + 1 : path, path);
}

/* Collects the pictures of a folder. Suggests the scene to the user if the folder has one. */
static bool collect_folder(const char *path, struct file_list *files)
{
    struct file_list found = {.speaker = files->speaker};
    const char *scene = NULL;
    size_t scenes = 0;
    bool collected = files_collect(path, SUFFIXES "|" SCENES, &found);
    for (size_t i = 0; collected && i < found.count; i++)
        if (files_has_suffix(found.paths[i], SCENES)) {
            scene = found.paths[i];
            scenes++;
        } else {
            collected = files_add(found.paths[i], files);
        }
    if (scenes == 1)
        say_scene(scene);
    files->unreadable_count += found.unreadable_count;
    files_finish(&found);
    return collected;
}

static bool collect(const char *const *paths, uint32_t count, struct remote_session *session,
                    struct file_list *files)
{
    bool collected = true;
    for (uint32_t i = 0; collected && i < count; i++) {
        if (is_folder(paths[i]))
            collected = collect_folder(paths[i], files);
        else if (scene_catalogue_takes(paths[i]))
            collected = scene_catalogue_collect(paths[i], session, files);
        else
            collected = files_add(paths[i], files);
    }
    return collected;
}

static void write_name(const char *path, char *name, size_t size)
{
    const char *store = strstr(path, CATALOGUE "#");
    path = store ? store + strlen(CATALOGUE "#") : path;
    const char *slash = strrchr(path, '/');
    if (remote_is_url(path))
        remote_name(path, name, size);
    else
        snprintf(name, size, "%s", slash ? slash + 1 : path);
}

/* Replaces the URL of a picture without tiles by a local copy, since only files can be baked. */
static void copy_picture(const char *url, const char *cache, struct remote_session *session,
                         char **path)
{
    const SluiceLogCallback log = {NULL, log_say};
    struct remote_file remote;
    char name[256], copy[4096];
    remote_name(url, name, sizeof name);
    if (!files_has_suffix(name, PICTURE_SUFFIXES) || files_has_suffix(name, TILED_SUFFIXES) ||
        !remote_open(&remote, session, url, &log))
        return;
    const bool kept = cache_keep_input(cache, name, &remote.input, copy, sizeof copy);
    remote_close(&remote);
    char *owned = kept ? strdup(copy) : NULL;
    if (owned) {
        free(*path);
        *path = owned;
    }
}

/* Opens all pictures. Returns the number that can be shown. */
static uint32_t open_all(struct scene_data *scene, const char *cache, struct file_list *files,
                         uint32_t *images)
{
    uint32_t shown = 0;
    const int clamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    for (size_t i = 0; i < files->count; i++) {
        char name[256];
        write_name(files->paths[i], name, sizeof name);
        if (remote_is_url(files->paths[i]) && !scene_data_canceled(scene))
            copy_picture(files->paths[i], cache, &scene->remote, &files->paths[i]);
        const struct scene_image_request request = {name, files->paths[i], clamp, clamp,
                                                    CONTENT_COLORS};
        images[i] = scene_images_add(scene, &request);
        shown += images[i] != SCENE_NO_IMAGE;
    }
    return shown;
}

static bool has_url(const struct file_list *files)
{
    for (size_t i = 0; i < files->count; i++)
        if (remote_is_url(files->paths[i]))
            return true;
    return false;
}

static bool hang(struct file_list *files, const char *cache, struct scene_data *scene)
{
    char name[256];
    const uint32_t count = (uint32_t)files->count;
    uint32_t *images = calloc(files->count + 1, sizeof *images);
    snprintf(name, sizeof name, "%u pictures", count);
    if (count == 1)
        write_name(files->paths[0], name, sizeof name);
    bool hung = images && scene_room_allocate(scene, name, count);
    if (!hung)
        text_say("sluice-view: out of memory");
    const SluiceLogCallback log = {NULL, log_say};
    hung = hung && (!has_url(files) || remote_begin(&scene->remote, &log)) &&
           scene_images_create_opener(cache, scene);
    if (hung && scene->progress)
        atomic_store(&scene->progress->total, count);
    if (hung && open_all(scene, cache, files, images) == 0) {
        if (!scene_data_canceled(scene))
            text_say("sluice-view: there is no picture to show");
        hung = false;
    }
    hung = hung && scene_room_hang(scene, images, count);
    free(images);
    return hung;
}

bool scene_pictures(const char *const *paths, uint32_t count, const char *cache, bool wait,
                    struct scene_data *scene)
{
    struct file_list files = {.speaker = "sluice-view: "};
    bool hung = collect(paths, count, &scene->remote, &files);
    if (hung && files.count > MAX_PICTURES) {
        text_say("sluice-view: %zu pictures are more than %u", files.count, MAX_PICTURES);
        hung = false;
    }
    hung = hung && hang(&files, cache, scene);
    files_finish(&files);
    if (hung && wait)
        scene_images_wait(scene);
    return hung;
}
