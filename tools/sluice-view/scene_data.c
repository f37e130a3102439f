#include "scene_data.h"

#include "played.h"
#include "scene_pbrt.h"

#include "../common/text.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void scene_data_note(struct scene_data *scene, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    text_say("sluice-view: %s", text);
    scene_data_keep_note(scene, text);
}

void scene_data_keep_note(struct scene_data *scene, const char *text)
{
    char *copy = scene->message_count < SCENE_MAX_MESSAGES ? malloc(strlen(text) + 1) : NULL;
    if (copy)
        scene->messages[scene->message_count++] = strcpy(copy, text);
}

bool scene_data_canceled(const struct scene_data *scene)
{
    return scene->progress && atomic_load(&scene->progress->canceled);
}

void scene_data_finish(struct scene_data *scene)
{
    for (uint32_t i = 0; i < scene->image_count; i++) {
        sluiceDestroyImageSource(scene->images[i].source);
        free(scene->images[i].name);
        free(scene->images[i].path);
    }
    sluiceDestroyImageOpener(scene->opener);
    scene_pbrt_close(scene->pbrt);
    played_close(scene->played);
    remote_end(&scene->remote);
    free(scene->name);
    free(scene->vertices);
    free(scene->indices);
    free(scene->parts);
    free(scene->images);
    free(scene->materials);
    free(scene->paints);
    for (uint32_t i = 0; i < scene->message_count; i++)
        free(scene->messages[i]);
    camera_path_finish(&scene->tour);
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        free(scene->cameras[i].name);
        camera_path_finish(&scene->cameras[i].path);
    }
    free(scene->cameras);
    *scene = (struct scene_data){0};
}

static void measure(struct scene_data *scene)
{
    struct vec3 low = {FLT_MAX, FLT_MAX, FLT_MAX}, high = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        const float *p = scene->vertices[i].position;
        low = (struct vec3){fminf(low.x, p[0]), fminf(low.y, p[1]), fminf(low.z, p[2])};
        high = (struct vec3){fmaxf(high.x, p[0]), fmaxf(high.y, p[1]), fmaxf(high.z, p[2])};
    }
    scene->bounds[0] = low;
    scene->bounds[1] = high;
}

/* The center of the part; parts that blend are drawn from far to near. */
static void find_center(const struct scene_data *scene, struct scene_part *part)
{
    struct vec3 low = {FLT_MAX, FLT_MAX, FLT_MAX}, high = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
    for (uint32_t i = 0; i < part->index_count; i++) {
        const float *p = scene->vertices[scene->indices[part->first_index + i]].position;
        low = (struct vec3){fminf(low.x, p[0]), fminf(low.y, p[1]), fminf(low.z, p[2])};
        high = (struct vec3){fmaxf(high.x, p[0]), fmaxf(high.y, p[1]), fmaxf(high.z, p[2])};
    }
    part->center = vec3_mix(low, high, 0.5f);
}

void scene_data_complete(struct scene_data *scene)
{
    measure(scene);
    for (uint32_t i = 0; i < scene->part_count; i++)
        find_center(scene, &scene->parts[i]);
    const struct vec3 center = vec3_mix(scene->bounds[0], scene->bounds[1], 0.5f);
    const struct vec3 half = vec3_sub(scene->bounds[1], center);
    const float distance = fmaxf(2.4f * sqrtf(vec3_dot(half, half)), 1e-3f);
    if (scene->camera.fov <= 0)
        scene->camera = view_camera_at(
            vec3_add(center, (struct vec3){0.35f * distance, 0.25f * distance, 0.9f * distance}),
            center, 0.9f);
    const bool has_tour = scene->tour.count > 0;
    for (int i = 0; !has_tour && i <= 24; i++) {
        const float angle = 6.2831853f * (float)i / 24;
        const struct vec3 eye = {center.x + 0.9f * distance * sinf(angle),
                                 center.y + 0.25f * distance,
                                 center.z + 0.9f * distance * cosf(angle)};
        const struct view_camera camera = view_camera_at(eye, center, 0.9f);
        if (!camera_path_add(&scene->tour, (float)i, &camera))
            break;
    }
}
