/** A picture in memory: linear light, and which pixels are not complete. */
#ifndef SAMPLES_COMMON_PICTURE_H
#define SAMPLES_COMMON_PICTURE_H

#include <stdbool.h>
#include <stdint.h>

/** Zeroed is empty. */
struct picture {
    uint32_t width, height;
    float (*rgba)[4]; ///< owned; [height * width], row 0 on top, alpha 1
    bool *missing;    ///< owned; the same
    bool plain;       ///< developed without a film's curve: values above 1 are white
};

/** Says on stderr if memory is short. */
bool picture_create(uint32_t width, uint32_t height, struct picture *picture);
void picture_destroy(struct picture *picture);

/** What a screen shows of linear light, times 2^exposure: a film's curve unless it is plain, then
 *  sRGB. `rgba` has width * height * 4 bytes. */
void picture_develop(const struct picture *picture, double exposure, uint8_t *rgba);

/** FOLDER/NAME.png, developed, and FOLDER/NAME.exr, linear halves. Says on stderr why it failed. */
bool picture_write(const struct picture *picture, double exposure, const char *folder,
                   const char *name);

/** An EXR file of linear halves. Says on stderr why it failed. */
bool picture_write_exr(const struct picture *picture, const char *path);

/** Of two developed pictures. */
struct picture_difference {
    double psnr; ///< dB
    double ssim; ///< 1: equal
    double flip; ///< 0: equal
};

/** FOLDER/KIND-NUMBER.png, the number of four digits. */
struct picture_place {
    const char *folder;
    uint32_t number;
};

/** Of the picture and a PNG file of the same size. Both and where they differ are written as
 * "frame", "truth" and "flip". Says on stderr why it failed. */
bool picture_compare(const struct picture *picture, double exposure, const char *path,
                     const struct picture_place *place, struct picture_difference *difference);

#endif /* SAMPLES_COMMON_PICTURE_H */
