/** A scene as triangles with streamed textures, in memory of the host. */
#ifndef SLUICE_VIEW_SCENE_DATA_H
#define SLUICE_VIEW_SCENE_DATA_H

#include "camera.h"

#include <sluice/open.h>

#include <stdbool.h>
#include <stdint.h>

#define SCENE_NO_IMAGE UINT32_MAX

struct scene_vertex {
    float position[3], normal[3], uv[2];
};

/** Triangles of one material. */
struct scene_part {
    uint32_t first_index, index_count;
    uint32_t image; ///< SCENE_NO_IMAGE: only the color
    float color[4];
};

struct scene_image {
    char *name;                ///< owned
    char *path;                ///< owned; "" if it is computed
    SluiceImageSource *source; ///< owned
    int wrap_u, wrap_v;        ///< VkSamplerAddressMode
};

struct scene_data {
    char *name;                    ///< owned
    struct scene_vertex *vertices; ///< owned, as all below
    uint32_t *indices;
    struct scene_part *parts;
    struct scene_image *images;
    uint32_t vertex_count, index_count, part_count, image_count;
    struct vec3 bounds[2];
    struct view_camera camera;
    struct camera_path tour;
    void *paints;              ///< of computed images
    SluiceImageOpener *opener; ///< owned; of images from files
};

/** A room hung with computed pictures: needs no file. False without memory. */
bool scene_data_make_room(struct scene_data *scene);
/** A zeroed struct is fine. */
void scene_data_finish(struct scene_data *scene);
/** Bounds of all vertices; a camera and a tour around them, where there are none. */
void scene_data_complete(struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_DATA_H */
