#include "picture_output.h"

#include <stdio.h>
#include <stdlib.h>

#include "../../tools/common/files.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"
#include "../common/png_file.h"

bool picture_output_is_known(const char *path)
{
    if (files_has_suffix(path, ".png|.exr|.pfm"))
        return true;
    text_say("%s: the name of a picture ends in .png, .exr or .pfm", path);
    return false;
}

static bool write_png(const struct picture *picture, double exposure, const char *path)
{
    uint8_t *rgba = malloc((size_t)picture->width * picture->height * 4);
    if (!rgba) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    picture_develop(picture, exposure, rgba);
    bool done = png_file_write(path, rgba, picture->width, picture->height);
    free(rgba);
    return done;
}

/* Writes rows from the bottom up. The negative scale marks little-endian bytes. */
static bool write_pfm(const struct picture *picture, const char *path)
{
    struct output_file *output = output_file_begin(path);
    if (!output)
        return false;
    FILE *file = output_file_stream(output);
    fprintf(file, "PF\n%u %u\n-1.0\n", picture->width, picture->height);
    for (uint32_t y = picture->height; y-- > 0;)
        for (uint32_t x = 0; x < picture->width; x++)
            fwrite(picture->rgba[(size_t)y * picture->width + x], sizeof(float), 3, file);
    return output_file_end(output, true);
}

bool picture_output_write(const struct picture *picture, double exposure, const char *path)
{
    if (files_has_suffix(path, ".pfm"))
        return write_pfm(picture, path);
    if (files_has_suffix(path, ".exr"))
        return picture_write_exr(picture, path);
    return write_png(picture, exposure, path);
}
