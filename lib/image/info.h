/** Checks and copies what describes an image. */
#ifndef SLC_IMAGE_INFO_H
#define SLC_IMAGE_INFO_H

#include <sluice/image.h>

#define SLC_MAX_IMAGE_EXTENT (1u << 20) ///< texels in a direction
#define SLC_MAX_IMAGE_LAYERS (1u << 16)
#define SLC_CUBE_FACES 6u

/**
 * Copies `given` with its name ("" for NULL); a level count of 0 becomes the full chain's.
 * Errors: INVALID_ARGUMENT for an empty or unknown format, a size of 0 or another level count than
 * the full chain's; UNSUPPORTED for compressed formats, which nothing here can encode,
 * and for arrays;
 * OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_image_info_init(const SluiceAllocationCallbacks *cb, const SluiceImageInfo *given,
                                 SluiceImageInfo *info);

/** Levels that a source may have. */
enum slc_image_levels {
    SLC_LEVELS_ALL,        ///< the full chain
    SLC_LEVELS_ALL_OR_ONE, ///< or level 0 alone
    SLC_LEVELS_TO_TAIL,    ///< down to a level that fits into a standard tile, or further
    SLC_LEVELS_ANY         ///< one or more
};

/**
 * Checks every field of what an application's source says about itself, before anything is
 * computed from it. NULL: the values are in the ranges that image.h gives; else what is wrong.
 */
const char *slc_image_info_trouble(const SluiceImageInfo *info, enum slc_image_levels levels);

/** Checks the same and logs name, field and values. `log` may be NULL. Errors: INVALID_ARGUMENT. */
SluiceResult slc_image_info_check(const SluiceImageInfo *info, enum slc_image_levels levels,
                                  const SluiceLogCallback *log);

/** Frees the name. */
void slc_image_info_finish(const SluiceAllocationCallbacks *cb, SluiceImageInfo *info);

#endif /* SLC_IMAGE_INFO_H */
