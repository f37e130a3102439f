/* Makes the hall that sluice-view opens without arguments: FOLDER/hall.gltf, hall.bin, textures.
 *
 * make-hall FOLDER [NUMBER]: only painting NUMBER if one is given. The textures of normals and of
 * roughness are not made here. */
#include "hall_geometry.h"
#include "hall_scene.h"
#include "paintings.h"
#include "palette_png.h"

#include <stdio.h>
#include <stdlib.h>

/* Font of digits 0 to 9 and x: 5 rows of 3 dots, the highest bit at the top left. */
static const uint16_t font[11] = {075557, 026227, 071747, 071717, 055711, 074717,
                                  074757, 071111, 075757, 075717, 005250};

/* Returns 1 if `text` has a dot at column x, row y, else 0. */
static int text_dot(const char *text, int x, int y)
{
    for (; *text && x >= 4; text++)
        x -= 4;
    if (!*text || x < 0 || x > 2 || y < 0 || y > 4 || *text == ' ')
        return 0;
    const uint16_t glyph = font[*text == 'x' ? 10 : *text - '0'];
    return glyph >> (14 - 3 * y - x) & 1;
}

/* Writes number and size of a painting into its lower right corner. */
static void write_label(uint8_t *indices, const struct hall_picture *picture)
{
    char text[64];
    const int length =
        snprintf(text, sizeof text, "%02u %ux%u", picture->number, picture->width, picture->height);
    const int32_t dot = (int32_t)(picture->height / 400), wide = (length * 4 + 1) * dot;
    const int32_t left = (int32_t)picture->width - wide - 8 * dot;
    const int32_t top = (int32_t)picture->height - 15 * dot;
    if (dot < 1 || left < 0)
        return;
    for (int32_t y = 0; y < 9 * dot; y++)
        for (int32_t x = 0; x < wide; x++)
            indices[(size_t)(top + y) * picture->width + (size_t)(left + x)] =
                text_dot(text, x / dot - 1, y / dot - 2) ? PAINTING_COLORS - 1 : 0;
}

static uint32_t color_at(const struct hall_picture *picture, const struct painting *painting,
                         double x, double y)
{
    if (picture->number == HALL_FLOOR)
        return painting_floor((x + 0.5) / picture->width, (y + 0.5) / picture->height);
    return painting_color(painting, (x + 0.5) / picture->height, (y + 0.5) / picture->height);
}

/* Chooses the kind of a painting. Large and oblong paintings have kinds that suit them. */
static uint32_t kind_of(uint32_t number)
{
    static const uint8_t kinds[14] = {1, 5, 0, 9, 2, 6, 0, 5, 2, 4, 7, 3, 0, 10};
    return number < 26 ? number % PAINTING_KINDS : kinds[(number - 26) % 14];
}

static int make_picture(const char *folder, const struct hall_picture *picture)
{
    char path[4096];
    const struct painting painting = {kind_of(picture->number), picture->number * 7 + 1,
                                      (double)picture->width / picture->height};
    const double spread = picture->number == HALL_FLOOR ? 0 : 1;
    uint8_t *indices = malloc((size_t)picture->width * picture->height);
    if (!indices) {
        fprintf(stderr, "make-hall: out of memory\n");
        return 1;
    }
    for (uint32_t y = 0; y < picture->height; y++)
        for (uint32_t x = 0; x < picture->width; x++) {
            uint32_t samples[4];
            /* The floor uses one sample instead of four: mixed colors would double the file. */
            for (int i = 0; i < 4; i++)
                samples[i] = color_at(picture, &painting, x + spread * (0.5 * (i & 1) - 0.25),
                                      y + spread * (0.5 * (i >> 1) - 0.25));
            indices[(size_t)y * picture->width + x] = palette_mix(samples);
        }
    if (picture->number != HALL_FLOOR)
        write_label(indices, picture);
    snprintf(path, sizeof path, "%s/%s", folder, picture->path);
    const bool written = palette_png_write(
        path, indices, picture->width, picture->height,
        picture->number == HALL_FLOOR ? painting_floor_palette
                                      : painting_palette(picture->number + picture->number / 7));
    free(indices);
    return !written;
}

int main(int argc, char **argv)
{
    if (argc < 2 || argc > 3) {
        fprintf(stderr,
                "usage: make-hall FOLDER [NUMBER]\n"
                "writes hall.gltf, hall.bin and pictures; with NUMBER, only that picture\n");
        return 2;
    }
    int failed = 0;
    for (uint32_t i = 0; i <= HALL_FLOOR && !failed; i++) {
        const struct hall_picture picture = hall_picture(i);
        if (argc == 3 && strtoul(argv[2], NULL, 10) != i)
            continue;
        fprintf(stderr, "\r%u of %u: %s   ", i + 1, HALL_FLOOR + 1, picture.path);
        failed = make_picture(argv[1], &picture);
    }
    fprintf(stderr, "\n");
    return failed || (argc == 2 && !hall_scene_write(argv[1]));
}
