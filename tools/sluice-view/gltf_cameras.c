#include "gltf_cameras.h"

#include "gltf_animation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_POINTS 20000u        /* per path */
#define MOST_WORK 20000000u       /* points * nodes * tracks */
#define STEP_SECONDS (1.0 / 60.0) /* between points; paths are straight between points */

struct reading {
    struct gltf_file *file;
    void (*note)(void *user, const char *where, const char *problem);
    void *user;
    struct file_cameras *cameras;
    uint32_t *parents; ///< parent of each node; GLTF_NONE: none
};

/* A time of a path; `before`: just before it, where a step has not happened. */
struct moment {
    double seconds;
    bool before;
};

static const cJSON *member(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

void file_cameras_finish(struct file_cameras *cameras)
{
    for (uint32_t i = 0; i < cameras->count; i++) {
        free(cameras->items[i].name);
        camera_path_finish(&cameras->items[i].path);
    }
    free(cameras->items);
    *cameras = (struct file_cameras){0};
}

/* Reads a member that must be a number from `least` to `most`. */
static bool get(const cJSON *object, const char *name, double least, double most, float *value)
{
    const cJSON *item = member(object, name);
    const double number = cJSON_GetNumberValue(item);
    if (!cJSON_IsNumber(item) || !(fabs(number) >= least && fabs(number) <= most))
        return false;
    *value = (float)fabs(number);
    return true;
}

/* Reads the lens of a camera. Returns a description of its fault; NULL: none. */
static const char *read_lens(const cJSON *camera, struct view_camera *lens)
{
    const char *type = cJSON_GetStringValue(member(camera, "type"));
    const cJSON *perspective = member(camera, "perspective");
    const cJSON *parallel = member(camera, "orthographic");
    float width;
    *lens = (struct view_camera){.fov = 1};
    if (type && strcmp(type, "perspective") == 0) {
        if (!get(perspective, "yfov", 0.01, 3, &lens->fov))
            return "its yfov is not 0.01 to 3";
        if (member(perspective, "aspectRatio") &&
            !get(perspective, "aspectRatio", 0.01, 100, &lens->aspect))
            return "its aspectRatio is not 0.01 to 100";
        return NULL;
    }
    if (!type || strcmp(type, "orthographic") != 0)
        return "its type is not perspective or orthographic";
    if (!get(parallel, "ymag", 1e-6, 1e9, &lens->span) || !get(parallel, "xmag", 1e-6, 1e9, &width))
        return "its xmag or ymag is not 1e-6 to 1e9";
    lens->aspect = width / lens->span;
    return NULL;
}

static struct vec3 column_of(const double m[16], int column, double scale)
{
    const double *c = m + 4 * column;
    return (struct vec3){(float)(scale * c[0]), (float)(scale * c[1]), (float)(scale * c[2])};
}

/* Places a camera by a matrix, without its scale. False if an axis has no direction. */
static bool place(const double m[16], const struct view_camera *lens, struct view_camera *camera)
{
    double lengths[3];
    for (int i = 0; i < 16; i++)
        if (!(fabs(m[i]) <= 1e15))
            return false;
    for (int c = 0; c < 3; c++)
        lengths[c] =
            sqrt(m[4 * c] * m[4 * c] + m[4 * c + 1] * m[4 * c + 1] + m[4 * c + 2] * m[4 * c + 2]);
    if (!(lengths[1] > 1e-20 && lengths[2] > 1e-20))
        return false;
    const struct vec3 forward = column_of(m, 2, -1 / lengths[2]);
    const struct vec3 up = column_of(m, 1, 1 / lengths[1]), cross = vec3_cross(forward, up);
    if (!(vec3_dot(cross, cross) > 1e-12f))
        return false;
    *camera = view_camera_of_axes(column_of(m, 3, 1), forward, up, lens);
    return true;
}

static int compare(const void *left, const void *right)
{
    const struct moment *a = left, *b = right;
    if (a->seconds != b->seconds)
        return a->seconds < b->seconds ? -1 : 1;
    return a->before == b->before ? 0 : a->before ? -1 : 1;
}

/* Chooses times of a path: keys, unless there are too many, and times between keys. */
static struct moment *choose_moments(const struct gltf_tracks *tracks, uint32_t nodes,
                                     uint32_t *count)
{
    uint32_t most = MOST_WORK / (nodes * (tracks->count + 1u));
    uint64_t keys = 0;
    double end = 0;
    most = most > MOST_POINTS ? MOST_POINTS : most;
    for (uint32_t i = 0; i < tracks->count; i++) {
        keys += 2 * (uint64_t)tracks->items[i].count;
        end = fmax(end, tracks->items[i].times[tracks->items[i].count - 1]);
    }
    keys = keys > most / 2 ? 0 : keys;
    const double step = fmax(STEP_SECONDS, 2 * end / most);
    const uint32_t steps = (uint32_t)(end / step);
    struct moment *moments = malloc((keys + steps + 2) * sizeof *moments);
    *count = 0;
    for (uint32_t i = 0; moments && i <= steps; i++)
        moments[(*count)++] = (struct moment){i * step, false};
    if (moments)
        moments[(*count)++] = (struct moment){end, false};
    for (uint32_t i = 0; moments && keys > 0 && i < tracks->count; i++)
        for (uint32_t k = 0; k < tracks->items[i].count; k++)
            for (int before = 1; before >= 0; before--)
                moments[(*count)++] = (struct moment){tracks->items[i].times[k], before != 0};
    if (moments)
        qsort(moments, *count, sizeof *moments, compare);
    return moments;
}

static bool read_path(const struct reading *r, const struct gltf_chain *chain,
                      const struct gltf_tracks *tracks, struct file_camera *to, bool *usable)
{
    uint32_t count;
    double m[16];
    struct view_camera camera;
    struct moment *moments = choose_moments(tracks, chain->count, &count);
    bool added = moments != NULL;
    *usable = true;
    for (uint32_t i = 0; added && *usable && i < count; i++) {
        if (i > 0 && compare(&moments[i], &moments[i - 1]) == 0)
            continue;
        gltf_chain_matrix(r->file, chain, tracks, moments[i].seconds, moments[i].before, m);
        *usable = place(m, &to->camera, &camera);
        added = camera_path_add(&to->path, (float)moments[i].seconds, &camera);
    }
    if (!*usable)
        camera_path_finish(&to->path);
    free(moments);
    return added;
}

static const char *name_of(const cJSON *object)
{
    const char *name = cJSON_GetStringValue(member(object, "name"));
    return name && name[0] ? name : NULL;
}

static bool add(struct reading *r, const char *name, uint32_t number, const char *animation,
                const struct view_camera *camera, struct file_camera **added)
{
    char text[200];
    struct file_cameras *c = r->cameras;
    struct file_camera *items = realloc(c->items, (c->count + 1u) * sizeof *items);
    if (!items)
        return false;
    c->items = items;
    const int length = name ? snprintf(text, sizeof text, "%.90s", name)
                            : snprintf(text, sizeof text, "camera %u", number);
    if (animation)
        snprintf(text + length, sizeof text - (size_t)length, ": %.90s", animation);
    char *copy = malloc(strlen(text) + 1);
    if (!copy)
        return false;
    *added = &c->items[c->count++];
    **added = (struct file_camera){.name = strcpy(copy, text), .camera = *camera};
    return true;
}

/* Adds the paths of animations. The first path goes to the camera, each further one to a copy. */
static bool add_paths(struct reading *r, const struct gltf_chain *chain, const char *name,
                      uint32_t number, const struct view_camera *camera, struct file_camera *first)
{
    char text[32];
    bool read = true, is_first = true;
    for (uint32_t a = 0; read && a < r->file->lists[GLTF_ANIMATIONS].count; a++) {
        struct gltf_tracks tracks;
        const char *animation = name_of(r->file->lists[GLTF_ANIMATIONS].items[a]);
        bool usable = true;
        struct file_camera *to = first;
        if (!is_first && r->cameras->count >= GLTF_MOST_CAMERAS)
            break;
        read = gltf_read_tracks(r->file, a, chain, &tracks);
        if (read && tracks.count > 0) {
            snprintf(text, sizeof text, "animation %u", a);
            read = (is_first || add(r, name, number, animation ? animation : text, camera, &to)) &&
                   read_path(r, chain, &tracks, to, &usable);
            is_first = false;
        }
        if (!usable)
            r->note(r->user, animation ? animation : text, "moves a camera to where it cannot be");
        gltf_tracks_finish(&tracks);
    }
    return read;
}

static void find_chain(const struct reading *r, uint32_t node, struct gltf_chain *chain)
{
    chain->count = 0;
    for (uint32_t n = node; n != GLTF_NONE && chain->count <= GLTF_MAX_DEPTH; n = r->parents[n])
        chain->nodes[chain->count++] = n;
    for (uint32_t i = 0; i < chain->count / 2; i++) {
        const uint32_t swapped = chain->nodes[i];
        chain->nodes[i] = chain->nodes[chain->count - 1 - i];
        chain->nodes[chain->count - 1 - i] = swapped;
    }
}

static bool read_camera(struct reading *r, uint32_t node, uint32_t number)
{
    char where[64];
    double m[16];
    struct gltf_chain chain;
    struct view_camera lens, camera;
    struct file_camera *added;
    const cJSON *item = r->file->lists[GLTF_CAMERAS].items[number];
    const char *problem = read_lens(item, &lens);
    find_chain(r, node, &chain);
    gltf_chain_matrix(r->file, &chain, NULL, 0, false, m);
    if (!problem && !place(m, &lens, &camera))
        problem = "its node has no direction";
    if (problem) {
        snprintf(where, sizeof where, "cameras[%u]", number);
        r->note(r->user, where, problem);
        return true;
    }
    const char *name = name_of(r->file->lists[GLTF_NODES].items[node]);
    name = name ? name : name_of(item);
    return add(r, name, r->cameras->count, NULL, &camera, &added) &&
           add_paths(r, &chain, name, r->cameras->count - 1, &camera, added);
}

static void find_parents(struct reading *r)
{
    const struct gltf_list *nodes = &r->file->lists[GLTF_NODES];
    for (uint32_t i = 0; i < nodes->count; i++)
        r->parents[i] = GLTF_NONE;
    for (uint32_t i = 0; i < nodes->count; i++) {
        const cJSON *children = member(nodes->items[i], "children");
        for (const cJSON *c = children ? children->child : NULL; c; c = c->next)
            r->parents[(uint32_t)c->valuedouble] = i;
    }
}

bool gltf_read_cameras(struct gltf_file *file,
                       void (*note)(void *user, const char *where, const char *problem), void *user,
                       struct file_cameras *cameras)
{
    const uint32_t count = file->lists[GLTF_NODES].count;
    struct reading r = {file, note, user, cameras, malloc((count + 1u) * sizeof(uint32_t))};
    bool read = r.parents != NULL;
    *cameras = (struct file_cameras){0};
    if (read)
        find_parents(&r);
    for (uint32_t i = 0; read && i < count && cameras->count < GLTF_MOST_CAMERAS; i++) {
        const cJSON *camera = member(file->lists[GLTF_NODES].items[i], "camera");
        if (cJSON_IsNumber(camera))
            read = read_camera(&r, i, (uint32_t)camera->valuedouble);
    }
    free(r.parents);
    return read;
}
