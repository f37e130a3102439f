/** Animations of nodes in a glTF file: translation, rotation and scale. */
#ifndef SLUICE_VIEW_GLTF_ANIMATION_H
#define SLUICE_VIEW_GLTF_ANIMATION_H

#include "gltf_file.h"

#define GLTF_MOST_KEYS (1u << 20) /* per sampler */

enum gltf_track_path { TRACK_TRANSLATION, TRACK_ROTATION, TRACK_SCALE, TRACK_PATH_COUNT };
enum gltf_interpolation { TRACK_LINEAR, TRACK_STEP, TRACK_CUBIC, TRACK_INTERPOLATION_COUNT };

/** Values of a node's property at ascending times. */
struct gltf_track {
    uint32_t node;
    enum gltf_track_path path;
    enum gltf_interpolation interpolation;
    uint32_t count, components;
    double *times;  ///< owned
    double *values; ///< owned; TRACK_CUBIC: tangent in, value, tangent out
};

struct gltf_tracks {
    struct gltf_track *items; ///< owned
    uint32_t count;
};

/** A node and its ancestors, the root first. */
struct gltf_chain {
    uint32_t nodes[GLTF_MAX_DEPTH + 1];
    uint32_t count;
};

/** Finds a path or interpolation by its glTF name. Returns ..._COUNT for other names. */
enum gltf_track_path gltf_track_path_of(const char *name);
enum gltf_interpolation gltf_interpolation_of(const char *name);

/** Reads the tracks of an animation that move nodes of a chain. Uses the first track of each
 * property. False without memory. Always call gltf_tracks_finish. */
bool gltf_read_tracks(struct gltf_file *file, uint32_t animation, const struct gltf_chain *chain,
                      struct gltf_tracks *tracks);
void gltf_tracks_finish(struct gltf_tracks *tracks);
/** Writes a value of a track. The first and last key hold before and after the track. `before`:
 *  writes the value just before this time, where a step has not happened. Quaternions have length
 *  1. */
void gltf_track_at(const struct gltf_track *track, double seconds, bool before, double value[4]);
/** Writes the matrix from the last node of a chain to the world, column by column. */
void gltf_chain_matrix(const struct gltf_file *file, const struct gltf_chain *chain,
                       const struct gltf_tracks *tracks, double seconds, bool before,
                       double matrix[16]);

#endif /* SLUICE_VIEW_GLTF_ANIMATION_H */
