/** Cache file with bounds of PLY files from earlier runs. */
#ifndef SLC_PBRT_BOUNDS_FILE_H
#define SLC_PBRT_BOUNDS_FILE_H

#include "pbrt/parsed_scene.h"

/** Takes the bounds of unchanged files. Ignores a missing or damaged cache file. Errors:
 *  OUT_OF_HOST_MEMORY. */
SluiceResult slc_pbrt_read_bounds_file(SluicePbrtScene *scene, const char *path);

#endif /* SLC_PBRT_BOUNDS_FILE_H */
