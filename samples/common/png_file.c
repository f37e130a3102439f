#include "png_file.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint8_t *without_alpha(const uint8_t *rgba, size_t texel_count)
{
    uint8_t *rgb = malloc(texel_count * 3);
    for (size_t i = 0; rgb && i < texel_count; i++)
        memcpy(rgb + 3 * i, rgba + 4 * i, 3);
    return rgb;
}

bool png_file_write(const char *path, const uint8_t *rgba, uint32_t width, uint32_t height)
{
    uint8_t *rgb = without_alpha(rgba, (size_t)width * height);
    png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height};
    image.format = PNG_FORMAT_RGB;
    bool done = rgb && png_image_write_to_file(&image, path, 0, rgb, 0, NULL);
    if (!done) {
        fprintf(stderr, "%s: cannot write: %s\n", path,
                rgb ? (image.message[0] ? image.message : strerror(errno)) : "out of memory");
        remove(path);
    }
    free(rgb);
    return done;
}

uint8_t *png_file_read(const char *path, uint32_t *width, uint32_t *height)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    bool opened = png_image_begin_read_from_file(&image, path);
    image.format = PNG_FORMAT_RGBA;
    uint8_t *rgba = opened ? malloc(PNG_IMAGE_SIZE(image)) : NULL;
    if (rgba && png_image_finish_read(&image, NULL, rgba, 0, NULL)) {
        *width = image.width;
        *height = image.height;
        return rgba;
    }
    fprintf(stderr, "%s: cannot read: %s\n", path,
            opened && !rgba ? "out of memory" : image.message);
    png_image_free(&image);
    free(rgba);
    return NULL;
}
