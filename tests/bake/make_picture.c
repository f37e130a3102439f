/* make_picture KIND WIDTH HEIGHT SEED FILE: a picture of smooth colors and noise, "plain" of one
 * color. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vips/vips.h>

static int channels_of(const char *kind)
{
    return strcmp(kind, "gray") == 0 ? 1 : strcmp(kind, "rgba") == 0 ? 4 : 3;
}

static VipsImage *make_noisy(int width, int height, int channels, uint32_t seed)
{
    size_t size = (size_t)width * (size_t)height * (size_t)channels;
    uint8_t *samples = malloc(size);
    if (!samples)
        return NULL;
    for (size_t i = 0; i < size; i++) {
        seed = seed * 1664525u + 1013904223u;
        size_t x = i / (size_t)channels % (size_t)width, y = i / (size_t)channels / (size_t)width;
        samples[i] = (uint8_t)(x / 3 + y / 5 + (seed >> 28));
    }
    VipsImage *image =
        vips_image_new_from_memory_copy(samples, size, width, height, channels, VIPS_FORMAT_UCHAR);
    free(samples);
    return image;
}

/* Made as it is written, so that it can be larger than memory. */
static VipsImage *make_plain(int width, int height)
{
    VipsImage *black = NULL, *color = NULL, *bytes = NULL;
    double factors[] = {1, 1, 1}, values[] = {40, 90, 200};
    if (vips_black(&black, width, height, "bands", 3, NULL) != 0 ||
        vips_linear(black, &color, factors, values, 3, "uchar", TRUE, NULL) != 0 ||
        vips_copy(color, &bytes, "interpretation", VIPS_INTERPRETATION_sRGB, NULL) != 0)
        return NULL;
    g_object_unref(black);
    g_object_unref(color);
    return bytes;
}

int main(int argc, char **argv)
{
    if (argc != 6 || VIPS_INIT(argv[0]) != 0)
        return 2;
    int width = atoi(argv[2]), height = atoi(argv[3]);
    VipsImage *image =
        strcmp(argv[1], "plain") == 0
            ? make_plain(width, height)
            : make_noisy(width, height, channels_of(argv[1]), (uint32_t)strtoul(argv[4], NULL, 10));
    if (!image || vips_image_write_to_file(image, argv[5], NULL) != 0) {
        fprintf(stderr, "%s\n", vips_error_buffer());
        return 1;
    }
    g_object_unref(image);
    vips_shutdown();
    return 0;
}
