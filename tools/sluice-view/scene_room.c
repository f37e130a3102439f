/* strdup, realpath, strtok_r, strcasecmp */
#define _XOPEN_SOURCE 700

#include "scene_room.h"

#include <vulkan/vulkan_core.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PANELS 24u
#define STEP 2.4f /* meters from a panel to the next one on its side */
#define SIDE 1.9f /* meters; longest side of a panel */
#define TAU 6.2831853f

/* Parameters of a computed picture. Each seed makes a different picture. */
struct paint {
    float colors[3][3];
    float waves, turn;
};

static float fraction(float x)
{
    return x - floorf(x);
}

static float hash(uint32_t i)
{
    i = (i ^ 61u ^ i >> 16) * 9u;
    i = (i ^ i >> 4) * 0x27d4eb2du;
    return (float)((i ^ i >> 15) & 0xFFFFu) / 65535.0f;
}

/* Paints bands of waves and grids of ever finer lines. A coarse level shows fewer lines. */
static void paint_texel(void *user_data, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                        uint32_t height, float rgba[4])
{
    const struct paint *paint = user_data;
    const float u = ((float)x + 0.5f) / (float)width, v = ((float)y + 0.5f) / (float)height;
    const float texel = 1.0f / (float)(width < height ? width : height);
    const float along = u * cosf(paint->turn) + v * sinf(paint->turn);
    const float across = v * cosf(paint->turn) - u * sinf(paint->turn);
    const float wave =
        0.5f + 0.5f * sinf(TAU * paint->waves * (along + 0.13f * sinf(TAU * across * 2)));
    const float second = 0.5f + 0.5f * sinf(TAU * (across * paint->waves * 0.7f + along));
    float shade = 1.0f;
    (void)level;
    for (float lines = 8; lines <= 1024; lines *= 4) {
        const float wide = 0.10f / lines;
        if (wide < 0.7f * texel)
            break;
        const float du = fabsf(fraction(u * lines + 0.5f) - 0.5f) / lines;
        const float dv = fabsf(fraction(v * lines + 0.5f) - 0.5f) / lines;
        if (du < 0.5f * wide || dv < 0.5f * wide)
            shade *= 0.72f;
    }
    for (int c = 0; c < 3; c++) {
        const float mixed =
            paint->colors[0][c] + (paint->colors[1][c] - paint->colors[0][c]) * wave;
        rgba[c] = (mixed + (paint->colors[2][c] - mixed) * second * 0.45f) * shade;
    }
    rgba[3] = 1.0f;
}

static void choose_paint(uint32_t seed, struct paint *paint)
{
    const float hue = hash(seed * 7 + 1) * TAU;
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            paint->colors[k][c] = 0.42f + 0.34f * cosf(hue + (float)k * 1.9f + (float)c * 2.1f);
    paint->waves = 1.5f + 3.0f * hash(seed * 7 + 2);
    paint->turn = TAU * hash(seed * 7 + 3);
    if (seed >= PANELS)
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++)
                paint->colors[k][c] = (seed == PANELS ? 0.26f : 0.42f) + 0.03f * (float)k;
}

/* Adds picture `seed`: one of PANELS pictures, the floor or the walls. Its source points to
 * `paint`, which the scene frees after the source. */
static bool add_image(struct scene_data *scene, struct paint *paint, uint32_t seed)
{
    char name[32];
    const uint32_t i = seed;
    choose_paint(seed, paint);
    if (i < PANELS)
        snprintf(name, sizeof name, "picture %02u", i + 1);
    else
        snprintf(name, sizeof name, "%s", i == PANELS ? "floor" : "walls");
    const SluiceProceduralImage image = {paint, paint_texel};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = i % 5 == 4 ? 4096 : 2048,
                                  .height = i % 3 == 2 ? 4096 : 2048,
                                  .format = SLUICE_FORMAT_R8G8B8A8_SRGB,
                                  .pName = name};
    struct scene_image *added = &scene->images[scene->image_count++];
    added->name = strdup(name);
    added->path = strdup("");
    added->wrap_u = added->wrap_v = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    added->primary = SCENE_NO_IMAGE;
    return added->name && added->path &&
           sluiceCreateProceduralImageSource(&image, &info, NULL, &added->source) == SLUICE_SUCCESS;
}

/* Adds a quad, spanned by `right` and `down` from its top left corner. */
static void add_quad(struct scene_data *scene, struct vec3 corner, struct vec3 right,
                     struct vec3 down, uint32_t image, float repeat_u, float repeat_v)
{
    const uint32_t first = scene->vertex_count;
    const struct vec3 normal = vec3_normalize(vec3_cross(down, right));
    for (int i = 0; i < 4; i++) {
        const float u = (float)(i & 1), v = (float)(i >> 1);
        const struct vec3 at =
            vec3_add(corner, vec3_add(vec3_scale(right, u), vec3_scale(down, v)));
        scene->vertices[scene->vertex_count++] = (struct scene_vertex){
            {at.x, at.y, at.z}, {normal.x, normal.y, normal.z}, {{u * repeat_u, v * repeat_v}}};
    }
    static const uint32_t corners[6] = {0, 2, 1, 1, 2, 3};
    struct scene_material *material = &scene->materials[scene->material_count];
    scene_material_init(material);
    for (int i = 0; i < 3; i++)
        material->color[i] = 0.9f;
    material->slots[SLOT_COLOR].image = image;
    scene->parts[scene->part_count++] = (struct scene_part){
        .first_index = scene->index_count, .index_count = 6, .material = scene->material_count++};
    for (int i = 0; i < 6; i++)
        scene->indices[scene->index_count++] = first + corners[i];
}

/* Fits a panel to SIDE, keeping the proportions of its image. */
static void fit_panel(const struct scene_data *scene, uint32_t image, float *width, float *height)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    *width = *height = SIDE;
    if (image == SCENE_NO_IMAGE ||
        sluiceGetImageInfo(scene->images[image].source, &info) != SLUICE_SUCCESS)
        return;
    const float aspect = (float)info.width / (float)info.height;
    if (aspect < 1)
        *width = fmaxf(SIDE * aspect, 0.02f);
    else
        *height = fmaxf(SIDE / aspect, 0.02f);
}

static struct vec3 panel_center(uint32_t i)
{
    return (struct vec3){i % 2 == 0 ? -2.48f : 2.48f, 2.25f - SIDE / 2, -STEP * (float)(i / 2)};
}

static void add_panel(struct scene_data *scene, uint32_t i, uint32_t image)
{
    float width, height;
    const float toward = i % 2 == 0 ? -1.0f : 1.0f;
    fit_panel(scene, image, &width, &height);
    struct vec3 corner = panel_center(i);
    corner.y += height / 2;
    corner.z -= toward * width / 2;
    add_quad(scene, corner, (struct vec3){0, 0, toward * width}, (struct vec3){0, -height, 0},
             image, 1, 1);
    scene->materials[scene->material_count - 1].missing = image == SCENE_NO_IMAGE;
}

/* Adds floor and walls. Their images are the last two. */
static void add_walls(struct scene_data *scene, uint32_t panels)
{
    const float length = STEP * (float)((panels + 1) / 2) + 3.0f, front = 3.5f;
    const uint32_t floor = scene->image_count - 2, walls = floor + 1;
    add_quad(scene, (struct vec3){-2.5f, 0, front - length}, (struct vec3){5, 0, 0},
             (struct vec3){0, 0, length}, floor, 2, 2 * length / 5);
    add_quad(scene, (struct vec3){-2.5f, 2.8f, front}, (struct vec3){5, 0, 0},
             (struct vec3){0, 0, -length}, SCENE_NO_IMAGE, 1, 1);
    add_quad(scene, (struct vec3){-2.5f, 2.8f, front}, (struct vec3){0, 0, -length},
             (struct vec3){0, -2.8f, 0}, walls, length / 4, 1);
    add_quad(scene, (struct vec3){2.5f, 2.8f, front - length}, (struct vec3){0, 0, length},
             (struct vec3){0, -2.8f, 0}, walls, length / 4, 1);
    add_quad(scene, (struct vec3){-2.5f, 2.8f, front - length}, (struct vec3){5, 0, 0},
             (struct vec3){0, -2.8f, 0}, walls, 2, 1);
}

/* Adds a tour along the room and back. The camera looks to both sides. */
static bool add_tour(struct scene_data *scene)
{
    static const float stops[][4] = {
        /* seconds, z, yaw, pitch */
        {0, 2.6f, 0, -0.02f},    {4, -1.5f, 0.35f, 0},         {8, -6.0f, -0.75f, 0},
        {11, -8.5f, -1.35f, 0},  {15, -13.0f, 0.6f, 0},        {18, -17.0f, 1.3f, 0},
        {22, -22.0f, 0, -0.05f}, {25, -22.5f, -1.57f, 0},      {28, -20.0f, -3.14159f, 0},
        {40, 2.2f, -3.3f, 0},    {43, 2.6f, -6.28318f, -0.02f}};
    for (size_t i = 0; i < sizeof stops / sizeof *stops; i++) {
        const struct view_camera camera = {.position = {0, 1.5f, stops[i][1]},
                                           .yaw = stops[i][2],
                                           .pitch = stops[i][3],
                                           .fov = 1.0f};
        if (!camera_path_add(&scene->tour, stops[i][0], &camera))
            return false;
    }
    scene->camera = scene->tour.points[0].camera;
    return true;
}

/* Adds a tour that stops before each panel, and goes back. */
static bool add_tour_of(struct scene_data *scene, uint32_t panels)
{
    struct view_camera first = {0};
    float seconds = 0;
    for (uint32_t i = 0; i < panels; i++, seconds += 2.5f) {
        const struct vec3 center = panel_center(i);
        const struct vec3 eye = {0, 1.45f, center.z + 0.25f};
        const struct view_camera camera = view_camera_at(eye, center, 1.0f);
        if (i == 0)
            first = camera;
        if (!camera_path_add(&scene->tour, seconds, &camera) ||
            !camera_path_add(&scene->tour, seconds + 1.5f, &camera))
            return false;
    }
    scene->camera = first;
    return camera_path_add(&scene->tour, seconds + 0.2f * (float)panels, &first);
}

bool scene_room_allocate(struct scene_data *scene, const char *name, uint32_t panels)
{
    const size_t quads = (size_t)panels + 5;
    scene->name = strdup(name);
    scene->vertices = calloc(4 * quads, sizeof *scene->vertices);
    scene->indices = calloc(6 * quads, sizeof *scene->indices);
    scene->parts = calloc(quads, sizeof *scene->parts);
    scene->images = calloc((size_t)panels + 2, sizeof *scene->images);
    scene->materials = calloc(quads, sizeof *scene->materials);
    scene->paints = calloc((size_t)panels + 2, sizeof(struct paint));
    return scene->name && scene->vertices && scene->indices && scene->parts && scene->images &&
           scene->materials && scene->paints;
}

bool scene_room_hang(struct scene_data *scene, const uint32_t *images, uint32_t panels)
{
    struct paint *paints = scene->paints;
    if (!add_image(scene, &paints[panels], PANELS) ||
        !add_image(scene, &paints[panels + 1], PANELS + 1) ||
        (scene->tour.count == 0 && !add_tour_of(scene, panels)))
        return false;
    add_walls(scene, panels);
    for (uint32_t i = 0; i < panels; i++)
        add_panel(scene, i, images[i]);
    scene_data_complete(scene);
    return true;
}

bool scene_data_make_room(struct scene_data *scene)
{
    uint32_t images[PANELS];
    bool made = scene_room_allocate(scene, "room of computed pictures", PANELS) && add_tour(scene);
    for (uint32_t i = 0; made && i < PANELS; i++) {
        images[i] = i;
        made = add_image(scene, (struct paint *)scene->paints + i, i);
    }
    if (made && scene_room_hang(scene, images, PANELS))
        return true;
    fprintf(stderr, "sluice-view: out of memory\n");
    scene_data_finish(scene);
    return false;
}
