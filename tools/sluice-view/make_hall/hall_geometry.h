/** Geometry of the hall: meshes of quads, in meters. */
#ifndef SLUICE_VIEW_HALL_GEOMETRY_H
#define SLUICE_VIEW_HALL_GEOMETRY_H

#include <stdint.h>

#define HALL_FLOOR 40u            ///< number of the floor; paintings have smaller numbers
#define HALL_WALL 2.56f           ///< half the distance between the long walls
#define HALL_FRONT 5.0f           ///< z of the wall behind the first camera position
#define HALL_BACK (-45.0f)        ///< z of the wall at the far end
#define HALL_MOST_VERTICES 32768u ///< vertices per mesh

/** Materials of meshes without pictures. */
enum hall_group { WALLS, CEILING, SKYLIGHTS, GOLD, WOOD, TRIM, GROUPS };

struct hall_picture {
    uint32_t number, width, height;
    char path[64]; ///< from the folder of the scene
};

struct vertex {
    float position[3], normal[3], uv[2];
};

/** A mesh of quads, with four vertices each. */
struct mesh {
    struct vertex *vertices; ///< HALL_MOST_VERTICES
    uint32_t count;
};

/** Returns painting `number`, or the floor for HALL_FLOOR. */
struct hall_picture hall_picture(uint32_t number);

/** Adds a quad. `corner`: its top left corner, seen from the front. `right` and `down` are parallel
 *  to axes. UVs are 0 to 1. */
void hall_add_quad(struct mesh *mesh, const float corner[3], const float right[3],
                   const float down[3]);

/** Adds painting `number` to `mesh` and its frame to a mesh of `groups`. */
void hall_add_painting(struct mesh *mesh, struct mesh groups[GROUPS], uint32_t number);

/** Adds walls with their trim, the ceiling and its skylights. */
void hall_add_room(struct mesh groups[GROUPS]);

#endif /* SLUICE_VIEW_HALL_GEOMETRY_H */
