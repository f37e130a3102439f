/**
 * Between the samples of a picture, the floats that are filtered, and the texels that are stored.
 *
 * Filtered floats are RGBA: linear, weighted by alpha if that is straight, vectors from -1 to 1 for
 * normal maps, without NaN and infinities.
 */
#ifndef SLC_BAKE_TEXELS_H
#define SLC_BAKE_TEXELS_H

#include <sluice/bake.h>

enum slc_sample {
    SLC_SAMPLE_U8,
    SLC_SAMPLE_U16,
    SLC_SAMPLE_F16,
    SLC_SAMPLE_F32,
    SLC_SAMPLE_TEXELS ///< whole texels of a format: SNORM, and packed ones
};

/** How a picture is understood and what becomes of it. */
struct slc_rules {
    enum slc_sample sample;
    SluiceFormat texels; ///< of SLC_SAMPLE_TEXELS
    uint32_t channels;   ///< of the picture, 1 to 4: gray, gray and alpha (or RG), RGB, RGBA
    bool alpha;          ///< the last of 2 or 4 channels is alpha
    bool srgb;           ///< R, G and B are encoded
    bool straight;       ///< colors are to be weighted by alpha
    bool normals;        ///< R, G and B are a vector; of two channels, B is the rest of its length
    bool rings;          ///< the filter has negative lobes
    SluiceFormat format; ///< of texels: not compressed
    float limit;         ///< larger finite magnitudes become this
    float infinity;      ///< what infinities become
    const float *decoded16; ///< 65536 values of sRGB codes, for SLC_SAMPLE_U16 with srgb
};

/** Texels that could not be kept as they are. One may count in several of the last three. */
struct slc_replaced {
    uint64_t texels;
    uint64_t nan;      ///< a NaN became 0
    uint64_t infinite; ///< an infinity became a number
    uint64_t clamped;  ///< a finite number was beyond the limit
};

/** Bytes of a sample that is a number. */
uint32_t slc_sample_size(enum slc_sample sample);

/** Fills 65536 values for `decoded16`. */
void slc_decode_srgb16(float *values);

/** `count` texels of `samples`, [count][channels], to [count][4] floats; adds to `replaced`. */
void slc_read_texels(const struct slc_rules *rules, const void *samples, float *rgba,
                     uint32_t count, struct slc_replaced *replaced);

/** `count` filtered texels as they are stored. `alpha_scale` multiplies alpha, up to 1. */
void slc_write_texels(const struct slc_rules *rules, const float *rgba, float alpha_scale,
                      void *texels, uint32_t count);

/** Whether level 0 stores the samples unchanged: no floats that may be infinite. A missing alpha is
 * added. */
bool slc_keeps_samples(const struct slc_rules *rules);

/** Texels of samples that are kept. */
void slc_copy_samples(const struct slc_rules *rules, const void *samples, void *texels,
                      uint32_t count);

#endif /* SLC_BAKE_TEXELS_H */
