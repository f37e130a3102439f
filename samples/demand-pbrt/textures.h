/** Pictures of a scene as demand textures of a loader. Each file is opened once, whatever its
 * samplers. */
#ifndef DEMAND_PBRT_TEXTURES_H
#define DEMAND_PBRT_TEXTURES_H

#include <sluice/demand.h>

#include "picture_files.h"

/** A picture of a loader. */
struct picture_image {
    struct picture_file *file; ///< shared by all loaders
    SluiceDemandTextureId id;  ///< texture with the first sampler
    SluiceImageInfo info;      ///< width 0: not opened yet
    SluiceImageFileKind kind;
};

/** A picture with a sampler. */
struct picture_use {
    struct picture_image *image;
    SluicePbrtWrap wrap;
    bool nearest;
    float anisotropy;
    SluiceDemandTextureId id;
};

/** Zeroed is empty. */
struct textures {
    SluiceDemandLoader *loader;
    struct picture_files *files;
    struct picture_image **images; ///< owned, with its elements
    struct picture_use **uses;     ///< owned, with its elements
    uint32_t image_count, use_count, image_room, use_room;
    float max_anisotropy;
};

void textures_create(SluiceDemandLoader *loader, struct picture_files *files,
                     struct textures *textures);
/** Call after the loader is destroyed, and before picture_files_finish. */
void textures_finish(struct textures *textures);

/** Finds or adds the demand texture of an image texture. The result lives until textures_finish.
 * Returns NULL on error and reports it on stderr. */
const struct picture_use *textures_find(struct textures *textures,
                                        const SluicePbrtTexture *texture);

/** Returns whether the file's first bytes declare an alpha channel. */
bool textures_has_alpha(const char *path);

#endif /* DEMAND_PBRT_TEXTURES_H */
