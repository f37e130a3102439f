/**
 * Conversion from samples of a picture to floats for the filter, and from these to stored texels.
 *
 * Floats are linear RGBA without NaN and infinities. Straight alpha weights the colors. Normal maps
 * are vectors with components from -1 to 1.
 */
#ifndef SLC_BAKE_TEXELS_H
#define SLC_BAKE_TEXELS_H

#include <sluice/bake.h>

enum slc_sample {
    SLC_SAMPLE_U8,
    SLC_SAMPLE_U16,
    SLC_SAMPLE_F16,
    SLC_SAMPLE_F32,
    SLC_SAMPLE_TEXELS ///< whole texels of a format: SNORM and packed formats
};

/** Rules of the conversion: meaning of the samples, and format of the texels. */
struct slc_rules {
    enum slc_sample sample;
    SluiceFormat texels;    ///< format for SLC_SAMPLE_TEXELS
    uint32_t channels;      ///< per texel, 1 to 4: gray, gray and alpha (or RG), RGB, RGBA
    bool alpha;             ///< the last of 2 or 4 channels is alpha
    bool srgb;              ///< R, G and B are encoded
    bool straight;          ///< alpha weights the colors
    bool normals;           ///< R, G and B are a vector; with two channels, B follows from length 1
    bool rings;             ///< the filter has negative lobes
    SluiceFormat format;    ///< uncompressed format of texels
    float limit;            ///< larger finite magnitudes are clamped to it
    float infinity;         ///< replaces infinities
    const float *decoded16; ///< 65536 values of sRGB codes, for SLC_SAMPLE_U16 with srgb
};

/** Counts of changed texels. A texel may count in several of the last three. */
struct slc_replaced {
    uint64_t texels;
    uint64_t nan;      ///< a NaN became 0
    uint64_t infinite; ///< an infinity became a number
    uint64_t clamped;  ///< a finite number was beyond the limit
};

/** Returns the bytes of a sample that is a number. */
uint32_t slc_sample_size(enum slc_sample sample);

/** Fills 65536 values for `decoded16`. */
void slc_decode_srgb16(float *values);

/** Converts `samples`, [count][channels], to [count][4] floats. Adds to `replaced`. */
void slc_read_texels(const struct slc_rules *rules, const void *samples, float *rgba,
                     uint32_t count, struct slc_replaced *replaced);

/** Converts `count` filtered texels to the stored format. `alpha_scale` multiplies alpha, up to 1.
 */
void slc_write_texels(const struct slc_rules *rules, const float *rgba, float alpha_scale,
                      void *texels, uint32_t count);

/** Tells whether level 0 stores the samples unchanged; false for floats that may be infinite. A
 * missing alpha is added. */
bool slc_keeps_samples(const struct slc_rules *rules);

/** Copies samples to texels; for slc_keeps_samples. */
void slc_copy_samples(const struct slc_rules *rules, const void *samples, void *texels,
                      uint32_t count);

#endif /* SLC_BAKE_TEXELS_H */
