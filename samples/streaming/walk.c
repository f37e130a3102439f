#include "walk.h"

#define STATION_COUNT 8

struct station {
    float at; ///< progress
    struct camera camera;
};

/** Returns the picture's place, or that of the last one if there is no such picture. */
static const struct room_place *place_of(const struct room *room, uint32_t index)
{
    return &room->places[index < room->place_count ? index : room->place_count - 1];
}

/** Returns a point in front of a picture: x and y in units of its half size, z in meters from the
 * wall. */
static struct vec3 spot(const struct room_place *place, float x, float y, float z)
{
    struct vec3 p = vec3_add(place->center, vec3_scale(place->right, 0.5f * x * place->width));
    p.y += 0.5f * y * place->height;
    return vec3_add(p, vec3_scale(place->normal, z));
}

/* Stations of the walk: to the first picture on the left until its finest level shows, past the
 * next ones, to one on the right, and to rest beside the last but one on the left, seen along the
 * wall. */
static void make_stations(const struct room *room, struct station stations[STATION_COUNT])
{
    const struct room_place *first = place_of(room, 1), *second = place_of(room, 2);
    const struct room_place *far_left = place_of(room, 3), *last = place_of(room, 0);
    const struct room_place *right = place_of(room, 4);
    const struct vec3 entrance = {0.9f, 1.66f, -0.5f};
    const struct station made[STATION_COUNT] = {
        {0.00f, {entrance, {-0.4f, 1.6f, -room->length}}},
        {0.16f, {spot(first, -0.3f, 0.0f, 1.9f), spot(first, 0.0f, -0.02f, 0.0f)}},
        {0.32f, {spot(first, 0.28f, 0.30f, 0.36f), spot(first, 0.34f, 0.36f, 0.0f)}},
        {0.46f, {spot(first, 0.9f, 0.05f, 2.3f), spot(second, 0.2f, 0.0f, 0.0f)}},
        {0.60f, {spot(right, -0.2f, 0.0f, 2.2f), spot(right, 0.0f, 0.0f, 0.0f)}},
        {0.74f, {spot(right, 0.3f, -0.2f, 0.45f), spot(right, 0.2f, -0.25f, 0.0f)}},
        {0.87f,
         {spot(far_left, -0.7f, 0.1f, 3.4f), vec3_mix(last->center, far_left->center, 0.3f)}},
        {1.00f, {spot(far_left, -1.15f, 0.0f, 1.35f), spot(far_left, 0.55f, -0.04f, 0.1f)}},
    };
    for (int i = 0; i < STATION_COUNT; i++)
        stations[i] = made[i];
}

struct camera walk_camera(const struct room *room, float progress)
{
    struct station stations[STATION_COUNT];
    make_stations(room, stations);
    int next = 1;
    while (next < STATION_COUNT - 1 && progress > stations[next].at)
        next++;
    const struct station *a = &stations[next - 1], *b = &stations[next];
    float t = (progress - a->at) / (b->at - a->at);
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    /* Slows down smoothly at each station, but abruptly at the last, which is harder to follow. */
    t = next < STATION_COUNT - 1 ? t * t * t * (t * (6.0f * t - 15.0f) + 10.0f)
                                 : t * t * (2.0f - t);
    return (struct camera){vec3_mix(a->camera.eye, b->camera.eye, t),
                           vec3_mix(a->camera.target, b->camera.target, t)};
}
