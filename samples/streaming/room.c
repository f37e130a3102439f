#include "room.h"

#include <stdlib.h>
#include <string.h>

#define ROOM_WIDTH 8.4f
#define ROOM_HEIGHT 4.4f
#define BAY_LENGTH 5.2f
#define ENTRANCE_LENGTH 2.6f
#define PICTURE_WIDTH 3.7f
#define PICTURE_HEIGHT 2.5f
#define PICTURE_CENTER 1.78f
#define PICTURE_DEPTH 0.035f ///< distance from the wall
#define FRAME_WIDTH 0.11f
#define FRAME_DEPTH 0.075f
#define LAMP_DISTANCE 1.9f

static const float gold[3] = {0.34f, 0.21f, 0.075f};
static const float dark_wood[3] = {0.045f, 0.030f, 0.022f};
static const float white[3] = {0.62f, 0.61f, 0.58f};
static const float brass[3] = {0.42f, 0.33f, 0.17f};

static struct room_vertex *add_vertices(struct room *room, uint32_t count)
{
    if (room->vertex_count + count > room->vertex_capacity) {
        uint32_t capacity = 2 * room->vertex_capacity + 1024;
        struct room_vertex *vertices = realloc(room->vertices, capacity * sizeof *vertices);
        if (!vertices) {
            room->out_of_memory = true;
            return NULL;
        }
        room->vertices = vertices;
        room->vertex_capacity = capacity;
    }
    room->vertex_count += count;
    return room->vertices + room->vertex_count - count;
}

static struct room_part *begin_part(struct room *room, enum room_surface surface,
                                    const float color[3], uint32_t bay)
{
    if (room->part_count == room->part_capacity) {
        uint32_t capacity = 2 * room->part_capacity + 64;
        struct room_part *parts = realloc(room->parts, capacity * sizeof *parts);
        if (!parts) {
            room->out_of_memory = true;
            return NULL;
        }
        room->parts = parts;
        room->part_capacity = capacity;
    }
    struct room_part *part = &room->parts[room->part_count++];
    *part = (struct room_part){.surface = surface, .first_vertex = room->vertex_count};
    memcpy(part->color, color, sizeof part->color);
    for (uint32_t i = 0; i < GALLERY_LIGHTS_PER_DRAW; i++)
        part->lights[i] = bay;
    return part;
}

static void end_part(struct room *room)
{
    struct room_part *part = &room->parts[room->part_count - 1];
    part->vertex_count = room->vertex_count - part->first_vertex;
}

/** Adds a quad. Corners are counter-clockwise as seen from the front, from the lower left. */
static void add_quad(struct room *room, const struct vec3 corners[4], const float uv[4][2])
{
    static const int order[6] = {0, 1, 2, 0, 2, 3};
    struct room_vertex *vertices = add_vertices(room, 6);
    if (!vertices)
        return;
    struct vec3 along = vec3_normalize(vec3_sub(corners[1], corners[0]));
    struct vec3 normal = vec3_normalize(vec3_cross(along, vec3_sub(corners[3], corners[0])));
    for (int i = 0; i < 6; i++) {
        struct vec3 p = corners[order[i]];
        vertices[i] = (struct room_vertex){
            {p.x, p.y, p.z},
            {normal.x, normal.y, normal.z},
            {along.x, along.y, along.z},
            {uv[order[i]][0], uv[order[i]][1]},
        };
    }
}

static const float no_uv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

/** Adds the six faces of a box between two corners. */
static void add_box(struct room *room, struct vec3 low, struct vec3 high)
{
    const struct vec3 c[8] = {
        {low.x, low.y, high.z},  {high.x, low.y, high.z}, {high.x, high.y, high.z},
        {low.x, high.y, high.z}, {low.x, low.y, low.z},   {high.x, low.y, low.z},
        {high.x, high.y, low.z}, {low.x, high.y, low.z},
    };
    static const int faces[6][4] = {{0, 1, 2, 3}, {5, 4, 7, 6}, {4, 0, 3, 7},
                                    {1, 5, 6, 2}, {3, 2, 6, 7}, {4, 5, 1, 0}};
    for (int i = 0; i < 6; i++) {
        const struct vec3 corners[4] = {c[faces[i][0]], c[faces[i][1]], c[faces[i][2]],
                                        c[faces[i][3]]};
        add_quad(room, corners, no_uv);
    }
}

/** Returns a point in front of a picture: x to the right, y up, z towards the viewer. */
static struct vec3 before(const struct room_place *place, float x, float y, float z)
{
    struct vec3 p = vec3_add(place->center, vec3_scale(place->right, x));
    p.y += y;
    return vec3_add(p, vec3_scale(place->normal, z));
}

static void add_canvas(struct room *room, uint32_t index)
{
    const struct room_place *place = &room->places[index];
    float x = 0.5f * place->width, y = 0.5f * place->height, z = PICTURE_DEPTH;
    const struct vec3 corners[4] = {before(place, -x, -y, z), before(place, x, -y, z),
                                    before(place, x, y, z), before(place, -x, y, z)};
    static const float uv[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}}; /* row 0 is on top */
    struct room_part *part = begin_part(room, ROOM_PICTURE, white, index);
    if (!part)
        return;
    part->picture = index;
    add_quad(room, corners, uv);
    end_part(room);
}

/** Adds two mitred strips per step of the profile, around the picture. */
static void add_frame(struct room *room, uint32_t index)
{
    /* distance from the picture's edge, height over the wall */
    static const float profile[6][2] = {{-0.01f, PICTURE_DEPTH + 0.002f},
                                        {0.02f, 0.055f},
                                        {0.045f, 0.05f},
                                        {0.075f, FRAME_DEPTH},
                                        {0.10f, FRAME_DEPTH - 0.008f},
                                        {FRAME_WIDTH, 0.0f}};
    static const float corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const struct room_place *place = &room->places[index];
    if (!begin_part(room, ROOM_PLAIN, index % 3 == 1 ? dark_wood : gold, index))
        return;
    for (int side = 0; side < 4; side++)
        for (int step = 0; step < 5; step++) {
            struct vec3 corners[4];
            for (int i = 0; i < 4; i++) {
                const float *sign = corner[i == 0 || i == 3 ? side : (side + 1) % 4];
                const float *at = profile[i < 2 ? step + 1 : step];
                corners[i] = before(place, sign[0] * (0.5f * place->width + at[0]),
                                    sign[1] * (0.5f * place->height + at[0]), at[1]);
            }
            add_quad(room, corners, no_uv);
        }
    end_part(room);
}

/** Adds a small brass plate under the right corner, and the lamp at the ceiling. */
static void add_fittings(struct room *room, uint32_t index)
{
    const struct room_place *place = &room->places[index];
    float x = 0.5f * place->width + FRAME_WIDTH + 0.16f, y = -0.5f * place->height + 0.05f;
    if (!begin_part(room, ROOM_PLAIN, brass, index))
        return;
    const struct vec3 plate[4] = {before(place, x, y, 0.008f), before(place, x + 0.16f, y, 0.008f),
                                  before(place, x + 0.16f, y + 0.1f, 0.008f),
                                  before(place, x, y + 0.1f, 0.008f)};
    add_quad(room, plate, no_uv);
    end_part(room);
    if (!begin_part(room, ROOM_PLAIN, dark_wood, index))
        return;
    const float *p = room->lights[index].position;
    add_box(room, (struct vec3){p[0] - 0.07f, p[1] + 0.03f, p[2] - 0.07f},
            (struct vec3){p[0] + 0.07f, ROOM_HEIGHT, p[2] + 0.07f});
    end_part(room);
}

/** Places picture 0 on the end wall, and the others left and right in turn. */
static struct room_place place_picture(const struct room *room, const SluiceImageInfo *info,
                                       uint32_t index)
{
    float aspect = (float)info->width / (float)info->height;
    struct room_place place = {.width = PICTURE_WIDTH, .height = PICTURE_WIDTH / aspect};
    if (place.height > PICTURE_HEIGHT) {
        place.height = PICTURE_HEIGHT;
        place.width = PICTURE_HEIGHT * aspect;
    }
    place.height = fmaxf(place.height, 0.1f);
    place.width = fmaxf(place.width, 0.1f);
    if (index == 0) {
        place.center = (struct vec3){0, PICTURE_CENTER, -room->length};
        place.normal = (struct vec3){0, 0, 1};
        place.right = (struct vec3){1, 0, 0};
        return place;
    }
    bool left = index % 2 == 1;
    float bay = (float)((index - 1) / 2);
    place.center = (struct vec3){left ? -0.5f * ROOM_WIDTH : 0.5f * ROOM_WIDTH, PICTURE_CENTER,
                                 -ENTRANCE_LENGTH - (bay + 0.5f) * BAY_LENGTH};
    place.normal = (struct vec3){left ? 1.0f : -1.0f, 0, 0};
    place.right = (struct vec3){0, 0, left ? -1.0f : 1.0f};
    return place;
}

static struct GalleryLight place_light(const struct room_place *place)
{
    struct vec3 position = vec3_add(place->center, vec3_scale(place->normal, LAMP_DISTANCE));
    position.y = ROOM_HEIGHT - 0.25f;
    struct vec3 direction = vec3_normalize(vec3_sub(place->center, position));
    float reach = 0.5f * sqrtf(place->width * place->width + place->height * place->height);
    float angle = atanf((reach + 0.05f) / 3.2f);
    return (struct GalleryLight){{position.x, position.y, position.z},
                                 cosf(angle + 0.30f),
                                 {direction.x, direction.y, direction.z},
                                 cosf(angle * 0.92f)};
}

/** Sets the lamps of a bay on one side, and those of its neighbors on the same wall. */
static void set_wall_lights(const struct room *room, struct room_part *part, int32_t bay, bool left)
{
    for (int32_t i = 0; i < GALLERY_LIGHTS_PER_DRAW; i++) {
        int32_t index = 1 + 2 * (bay + i - 1) + (left ? 0 : 1);
        part->lights[i] =
            index >= 1 && index < (int32_t)room->place_count ? (uint32_t)index : GALLERY_NO_TEXTURE;
    }
}

static void add_side_wall(struct room *room, bool left, int32_t bay, float from, float to)
{
    float x = left ? -0.5f * ROOM_WIDTH : 0.5f * ROOM_WIDTH;
    float begin = left ? from : to, end = left ? to : from;
    const struct vec3 corners[4] = {
        {x, 0, begin}, {x, 0, end}, {x, ROOM_HEIGHT, end}, {x, ROOM_HEIGHT, begin}};
    float u0 = (left ? -begin : begin) / ROOM_WALL_REPEAT,
          u1 = (left ? -end : end) / ROOM_WALL_REPEAT;
    const float top = 0.0f, bottom = ROOM_HEIGHT / ROOM_WALL_REPEAT;
    const float uv[4][2] = {{u0, bottom}, {u1, bottom}, {u1, top}, {u0, top}};
    struct room_part *part = begin_part(room, ROOM_WALL, white, 0);
    if (!part)
        return;
    set_wall_lights(room, part, bay, left);
    add_quad(room, corners, uv);
    end_part(room);
}

static void add_end_wall(struct room *room, bool far)
{
    float half = 0.5f * ROOM_WIDTH, side = far ? 1.0f : -1.0f, z = far ? -room->length : 0.0f;
    const struct vec3 corners[4] = {{-half * side, 0, z},
                                    {half * side, 0, z},
                                    {half * side, ROOM_HEIGHT, z},
                                    {-half * side, ROOM_HEIGHT, z}};
    const float u = half / ROOM_WALL_REPEAT, bottom = ROOM_HEIGHT / ROOM_WALL_REPEAT;
    const float uv[4][2] = {{-u, bottom}, {u, bottom}, {u, 0}, {-u, 0}};
    struct room_part *part = begin_part(room, ROOM_WALL, white, 0);
    if (!part)
        return;
    for (uint32_t i = far ? 1 : 0; i < GALLERY_LIGHTS_PER_DRAW; i++)
        part->lights[i] = GALLERY_NO_TEXTURE;
    add_quad(room, corners, uv);
    end_part(room);
}

static void add_floor(struct room *room, int32_t bay, float from, float to)
{
    float half = 0.5f * ROOM_WIDTH;
    const struct vec3 corners[4] = {
        {-half, 0, from}, {half, 0, from}, {half, 0, to}, {-half, 0, to}};
    const float u = half / ROOM_FLOOR_REPEAT;
    const float v0 = -from / ROOM_FLOOR_REPEAT, v1 = -to / ROOM_FLOOR_REPEAT;
    const float uv[4][2] = {{-u, v0}, {u, v0}, {u, v1}, {-u, v1}};
    struct room_part *part = begin_part(room, ROOM_FLOOR, white, 0);
    if (!part)
        return;
    for (uint32_t i = 0; i < GALLERY_LIGHTS_PER_DRAW; i++)
        part->lights[i] = GALLERY_NO_TEXTURE;
    for (int32_t i = 0; i < 2; i++) {
        int32_t index = 1 + 2 * bay + i;
        if (index >= 1 && index < (int32_t)room->place_count)
            part->lights[i] = (uint32_t)index;
    }
    if (to <= -room->length)
        part->lights[2] = 0;
    add_quad(room, corners, uv);
    end_part(room);
}

static void add_ceiling(struct room *room)
{
    float half = 0.5f * ROOM_WIDTH, h = ROOM_HEIGHT, end = -room->length;
    if (!begin_part(room, ROOM_PLAIN, white, GALLERY_NO_TEXTURE))
        return;
    const struct vec3 corners[4] = {{-half, h, end}, {half, h, end}, {half, h, 0}, {-half, h, 0}};
    add_quad(room, corners, no_uv);
    end_part(room);

    static const float sky[3] = {0.95f, 1.0f, 1.08f};
    struct room_part *part = begin_part(room, ROOM_PLAIN, sky, GALLERY_NO_TEXTURE);
    if (!part)
        return;
    part->glowing = true;
    for (float z = -1.0f; z - 1.7f > end; z -= 2.6f) {
        const struct vec3 pane[4] = {{-1.1f, h - 0.01f, z - 1.7f},
                                     {1.1f, h - 0.01f, z - 1.7f},
                                     {1.1f, h - 0.01f, z},
                                     {-1.1f, h - 0.01f, z}};
        add_quad(room, pane, no_uv);
    }
    end_part(room);
}

static void add_skirting_and_benches(struct room *room)
{
    float half = 0.5f * ROOM_WIDTH, end = -room->length;
    if (!begin_part(room, ROOM_PLAIN, white, GALLERY_NO_TEXTURE))
        return;
    for (int side = -1; side <= 1; side += 2) {
        float wall = (float)side * half, inner = wall - (float)side * 0.03f;
        add_box(room, (struct vec3){fminf(wall, inner), 0, end},
                (struct vec3){fmaxf(wall, inner), 0.16f, 0});
        inner = wall - (float)side * 0.09f;
        add_box(room, (struct vec3){fminf(wall, inner), ROOM_HEIGHT - 0.12f, end},
                (struct vec3){fmaxf(wall, inner), ROOM_HEIGHT, 0});
    }
    add_box(room, (struct vec3){-half, 0, end}, (struct vec3){half, 0.16f, end + 0.03f});
    add_box(room, (struct vec3){-half, ROOM_HEIGHT - 0.12f, end},
            (struct vec3){half, ROOM_HEIGHT, end + 0.09f});
    end_part(room);

    if (!begin_part(room, ROOM_PLAIN, dark_wood, GALLERY_NO_TEXTURE))
        return;
    for (float z = -ENTRANCE_LENGTH - 0.5f * BAY_LENGTH; z - 1.0f > end; z -= BAY_LENGTH) {
        add_box(room, (struct vec3){-0.3f, 0.4f, z - 0.85f}, (struct vec3){0.3f, 0.48f, z + 0.85f});
        add_box(room, (struct vec3){-0.24f, 0, z - 0.72f}, (struct vec3){0.24f, 0.4f, z - 0.62f});
        add_box(room, (struct vec3){-0.24f, 0, z + 0.62f}, (struct vec3){0.24f, 0.4f, z + 0.72f});
    }
    end_part(room);
}

static void add_everything(struct room *room, int32_t bay_count)
{
    for (uint32_t i = 0; i < room->place_count; i++)
        add_canvas(room, i);
    for (uint32_t i = 0; i < room->place_count; i++) {
        add_frame(room, i);
        add_fittings(room, i);
    }
    add_skirting_and_benches(room);
    for (int32_t bay = -1; bay <= bay_count; bay++) {
        float from = bay < 0 ? 0.0f : -ENTRANCE_LENGTH - (float)bay * BAY_LENGTH;
        float to =
            bay == bay_count ? -room->length : -ENTRANCE_LENGTH - (float)(bay + 1) * BAY_LENGTH;
        add_side_wall(room, true, bay, from, to);
        add_side_wall(room, false, bay, from, to);
        add_floor(room, bay, from, to);
    }
    add_end_wall(room, true);
    add_end_wall(room, false);
    add_ceiling(room);
}

bool room_build(const struct picture_list *pictures, struct room *room)
{
    int32_t bay_count = (int32_t)(pictures->count / 2);
    *room = (struct room){.width = ROOM_WIDTH, .height = ROOM_HEIGHT};
    room->length = 2.0f * ENTRANCE_LENGTH + (float)bay_count * BAY_LENGTH;
    room->place_count = pictures->count;
    room->places = calloc(pictures->count, sizeof *room->places);
    room->lights = calloc(pictures->count, sizeof *room->lights);
    room->out_of_memory = !room->places || !room->lights;
    if (!room->out_of_memory) {
        for (uint32_t i = 0; i < pictures->count; i++) {
            room->places[i] = place_picture(room, &pictures->pictures[i].info, i);
            room->lights[i] = place_light(&room->places[i]);
        }
        add_everything(room, bay_count);
    }
    if (room->out_of_memory)
        room_finish(room);
    return room->place_count > 0;
}

void room_finish(struct room *room)
{
    free(room->places);
    free(room->lights);
    free(room->vertices);
    free(room->parts);
    *room = (struct room){0};
}
