#include "png_rows.h"

#include "../common/text.h"

#ifdef HAVE_PNG

#include <errno.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

struct png_rows {
    png_structp png;
    png_infop info;
    const char *path;
    uint32_t width;
};

static void on_error(png_structp png, png_const_charp message)
{
    const struct png_rows *rows = png_get_error_ptr(png);
    text_say("sluice-info: %s: %s", rows->path, errno ? strerror(errno) : message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

/* Returns false on an error of libpng, which jumps back to setjmp. */
static bool write_header(struct png_rows *rows, FILE *out, uint32_t height)
{
    if (setjmp(png_jmpbuf(rows->png)))
        return false;
    errno = 0;
    png_set_user_limits(rows->png, rows->width, height); /* libpng's own are below ours */
    png_init_io(rows->png, out);
    png_set_IHDR(rows->png, rows->info, rows->width, height, 8, PNG_COLOR_TYPE_RGBA,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(rows->png, rows->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(rows->png, rows->info);
    return true;
}

struct png_rows *png_rows_begin(FILE *out, const char *path, uint32_t width, uint32_t height)
{
    struct png_rows *rows = calloc(1, sizeof *rows);
    if (rows) {
        rows->path = path;
        rows->width = width;
        rows->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, rows, on_error, on_warning);
        rows->info = rows->png ? png_create_info_struct(rows->png) : NULL;
    }
    if (!rows || !rows->info)
        text_say("sluice-info: %s: out of memory", path);
    else if (write_header(rows, out, height))
        return rows;
    png_rows_end(rows, false);
    return NULL;
}

bool png_rows_write(struct png_rows *rows, const uint8_t *rgba, uint32_t count)
{
    if (setjmp(png_jmpbuf(rows->png)))
        return false;
    errno = 0;
    for (uint32_t y = 0; y < count; y++)
        png_write_row(rows->png, rgba + 4 * (size_t)rows->width * y);
    return true;
}

static bool write_end(struct png_rows *rows)
{
    if (setjmp(png_jmpbuf(rows->png)))
        return false;
    errno = 0;
    png_write_end(rows->png, rows->info);
    return true;
}

bool png_rows_end(struct png_rows *rows, bool whole)
{
    if (!rows)
        return false;
    bool done = whole && write_end(rows);
    png_destroy_write_struct(&rows->png, &rows->info);
    free(rows);
    return done;
}

#else

struct png_rows *png_rows_begin(FILE *out, const char *path, uint32_t width, uint32_t height)
{
    (void)out, (void)width, (void)height;
    text_say("sluice-info: %s: this build writes no PNG files", path);
    return NULL;
}

bool png_rows_write(struct png_rows *rows, const uint8_t *rgba, uint32_t count)
{
    (void)rows, (void)rgba, (void)count;
    return false;
}

bool png_rows_end(struct png_rows *rows, bool whole)
{
    (void)rows, (void)whole;
    return false;
}

#endif
