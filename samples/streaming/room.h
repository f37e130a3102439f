/** The gallery as triangles, lamps and a list of draw calls. Meters; y is up. */
#ifndef SAMPLES_STREAMING_ROOM_H
#define SAMPLES_STREAMING_ROOM_H

#include <stdbool.h>
#include <stdint.h>

#include "../common/vecmath.h"
#include "gallery_shared.h"
#include "pictures.h"

struct room_vertex {
    float position[3], normal[3], tangent[3], uv[2];
};

enum room_surface { ROOM_PLAIN, ROOM_FLOOR, ROOM_WALL, ROOM_PICTURE };

/** A draw call. */
struct room_part {
    enum room_surface surface;
    uint32_t picture; ///< index for ROOM_PICTURE
    uint32_t first_vertex, vertex_count;
    uint32_t lights[GALLERY_LIGHTS_PER_DRAW]; ///< lamps that reach the part
    float color[3];
    bool glowing;
};

/** Position and size of a picture. */
struct room_place {
    struct vec3 center, normal, right; ///< `right` as seen by a viewer
    float width, height;
};

struct room {
    float width, height, length; ///< x from -width/2 to width/2, z from 0 to -length
    struct room_place *places;   ///< owned; one per picture
    uint32_t place_count;
    struct GalleryLight *lights;  ///< owned; one per picture
    struct room_vertex *vertices; ///< owned; triangles
    uint32_t vertex_count, vertex_capacity;
    struct room_part *parts; ///< owned; pictures first, because they hide the most
    uint32_t part_count, part_capacity;
    bool out_of_memory;
};

#define ROOM_FLOOR_REPEAT 3.2f ///< size of one repeat of the floor's texture, in meters
#define ROOM_WALL_REPEAT 1.8f

/** Returns false when out of memory. */
bool room_build(const struct picture_list *pictures, struct room *room);
void room_finish(struct room *room);

#endif /* SAMPLES_STREAMING_ROOM_H */
