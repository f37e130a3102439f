/** Pictures of a scene as demand textures of a loader. One file is opened once, however it is
 *  sampled. */
#ifndef DEMAND_PBRT_TEXTURES_H
#define DEMAND_PBRT_TEXTURES_H

#include <sluice/demand.h>

#include "picture_files.h"

/** A picture of a loader. */
struct picture_image {
    struct picture_file *file; ///< of all loaders
    SluiceDemandTextureId id;  ///< with the sampler that came first
    SluiceImageInfo info;      ///< known once it was opened: width is not 0 then
    SluiceImageFileKind kind;
};

/** How a picture is sampled. */
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
    struct picture_image **images; ///< owned, and each of them
    struct picture_use **uses;     ///< owned, and each of them
    uint32_t image_count, use_count, image_room, use_room;
    float max_anisotropy;
};

void textures_create(SluiceDemandLoader *loader, struct picture_files *files,
                     struct textures *textures);
/** After the loader is destroyed, and before the files. */
void textures_finish(struct textures *textures);

/** Finds or adds the demand texture of an image texture. The result stays until textures_finish.
 * Says on stderr if that fails. */
const struct picture_use *textures_find(struct textures *textures,
                                        const SluicePbrtTexture *texture);

/** Whether the file has an alpha channel, as far as its first bytes say so. */
bool textures_has_alpha(const char *path);

#endif /* DEMAND_PBRT_TEXTURES_H */
