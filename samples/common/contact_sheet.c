#include "contact_sheet.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "png_file.h"
#include "caption.h"

#define CELL_WIDTH 400u  ///< pixels; smaller pictures keep their size
#define CAPTION_SCALE 2u ///< pixels per dot
#define CAPTION_BAR (CAPTION_HEIGHT * CAPTION_SCALE + 8)
#define GAP 4u

static const uint8_t magenta[3] = {255, 0, 200};
static const uint8_t paper[3] = {24, 24, 26};

/** Writes the mean of the pixels under a pixel of the small picture. */
static void shrink_pixel(const struct contact_sheet *sheet, const struct picture *picture,
                         const uint8_t *developed, uint32_t x, uint32_t y, uint8_t *pixel)
{
    const uint32_t factor = picture->width / sheet->cell_width;
    uint32_t sums[3] = {0, 0, 0};
    for (uint32_t row = y * factor; row < (y + 1) * factor; row++)
        for (uint32_t column = x * factor; column < (x + 1) * factor; column++) {
            size_t at = (size_t)row * picture->width + column;
            const uint8_t *color =
                picture->missing[at] && sheet->marks_missing ? magenta : developed + 4 * at;
            for (int c = 0; c < 3; c++)
                sums[c] += color[c];
        }
    for (int c = 0; c < 3; c++)
        pixel[c] = (uint8_t)(sums[c] / (factor * factor));
    pixel[3] = 255;
}

static void fill_paper(uint8_t *rgba, size_t pixel_count)
{
    for (size_t i = 0; i < pixel_count; i++) {
        memcpy(rgba + 4 * i, paper, sizeof paper);
        rgba[4 * i + 3] = 255;
    }
}

static uint8_t *make_cell(const struct contact_sheet *sheet, const struct picture *picture,
                          double exposure, const char *caption)
{
    const uint32_t height = sheet->cell_height;
    const size_t cell_pixels = (size_t)sheet->cell_width * (height + CAPTION_BAR);
    uint8_t *developed = malloc((size_t)picture->width * picture->height * 4);
    uint8_t *cell = malloc(cell_pixels * 4);
    if (developed && cell) {
        picture_develop(picture, exposure, developed);
        fill_paper(cell, cell_pixels);
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < sheet->cell_width; x++)
                shrink_pixel(sheet, picture, developed, x, y,
                             cell + 4 * ((size_t)y * sheet->cell_width + x));
        struct canvas canvas = {cell, sheet->cell_width, height + CAPTION_BAR};
        caption_draw(&canvas, 4, height + 4, CAPTION_SCALE, caption);
    } else {
        fprintf(stderr, "out of memory\n");
        free(cell);
        cell = NULL;
    }
    free(developed);
    return cell;
}

bool contact_sheet_has_room(const struct contact_sheet *sheet)
{
    return sheet->count + 1 < CONTACT_SHEET_CELLS;
}

bool contact_sheet_add(struct contact_sheet *sheet, const struct picture *picture, double exposure,
                       const char *caption)
{
    uint32_t factor = (picture->width + CELL_WIDTH - 1) / CELL_WIDTH;
    if (factor > picture->height)
        factor = picture->height;
    sheet->cell_width = picture->width / factor;
    sheet->cell_height = picture->height / factor;
    uint8_t *cell = make_cell(sheet, picture, exposure, caption);
    if (!cell)
        return false;
    if (sheet->count == CONTACT_SHEET_CELLS)
        free(sheet->cells[--sheet->count]);
    sheet->cells[sheet->count++] = cell;
    return true;
}

static void place_cell(const struct contact_sheet *sheet, uint32_t index, uint8_t *rgba,
                       uint32_t width)
{
    const uint32_t height = sheet->cell_height + CAPTION_BAR;
    uint32_t left = GAP + index % CONTACT_SHEET_COLUMNS * (sheet->cell_width + GAP);
    uint32_t top = GAP + index / CONTACT_SHEET_COLUMNS * (height + GAP);
    for (uint32_t y = 0; y < height; y++)
        memcpy(rgba + 4 * ((size_t)(top + y) * width + left),
               sheet->cells[index] + 4 * (size_t)y * sheet->cell_width, 4 * sheet->cell_width);
}

bool contact_sheet_write(const struct contact_sheet *sheet, const char *path)
{
    const uint32_t rows = (sheet->count + CONTACT_SHEET_COLUMNS - 1) / CONTACT_SHEET_COLUMNS;
    const uint32_t columns =
        sheet->count < CONTACT_SHEET_COLUMNS ? sheet->count : CONTACT_SHEET_COLUMNS;
    const uint32_t width = GAP + columns * (sheet->cell_width + GAP);
    const uint32_t height = GAP + rows * (sheet->cell_height + CAPTION_BAR + GAP);
    uint8_t *rgba = malloc((size_t)width * height * 4);
    if (!rgba) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    fill_paper(rgba, (size_t)width * height);
    for (uint32_t i = 0; i < sheet->count; i++)
        place_cell(sheet, i, rgba, width);
    bool done = png_file_write(path, rgba, width, height);
    free(rgba);
    return done;
}

void contact_sheet_finish(struct contact_sheet *sheet)
{
    for (uint32_t i = 0; i < sheet->count; i++)
        free(sheet->cells[i]);
    memset(sheet, 0, sizeof *sheet);
}
