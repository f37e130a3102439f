/** A picture in host memory: linear light, and flags for incomplete pixels. */
#ifndef SAMPLES_COMMON_PICTURE_H
#define SAMPLES_COMMON_PICTURE_H

#include <stdbool.h>
#include <stdint.h>

/** Zeroed is empty. */
struct picture {
    uint32_t width, height;
    float (*rgba)[4]; ///< owned; [height * width], row 0 on top, alpha 1
    bool *missing;    ///< owned; [height * width]; true: the pixel is incomplete
    bool plain;       ///< true: no tone curve; values above 1 are white
};

/** Reports on stderr when out of memory. */
bool picture_create(uint32_t width, uint32_t height, struct picture *picture);
void picture_destroy(struct picture *picture);

/** Converts linear light times 2^exposure to sRGB, through a film's tone curve unless the picture
 * is plain. `rgba`: width * height * 4 bytes. */
void picture_develop(const struct picture *picture, double exposure, uint8_t *rgba);

/** Writes FOLDER/NAME.png, developed, and FOLDER/NAME.exr, linear half floats. Reports errors on
 * stderr. */
bool picture_write(const struct picture *picture, double exposure, const char *folder,
                   const char *name);

/** Writes an EXR file of linear half floats. Reports errors on stderr. */
bool picture_write_exr(const struct picture *picture, const char *path);

/** Differences between two developed pictures. */
struct picture_difference {
    double psnr; ///< dB
    double ssim; ///< 1: equal
    double flip; ///< 0: equal
};

/** Path FOLDER/KIND-NUMBER.png, where NUMBER has four digits. */
struct picture_place {
    const char *folder;
    uint32_t number;
};

/** Compares the picture with a PNG file of equal size. Writes both and their error map as "frame",
 * "truth" and "flip". Reports errors on stderr. */
bool picture_compare(const struct picture *picture, double exposure, const char *path,
                     const struct picture_place *place, struct picture_difference *difference);

#endif /* SAMPLES_COMMON_PICTURE_H */
