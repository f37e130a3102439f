/** A scene in host memory: triangles with streamed textures. */
#ifndef SLUICE_VIEW_SCENE_DATA_H
#define SLUICE_VIEW_SCENE_DATA_H

#include "camera.h"
#include "scene_material.h"

#include "../common/remote.h"

#include <sluice/manager.h>
#include <sluice/open.h>

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define SCENE_MAX_MESSAGES 64u

struct played;
struct scene_pbrt;

struct scene_vertex {
    float position[3], normal[3], uv[2][2];
};

/** Triangles of one material. */
struct scene_part {
    uint32_t first_index, index_count;
    uint32_t material;
    struct vec3 center;
};

/** Meaning of an image's texels: how its coarser levels are made, and whether they are sRGB. */
enum scene_content { CONTENT_COLORS, CONTENT_NUMBERS, CONTENT_NORMALS, CONTENT_COUNT };

struct scene_image {
    char *name;                ///< owned
    char *path;                ///< owned; "" if it is computed
    SluiceImageSource *source; ///< owned
    int wrap_u, wrap_v;        ///< VkSamplerAddressMode
    enum scene_content content;
    /** Image whose feedback this image follows; SCENE_NO_IMAGE: none. A primary follows none. */
    uint32_t primary;
    bool transformed;            ///< UVs differ from those of the primary
    SluiceUvTransform transform; ///< relative to the primary
};

/** Progress of a load, shared with the thread that opens the scene. */
struct scene_progress {
    atomic_uint done, total;         ///< images
    atomic_bool canceled;            ///< the thread opens no more images
    atomic_uint_least64_t read_size; ///< bytes read of the text of a pbrt scene
    atomic_uint percent;             ///< 1 + percent played of a recording; 0: no recording
};

struct scene_data {
    char *name;                    ///< owned
    struct scene_vertex *vertices; ///< owned, as all below
    uint32_t *indices;
    struct scene_part *parts;
    struct scene_image *images;
    struct scene_material *materials;
    uint32_t vertex_count, index_count, part_count, image_count, material_count;
    char *messages[SCENE_MAX_MESSAGES]; ///< owned: what is missing or not supported
    uint32_t message_count;
    struct vec3 bounds[2];
    struct view_camera camera;
    struct camera_path tour;
    struct file_camera *cameras; ///< owned
    uint32_t camera_count;
    void *paints;                    ///< owned; data of computed images
    SluiceImageOpener *opener;       ///< owned; opens images from files
    struct remote_session remote;    ///< owned; reads images from servers
    struct scene_pbrt *pbrt;         ///< owned; traced scene, without triangles here; or NULL
    struct played *played;           ///< owned; recording, shown instead of a scene; or NULL
    struct scene_progress *progress; ///< borrowed while the scene is opened; NULL: none
};

/** Fills a zeroed scene with a room of computed pictures. Reads no file. False without memory. */
bool scene_data_make_room(struct scene_data *scene);
/** Frees the scene. A zeroed struct is allowed. */
void scene_data_finish(struct scene_data *scene);
/** Writes a message about the scene to stderr, and keeps it for the panels. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void
scene_data_note(struct scene_data *scene, const char *format, ...);
/** Keeps a message for the panels that stderr has already. */
void scene_data_keep_note(struct scene_data *scene, const char *text);
/** Finds images that can follow the color image of their material (scene_sets.c). */
void scene_data_find_sets(struct scene_data *scene);
/** Returns true if the load was canceled. */
bool scene_data_canceled(const struct scene_data *scene);
/** Computes bounds and centers. Adds a camera and a tour if the scene has none. */
void scene_data_complete(struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_DATA_H */
