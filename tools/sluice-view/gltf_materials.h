/** Materials and images of a glTF file. */
#ifndef SLUICE_VIEW_GLTF_MATERIALS_H
#define SLUICE_VIEW_GLTF_MATERIALS_H

#include "gltf_file.h"
#include "scene_material.h"

/** An image as the file has it: a path, bytes, or neither. */
struct gltf_image {
    const char *uri;         ///< belongs to the file; NULL: bytes
    struct gltf_bytes bytes; ///< `owned` must be freed
    const char *problem;     ///< why it cannot be shown; NULL: nothing
};

/** A texture: image and sampler. */
struct gltf_texture {
    uint32_t image;     ///< GLTF_NONE: it names none that can be read
    uint32_t fallback;  ///< image to show if `image` cannot be; GLTF_NONE: none
    bool is_dds;        ///< `image` is that of MSFT_texture_dds
    int wrap_u, wrap_v; ///< VkSamplerAddressMode
    const char *problem;
};

/** Slots have the number of a texture of the file as their image. False with `error`. */
bool gltf_read_material(struct gltf_file *file, uint32_t index, struct scene_material *material);
/** Index is below the count of GLTF_TEXTURES. */
struct gltf_texture gltf_read_texture(const struct gltf_file *file, uint32_t index);
struct gltf_image gltf_read_image(const struct gltf_file *file, uint32_t index);
/** Calls `say` with each extension that is used, but not supported here, once. */
void gltf_name_extensions(const struct gltf_file *file,
                          void (*say)(void *user, const char *extension, bool required),
                          void *user);

#endif /* SLUICE_VIEW_GLTF_MATERIALS_H */
