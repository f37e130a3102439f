/** Puts shrunk pictures, such as the frames of a rendering, side by side into one. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/option_table.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"
#include "../common/caption.h"
#include "../common/png_file.h"

#define CAPTION_SCALE 1u
#define CAPTION_BAR (CAPTION_HEIGHT * CAPTION_SCALE + 4)
#define GAP 2u
#define MOST_PIXELS (1u << 28)

struct sheet_options {
    struct option_list pictures;
    const char *file;
    uint32_t columns, cell[2];
};

static enum option_outcome parse(int argc, char **argv, struct sheet_options *o)
{
    *o = (struct sheet_options){0};
    const struct option options[] = {
        {OPTION_WORDS, .value = &o->pictures, .help = "pictures", .minimum = 1},
        {OPTION_TEXT, "output", "FILE", "contact-sheet.png", &o->file, "the sheet, PNG",
         .letter = 'o'},
        {OPTION_UINT, "columns", "N", "8", &o->columns, "pictures side by side", 1, 256},
        {OPTION_EXTENT, "cell", "WxH", "160x90", o->cell, "pixels of a small picture", 8, 2048},
    };
    const struct option_table table = {
        "contact-sheet",
        "usage: contact-sheet PICTURE.png ... [-o FILE] [options]\n\n"
        "Puts small pictures, with their names, into one. Pictures of other proportions are "
        "stretched.\n",
        "Exit status: 0; 1 if a picture cannot be read or the sheet not be written; 2 wrong "
        "usage.\n",
        options, sizeof options / sizeof *options};
    return options_parse(&table, argc, argv);
}

/** Computes the mean of a picture's pixels under one pixel of the cell, or takes the nearest one if
 * the cell is larger. */
static void shrink_pixel(const uint8_t *picture, const uint32_t size[2], const uint32_t cell[2],
                         uint32_t x, uint32_t y, uint8_t *pixel)
{
    const uint32_t left = (uint32_t)((uint64_t)x * size[0] / cell[0]);
    const uint32_t top = (uint32_t)((uint64_t)y * size[1] / cell[1]);
    uint32_t right = (uint32_t)((uint64_t)(x + 1) * size[0] / cell[0]);
    uint32_t bottom = (uint32_t)((uint64_t)(y + 1) * size[1] / cell[1]);
    right = right > left ? right : left + 1;
    bottom = bottom > top ? bottom : top + 1;
    uint64_t sums[3] = {0};
    for (uint32_t row = top; row < bottom; row++)
        for (uint32_t column = left; column < right; column++)
            for (int c = 0; c < 3; c++)
                sums[c] += picture[4 * ((size_t)row * size[0] + column) + (size_t)c];
    for (int c = 0; c < 3; c++)
        pixel[c] = (uint8_t)(sums[c] / ((uint64_t)(right - left) * (bottom - top)));
}

static bool place(const struct sheet_options *o, size_t index, const struct canvas *canvas)
{
    const char *path = o->pictures.items[index], *slash = strrchr(path, '/');
    char name[64];
    uint32_t size[2];
    uint8_t *picture = png_file_read(path, &size[0], &size[1]);
    if (!picture)
        return false;
    const uint32_t left = GAP + (uint32_t)(index % o->columns) * (o->cell[0] + GAP);
    const uint32_t top = GAP + (uint32_t)(index / o->columns) * (o->cell[1] + CAPTION_BAR + GAP);
    for (uint32_t y = 0; y < o->cell[1]; y++)
        for (uint32_t x = 0; x < o->cell[0]; x++)
            shrink_pixel(picture, size, o->cell, x, y,
                         canvas->rgba + 4 * ((size_t)(top + y) * canvas->width + left + x));
    free(picture);
    snprintf(name, sizeof name, "%.*s", (int)(o->cell[0] / (CAPTION_WIDTH * CAPTION_SCALE)),
             slash ? slash + 1 : path);
    caption_draw(canvas, left, top + o->cell[1] + 2, CAPTION_SCALE, name);
    return true;
}

static bool make_sheet(const struct sheet_options *o)
{
    const size_t count = o->pictures.count;
    const uint64_t rows = (count + o->columns - 1) / o->columns;
    const uint64_t columns = count < o->columns ? count : o->columns;
    const uint64_t width = GAP + columns * (o->cell[0] + GAP);
    const uint64_t height = GAP + rows * (o->cell[1] + CAPTION_BAR + GAP);
    if (width * height > MOST_PIXELS) {
        text_say("contact-sheet: %zu pictures of this size are too many for one sheet", count);
        return false;
    }
    struct canvas canvas = {calloc(width * height, 4), (uint32_t)width, (uint32_t)height};
    bool placed = canvas.rgba != NULL;
    if (!placed)
        text_say("contact-sheet: out of memory");
    for (size_t i = 0; placed && i < count; i++)
        placed = place(o, i, &canvas);
    placed = placed && png_file_write(o->file, canvas.rgba, canvas.width, canvas.height);
    free(canvas.rgba);
    return placed;
}

int main(int argc, char **argv)
{
    struct sheet_options options;
    switch (parse(argc, argv, &options)) {
    case OPTIONS_HELP: return text_exit_status(EXIT_SUCCESS);
    case OPTIONS_ERROR: return 2;
    case OPTIONS_RUN: break;
    }
    bool good = true;
    for (size_t i = 0; i < options.pictures.count && good; i++)
        good = output_add_input(options.pictures.items[i]);
    return good && output_can_write(options.file) && make_sheet(&options) ? EXIT_SUCCESS
                                                                          : EXIT_FAILURE;
}
