/** Pictures as files, by the ending of their name. */
#ifndef DEMAND_PBRT_PICTURE_OUTPUT_H
#define DEMAND_PBRT_PICTURE_OUTPUT_H

#include "../common/picture.h"

/** Says on stderr if the name ends in none of .png, .exr and .pfm. */
bool picture_output_is_known(const char *path);
/** PNG: times 2^exposure, in sRGB. EXR: halves. PFM: floats as they are. Says on stderr why it
 *  failed. */
bool picture_output_write(const struct picture *picture, double exposure, const char *path);

#endif /* DEMAND_PBRT_PICTURE_OUTPUT_H */
