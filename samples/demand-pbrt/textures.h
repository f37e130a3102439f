/** Pictures of a scene as demand textures. One file is opened once, however it is sampled. */
#ifndef DEMAND_PBRT_TEXTURES_H
#define DEMAND_PBRT_TEXTURES_H

#include <sluice/demand.h>
#include <sluice/open.h>
#include <sluice/pbrt.h>

#include <stdbool.h>

/** A picture file. */
struct picture_image {
    const char *path; ///< of the scene
    const char *file; ///< text that names it first
    uint32_t line;
    bool has_failed; ///< which stderr has said
    SluiceImageOpener *opener;
    SluiceDemandTextureId id; ///< with the sampler that came first
    SluiceImageInfo info;     ///< known once it was opened: width is not 0 then
    SluiceImageFileKind kind;
    bool says_what_it_reads;
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
    SluiceImageOpener *opener;
    struct picture_image **images; ///< owned
    struct picture_use **uses;     ///< owned, and each of them
    uint32_t image_count, use_count, image_room, use_room;
    float max_anisotropy;
    bool says_what_it_reads;
};

/** `cache`: folder for baked pictures. Says on stderr why it failed. */
bool textures_create(SluiceDemandLoader *loader, const char *cache, uint32_t thread_count,
                     struct textures *textures);
/** After the loader is destroyed. */
void textures_finish(struct textures *textures);

/** Finds or adds the demand texture of an image texture. The result stays until textures_finish.
 * Says on stderr if that fails. */
const struct picture_use *textures_find(struct textures *textures,
                                        const SluicePbrtTexture *texture);

/** Whether the file has an alpha channel, as far as its first bytes say so. */
bool textures_has_alpha(const char *path);

#endif /* DEMAND_PBRT_TEXTURES_H */
