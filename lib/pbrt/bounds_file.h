/** Bounds of PLY files that an earlier run has found. */
#ifndef SLC_PBRT_BOUNDS_FILE_H
#define SLC_PBRT_BOUNDS_FILE_H

#include "pbrt/parsed_scene.h"

/** Takes the bounds of files that have not changed. A file that is missing or damaged is no error.
 *  Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_pbrt_read_bounds_file(SluicePbrtScene *scene, const char *path);

#endif /* SLC_PBRT_BOUNDS_FILE_H */
