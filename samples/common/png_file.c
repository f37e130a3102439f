#include "png_file.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/input.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

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
    struct output_file *file = rgb ? output_file_begin_quickly(path) : NULL;
    errno = 0;
    bool done = file && png_image_write_to_stdio(&image, output_file_stream(file), 0, rgb, 0, NULL);
    if (!rgb)
        text_say("%s: cannot write: out of memory", path);
    else if (file && !done)
        text_say("%s: cannot write: %s", path, errno ? strerror(errno) : image.message);
    free(rgb);
    return output_file_end(file, done);
}

uint8_t *png_file_read(const char *path, uint32_t *width, uint32_t *height)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    FILE *file = input_open(path);
    int error = errno;
    bool opened = file && png_image_begin_read_from_stdio(&image, file);
    image.format = PNG_FORMAT_RGBA;
    uint8_t *rgba = opened ? malloc(PNG_IMAGE_SIZE(image)) : NULL;
    bool done = rgba && png_image_finish_read(&image, NULL, rgba, 0, NULL);
    if (done) {
        *width = image.width;
        *height = image.height;
    } else {
        text_say("%s: cannot read: %s", path,
                 !file             ? input_reason(error)
                 : opened && !rgba ? "out of memory"
                                   : image.message);
        png_image_free(&image);
        free(rgba);
    }
    if (file)
        fclose(file);
    return done ? rgba : NULL;
}
