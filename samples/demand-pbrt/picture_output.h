/** Picture files. The name's extension chooses the format. */
#ifndef DEMAND_PBRT_PICTURE_OUTPUT_H
#define DEMAND_PBRT_PICTURE_OUTPUT_H

#include "../common/picture.h"

/** Returns whether the name ends in .png, .exr or .pfm. If not, reports it on stderr. */
bool picture_output_is_known(const char *path);
/** Writes a picture. PNG: times 2^exposure, in sRGB. EXR: halves. PFM: unchanged floats. Reports
 * errors on stderr. */
bool picture_output_write(const struct picture *picture, double exposure, const char *path);

#endif /* DEMAND_PBRT_PICTURE_OUTPUT_H */
