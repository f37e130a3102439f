#include "hall_geometry.h"

#include <assert.h>
#include <stdio.h>

#define PAINTINGS HALL_FLOOR
#define STEP 2.2f /* meters between paintings on a wall */

static const float wall = HALL_WALL, height = 3.0f, front = HALL_FRONT, back = HALL_BACK;

struct hall_picture hall_picture(uint32_t number)
{
    static const uint16_t sizes[PAINTINGS - 26][2] = {
        {4096, 4096}, {4096, 4096}, {4096, 4096}, {4096, 4096}, {4096, 2048},
        {4096, 2048}, {8192, 1024}, {3000, 2000}, {1920, 1080}, {1000, 1000},
        {4097, 33},   {64, 64},     {1, 257},     {2048, 2048}};
    struct hall_picture picture = {.number = number, .width = 2048, .height = 2048};
    if (number == HALL_FLOOR) {
        picture.width = picture.height = 4096;
        snprintf(picture.path, sizeof picture.path, "textures/floor_4096.png");
        return picture;
    }
    if (number >= 26) {
        picture.width = sizes[number - 26][0];
        picture.height = sizes[number - 26][1];
    }
    snprintf(picture.path, sizeof picture.path, "textures/panel_%02u_%ux%u.png", number,
             picture.width, picture.height);
    return picture;
}

void hall_add_quad(struct mesh *mesh, const float corner[3], const float right[3],
                   const float down[3])
{
    assert(mesh->count + 4 <= HALL_MOST_VERTICES);
    for (int v = 0; v < 4; v++) {
        struct vertex *at = &mesh->vertices[mesh->count++];
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const float normal = down[j] * right[k] - down[k] * right[j];
            at->position[i] = corner[i] + (v & 1 ? right[i] : 0) + (v >> 1 ? down[i] : 0);
            at->normal[i] = normal > 0 ? 1 : normal < 0 ? -1 : 0;
        }
        at->uv[0] = v & 1 ? 1 : 0;
        at->uv[1] = v >> 1 ? 1 : 0;
    }
}

/* Adds the two faces of a box that are perpendicular to each axis in `axes`. */
static void add_box(struct mesh *mesh, const float low[3], const float high[3], const char *axes)
{
    for (; *axes; axes++) {
        const int axis = *axes - 'x', j = (axis + 1) % 3, k = (axis + 2) % 3;
        float right[3] = {0}, down[3] = {0}, corner[3] = {low[0], low[1], low[2]};
        right[j] = high[j] - low[j];
        down[k] = high[k] - low[k];
        hall_add_quad(mesh, corner, right, down); /* face at `low` */
        corner[axis] = high[axis];
        hall_add_quad(mesh, corner, down, right);
    }
}

/* Adds the frame of a painting on the wall x = side * wall, with its center at (y, z). */
static void add_frame(struct mesh *mesh, float side, float y, float z, float half_height,
                      float half_width)
{
    const float wide = half_width > 0.3f ? 0.07f : 0.03f, deep = 0.1f;
    const float x0 = side < 0 ? -wall : wall - deep, x1 = x0 + deep;
    const float tops[2] = {y + half_height, y - half_height - wide};
    for (int i = 0; i < 2; i++)
        add_box(mesh, (float[]){x0, tops[i], z - half_width - wide},
                (float[]){x1, tops[i] + wide, z + half_width + wide}, "xyz");
    const float ends[2] = {z - half_width - wide, z + half_width};
    for (int i = 0; i < 2; i++)
        add_box(mesh, (float[]){x0, y - half_height, ends[i]},
                (float[]){x1, y + half_height, ends[i] + wide}, "xz");
}

/* Computes the largest size that fits, keeping proportions. Widens thin paintings. */
static void painting_size(uint32_t number, float *half_height, float *half_width)
{
    const struct hall_picture picture = hall_picture(number);
    const float aspect = (float)picture.width / (float)picture.height;
    *half_width = aspect < 1 ? 0.84f * aspect : 0.84f;
    *half_height = aspect < 1 ? 0.84f : 0.84f / aspect;
    *half_width = *half_width < 0.05f ? 0.05f : *half_width;
    *half_height = *half_height < 0.05f ? 0.05f : *half_height;
}

void hall_add_painting(struct mesh *mesh, struct mesh groups[GROUPS], uint32_t number)
{
    const float side = number % 2 ? 1 : -1, z = -STEP * (float)(number / 2), y = 1.3f;
    float half_height, half_width;
    painting_size(number, &half_height, &half_width);
    hall_add_quad(mesh, (float[]){side * 2.5f, y + half_height, z - side * half_width},
                  (float[]){0, 0, side * 2 * half_width}, (float[]){0, -2 * half_height, 0});
    add_frame(&groups[number % 3 == 1 ? WOOD : GOLD], side, y, z, half_height, half_width);
}

void hall_add_room(struct mesh groups[GROUPS])
{
    const float low[3] = {-wall, 0, back}, high[3] = {wall, height, front}, deep = back - front;
    hall_add_quad(&groups[WALLS], (float[]){-wall, height, front}, (float[]){0, 0, deep},
                  (float[]){0, -height, 0});
    hall_add_quad(&groups[WALLS], (float[]){wall, height, back}, (float[]){0, 0, -deep},
                  (float[]){0, -height, 0});
    hall_add_quad(&groups[WALLS], (float[]){-wall, height, back}, (float[]){2 * wall, 0, 0},
                  (float[]){0, -height, 0});
    hall_add_quad(&groups[WALLS], (float[]){wall, height, front}, (float[]){-2 * wall, 0, 0},
                  (float[]){0, -height, 0});
    hall_add_quad(&groups[CEILING], (float[]){-wall, height, front}, (float[]){2 * wall, 0, 0},
                  (float[]){0, 0, deep});
    for (float z = front - 2; z > back + 3; z -= 4) {
        hall_add_quad(&groups[SKYLIGHTS], (float[]){-0.95f, height - 0.01f, z},
                      (float[]){1.9f, 0, 0}, (float[]){0, 0, -2.2f});
        add_box(&groups[TRIM], (float[]){-1.03f, height - 0.05f, z},
                (float[]){1.03f, height, z + 0.08f}, "yz");
        add_box(&groups[TRIM], (float[]){-1.03f, height - 0.05f, z - 2.28f},
                (float[]){1.03f, height, z - 2.2f}, "yz");
        add_box(&groups[TRIM], (float[]){-1.03f, height - 0.05f, z - 2.2f},
                (float[]){-0.95f, height, z}, "xy");
        add_box(&groups[TRIM], (float[]){0.95f, height - 0.05f, z - 2.2f},
                (float[]){1.03f, height, z}, "xy");
    }
    static const float strips[2][3] = {{0, 0.14f, 0.03f}, {2.88f, 3.0f, 0.07f}};
    for (int i = 0; i < 2; i++) {
        const float bottom = strips[i][0], top = strips[i][1], thick = strips[i][2];
        add_box(&groups[TRIM], (float[]){low[0], bottom, back},
                (float[]){low[0] + thick, top, front}, "xy");
        add_box(&groups[TRIM], (float[]){high[0] - thick, bottom, back},
                (float[]){high[0], top, front}, "xy");
        add_box(&groups[TRIM], (float[]){low[0], bottom, back},
                (float[]){high[0], top, back + thick}, "yz");
    }
}
