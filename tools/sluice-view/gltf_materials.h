/** Materials and images of a glTF file. */
#ifndef SLUICE_VIEW_GLTF_MATERIALS_H
#define SLUICE_VIEW_GLTF_MATERIALS_H

#include "gltf_file.h"
#include "scene_material.h"

/** An image of the file: a path, bytes, or neither. */
struct gltf_image {
    const char *uri;         ///< owned by the file; NULL: the image has bytes
    struct gltf_bytes bytes; ///< free `bytes.owned`
    const char *problem;     ///< why the image cannot be shown; NULL: it can
};

/** A texture: image and sampler. */
struct gltf_texture {
    uint32_t image;     ///< GLTF_NONE: no readable image
    uint32_t fallback;  ///< shown if `image` cannot be read; GLTF_NONE: none
    bool is_dds;        ///< MSFT_texture_dds names `image`
    int wrap_u, wrap_v; ///< VkSamplerAddressMode
    const char *problem;
};

/** Reads a material. The image of each slot is the index of a texture of the file. False, with
 *  `error` set, on failure. */
bool gltf_read_material(struct gltf_file *file, uint32_t index, struct scene_material *material);
/** Reads a texture. `index`: below the count of GLTF_TEXTURES. */
struct gltf_texture gltf_read_texture(const struct gltf_file *file, uint32_t index);
struct gltf_image gltf_read_image(const struct gltf_file *file, uint32_t index);
/** Calls `say` once for each extension that the file uses and the viewer does not support. */
void gltf_name_extensions(const struct gltf_file *file,
                          void (*say)(void *user, const char *extension, bool required),
                          void *user);

#endif /* SLUICE_VIEW_GLTF_MATERIALS_H */
