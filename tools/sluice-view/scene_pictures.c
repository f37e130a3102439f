/* stat */
#define _XOPEN_SOURCE 700

#include "scene_pictures.h"

#include "scene_images.h"
#include "scene_room.h"

#include "../common/files.h"
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
#define MAX_PICTURES 8192u

static bool is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

bool scene_pictures_takes(const char *path)
{
    return is_folder(path) || files_has_suffix(path, SUFFIXES) || strstr(path, NEURAL "#");
}

static bool collect(const char *const *paths, uint32_t count, struct file_list *files)
{
    bool collected = true;
    for (uint32_t i = 0; collected && i < count; i++)
        collected = is_folder(paths[i]) ? files_collect(paths[i], SUFFIXES, files)
                                        : files_add(paths[i], files);
    return collected;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Returns how many can be shown. */
static uint32_t open_all(struct scene_data *scene, const struct file_list *files, uint32_t *images)
{
    uint32_t shown = 0;
    const int clamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    for (size_t i = 0; i < files->count; i++) {
        const struct scene_image_request request = {base_name(files->paths[i]), files->paths[i],
                                                    clamp, clamp, false};
        images[i] = scene_images_add(scene, &request);
        shown += images[i] != SCENE_NO_IMAGE;
    }
    return shown;
}

static bool hang(const struct file_list *files, const char *cache, struct scene_data *scene)
{
    char name[64];
    const uint32_t count = (uint32_t)files->count;
    uint32_t *images = calloc(files->count + 1, sizeof *images);
    snprintf(name, sizeof name, "%u pictures", count);
    bool hung =
        images && scene_room_allocate(scene, count == 1 ? base_name(files->paths[0]) : name, count);
    if (!hung)
        text_say("sluice-view: out of memory");
    hung = hung && scene_images_create_opener(cache, scene);
    if (hung && scene->progress)
        atomic_store(&scene->progress->total, count);
    if (hung && open_all(scene, files, images) == 0) {
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
    bool hung = collect(paths, count, &files);
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
