#include "traced.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Host copy of a pixel's state. The ray of a pick changes this state. */
struct kept_pixel {
    float sum[4], latest[4];
    uint32_t place; ///< first entry of the list of pixels
    uint32_t list_index, missing_count;
};

static void keep(const struct film *film, uint32_t pixel, struct kept_pixel *kept)
{
    memcpy(kept->sum, (float(*)[4])film->sums.mapped + pixel, sizeof kept->sum);
    memcpy(kept->latest, (float(*)[4])film->latest.mapped + pixel, sizeof kept->latest);
    kept->list_index = film->list_index;
    kept->missing_count = film->missing_count;
}

static void give_back(struct film *film, uint32_t pixel, const struct kept_pixel *kept)
{
    memcpy((float(*)[4])film->sums.mapped + pixel, kept->sum, sizeof kept->sum);
    memcpy((float(*)[4])film->latest.mapped + pixel, kept->latest, sizeof kept->latest);
    film->list_index = kept->list_index;
    film->missing_count = kept->missing_count;
}

static bool trace_pixel(struct traced *t, const struct view_camera *camera, uint32_t pixel,
                        struct PbrtDebug *result)
{
    struct launches *l = &t->launches;
    struct PbrtDebug *debug = l->debug.mapped;
    struct kept_pixel kept;
    SluiceDemandTicket ticket;
    bool progress;
    uint32_t *list = (uint32_t *)t->film.lists.mapped +
                     (size_t)t->film.list_index * t->film.width * t->film.height;
    keep(&t->film, pixel, &kept);
    kept.place = *list;
    *list = pixel;
    t->film.missing_count = 1;
    *debug = (struct PbrtDebug){.pixel = pixel};
    l->constants = traced_constants(t, camera);
    const bool traced = launches_trace(l, 0, &ticket, &progress);
    *result = *debug;
    debug->pixel = PBRT_NONE;
    l->constants = t->constants;
    give_back(&t->film, pixel, &kept);
    *list = kept.place;
    return traced;
}

static void describe(struct traced *t, const struct PbrtDebug *debug, bool is_shape)
{
    const struct scene *scene = &t->pbrt->scene;
    t->picked[0] = '\0';
    if (!is_shape) {
        snprintf(t->picked, sizeof t->picked, "A box: what is in it is not built yet.");
        return;
    }
    const SluicePbrtShape shape = scene_shape(scene, t->world.places[debug->place].node.shape);
    const char *slash = strrchr(shape.pFile, '/');
    snprintf(t->picked, sizeof t->picked, "%s:%u, triangle %u; material \"%s\"; %.4g units away",
             slash ? slash + 1 : shape.pFile, shape.line, debug->triangle,
             scene_material(scene, shape.material).pType, (double)debug->distance);
}

static uint32_t texture_of_place(const struct traced *t, uint32_t place)
{
    const struct scene *scene = &t->pbrt->scene;
    const SluicePbrtShape shape = scene_shape(scene, t->world.places[place].node.shape);
    const SluicePbrtMaterial material = scene_material(scene, shape.material);
    const SluicePbrtValue *const values[] = {&material.diffuse, &material.specular,
                                             &material.transmission, &shape.alpha};
    uint32_t picture = UINT32_MAX;
    for (size_t i = 0; i < sizeof values / sizeof *values && picture == UINT32_MAX; i++)
        picture = scene_pbrt_picture_of(t->pbrt, values[i]);
    return picture == UINT32_MAX ? STAGE_NO_TEXTURE : picture;
}

/* Writes the center of a pixel, like startPixel in film.glsl for sample 0. */
static void point_of(const struct PbrtLaunch *c, uint32_t pixel, float distance, float point[3])
{
    const float x = ((float)(pixel % c->width) + 0.5f) / (float)c->width;
    const float y = ((float)(pixel / c->width) + 0.5f) / (float)c->height;
    const bool parallel = (c->flags & PBRT_LAUNCH_ORTHOGRAPHIC) != 0;
    float v[3], length = 0;
    for (int i = 0; i < 3; i++) {
        v[i] = c->corner[i] + x * c->right[i] + y * c->down[i];
        const float along = parallel ? c->forward[i] : v[i];
        length += along * along;
    }
    length = sqrtf(length);
    for (int i = 0; i < 3; i++)
        point[i] = c->eye[i] +
                   (parallel ? v[i] + distance * c->forward[i] / length : distance * v[i] / length);
}

struct stage_pick traced_pick(struct traced *t, const struct view_camera *camera, float x, float y)
{
    struct stage_pick pick = {.texture = STAGE_NO_TEXTURE};
    struct PbrtDebug debug;
    float point[3];
    if (t->film.width == 0 || !(x >= 0 && x < 1 && y >= 0 && y < 1))
        return pick;
    const uint32_t pixel = (uint32_t)(y * (float)t->film.height) * t->film.width +
                           (uint32_t)(x * (float)t->film.width);
    const struct PbrtLaunch constants = traced_constants(t, camera);
    if (!trace_pixel(t, camera, pixel, &debug) || debug.kind < 2)
        return pick;
    point_of(&constants, pixel, debug.distance, point);
    pick.hit = true;
    pick.position = pbrt_frame_position(&t->pbrt->frame, point);
    const bool is_shape = debug.kind == 3 && debug.place < t->world.place_count;
    if (is_shape)
        pick.texture = texture_of_place(t, debug.place);
    describe(t, &debug, is_shape);
    return pick;
}
