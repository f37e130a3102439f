/** Spectra as linear colors with the primaries of Rec. 709. */
#ifndef SLC_PBRT_COLOR_VALUES_H
#define SLC_PBRT_COLOR_VALUES_H

#include <stddef.h>

void slc_pbrt_xyz_to_rgb(const float xyz[3], float rgb[3]);
/** A black body whose greatest radiance is 1, per kelvin; not below 0. */
void slc_pbrt_blackbody_rgb(double kelvin, float rgb[3]);
/** Samples of wavelength (nm, rising) and value, linear between; a constant is gray. */
void slc_pbrt_sampled_rgb(const float *pairs, size_t count, float rgb[3]);
/** Reflectance of a metal that a name contains, as "metal-Cu-eta" or "Cu.spd". */
void slc_pbrt_metal_rgb(const char *name, float rgb[3]);

#endif /* SLC_PBRT_COLOR_VALUES_H */
