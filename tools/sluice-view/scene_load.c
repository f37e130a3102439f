#include "scene_load.h"

#include "../common/text.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct scene_load {
    pthread_t thread;
    struct file_list paths;
    struct scene_request request;
    bool opened;
    struct scene_data scene;
    struct scene_progress progress;
    atomic_bool done;
    struct scene_load *next; ///< next of the list of canceled loads
};

static void *open_scene(void *user)
{
    struct scene_load *load = user;
    load->request.paths = (const char *const *)load->paths.paths;
    load->request.path_count = (uint32_t)load->paths.count;
    load->request.progress = &load->progress;
    load->opened = scene_open_paths(&load->request, &load->scene);
    atomic_store(&load->done, true);
    return NULL;
}

struct scene_load *scene_load_begin(struct file_list *paths, const struct scene_request *how)
{
    struct scene_load *load = calloc(1, sizeof *load);
    if (load) {
        load->paths = *paths;
        load->request = *how;
        if (pthread_create(&load->thread, NULL, open_scene, load) == 0) {
            *paths = (struct file_list){0};
            return load;
        }
    }
    text_say("sluice-view: no thread to open the scene");
    free(load);
    return NULL;
}

bool scene_load_done(const struct scene_load *load)
{
    return atomic_load(&load->done);
}

void scene_load_describe(const struct scene_load *load, char *text, size_t size)
{
    const unsigned total = atomic_load(&load->progress.total);
    const unsigned percent = atomic_load(&load->progress.percent);
    unsigned done = atomic_load(&load->progress.done);
    const char *path = load->paths.count > 0 ? load->paths.paths[0] : "the room";
    const char *slash = strrchr(path, '/');
    const char *name = slash && slash[1] ? slash + 1 : path;
    const int length = (int)(remote_is_url(path) ? strcspn(name, "?#") : strlen(name));
    done = done < total ? done : total;
    if (percent > 0)
        snprintf(text, size, "Opening %.*s: %u %% was played; Esc cancels",
                 length < 80 ? length : 80, name, percent - 1);
    else if (total > 0)
        snprintf(text, size, "Opening %.*s: %u of %u images; Esc cancels",
                 length < 80 ? length : 80, name, done, total);
    else
        snprintf(text, size, "Opening %.*s; Esc cancels", length < 80 ? length : 80, name);
}

bool scene_load_end(struct scene_load *load, struct scene_data *scene, struct file_list *paths)
{
    pthread_join(load->thread, NULL);
    const bool opened = load->opened;
    *scene = load->scene;
    *paths = load->paths;
    free(load);
    return opened;
}

void scene_load_keep_canceled(struct scene_load *load, struct scene_load **canceled)
{
    atomic_store(&load->progress.canceled, true);
    load->next = *canceled;
    *canceled = load;
}

static void drop(struct scene_load *load)
{
    struct scene_data scene;
    struct file_list paths;
    if (scene_load_end(load, &scene, &paths))
        scene_data_finish(&scene);
    files_finish(&paths);
}

void scene_load_drop_canceled(struct scene_load **canceled, bool wait)
{
    while (*canceled) {
        struct scene_load *load = *canceled;
        if (wait || scene_load_done(load)) {
            *canceled = load->next;
            drop(load);
        } else {
            canceled = &load->next;
        }
    }
}
