#include "oracle/pictures.h"

#include <stdio.h>
#include <stdlib.h>
#include <vips/vips.h>

static bool take_values(struct oracle_picture *picture, const void *raw, VipsBandFormat format)
{
    size_t count = (size_t)picture->width * picture->height * picture->bands;
    picture->values = malloc(count * sizeof *picture->values);
    for (size_t i = 0; picture->values && i < count; i++)
        if (format == VIPS_FORMAT_UCHAR)
            picture->values[i] = (float)((const uint8_t *)raw)[i] / 255;
        else if (format == VIPS_FORMAT_USHORT)
            picture->values[i] = (float)((const uint16_t *)raw)[i] / 65535;
        else
            picture->values[i] = ((const float *)raw)[i];
    return picture->values != NULL;
}

void oracle_picture_finish(struct oracle_picture *picture)
{
    free(picture->values);
    *picture = (struct oracle_picture){0};
}

/* libvips 8.14 takes PFM files as if their first row were the upper one; it is the lowest. */
static bool read_pfm(struct oracle_picture *picture, const char *path)
{
    FILE *file = fopen(path, "rb");
    char kind = 0;
    double order = 0;
    if (file &&
        fscanf(file, "P%c %u %u %lf", &kind, &picture->width, &picture->height, &order) == 4 &&
        (kind == 'F' || kind == 'f') && order < 0 && picture->width - 1 < 65536 &&
        picture->height - 1 < 65536 && fgetc(file) != EOF) {
        picture->bands = kind == 'F' ? 3 : 1;
        size_t row = (size_t)picture->width * picture->bands;
        picture->values = malloc(row * picture->height * sizeof *picture->values);
        for (uint32_t y = picture->height; picture->values && y-- > 0;)
            if (fread(picture->values + row * y, sizeof(float), row, file) != row)
                oracle_picture_finish(picture);
    }
    if (file)
        fclose(file);
    if (!picture->values)
        fprintf(stderr, "%s: is no little-endian PFM file\n", path);
    return picture->values != NULL;
}

bool oracle_picture_read(struct oracle_picture *picture, const char *path)
{
    size_t size;
    void *raw = NULL;
    *picture = (struct oracle_picture){0};
    if (g_str_has_suffix(path, ".pfm"))
        return read_pfm(picture, path);
    VipsImage *image = vips_image_new_from_file(path, NULL);
    VipsBandFormat format = image ? vips_image_get_format(image) : VIPS_FORMAT_NOTSET;
    bool ok =
        format == VIPS_FORMAT_UCHAR || format == VIPS_FORMAT_USHORT || format == VIPS_FORMAT_FLOAT;
    if (ok && (raw = vips_image_write_to_memory(image, &size))) {
        *picture = (struct oracle_picture){.width = (uint32_t)image->Xsize,
                                           .height = (uint32_t)image->Ysize,
                                           .bands = (uint32_t)image->Bands,
                                           .eight_bits = format == VIPS_FORMAT_UCHAR,
                                           .has_alpha = vips_image_hasalpha(image)};
        ok = take_values(picture, raw, format);
    }
    if (!ok || !raw)
        fprintf(stderr, "%s: cannot be read: %s\n", path, vips_error_buffer());
    vips_error_clear();
    g_free(raw);
    if (image)
        g_object_unref(image);
    return picture->values != NULL;
}

static double decode(const struct oracle_picture *picture, const struct oracle_lookup *lookup,
                     double x)
{
    bool srgb = lookup->encoding == SLUICE_PBRT_ENCODING_SRGB ||
                (lookup->encoding == SLUICE_PBRT_ENCODING_DEFAULT && picture->eight_bits);
    if (lookup->encoding == SLUICE_PBRT_ENCODING_GAMMA)
        return pow(fmax(x, 0), lookup->gamma);
    if (srgb)
        return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
    return x;
}

/* A texel's place along one axis. False: it is black. */
static bool wrap(SluicePbrtWrap mode, long at, uint32_t size, uint32_t *out)
{
    long n = (long)size;
    if (mode == SLUICE_PBRT_WRAP_BLACK && (at < 0 || at >= n))
        return false;
    if (mode == SLUICE_PBRT_WRAP_REPEAT)
        *out = (uint32_t)(((at % n) + n) % n);
    else
        *out = (uint32_t)(at < 0 ? 0 : at >= n ? n - 1 : at);
    return true;
}

static struct vec texel(const struct oracle_picture *picture, const struct oracle_lookup *lookup,
                        long x, long y, double *alpha)
{
    uint32_t column, row, bands = picture->bands;
    *alpha = 0;
    if (!wrap(lookup->wrap, x, picture->width, &column) ||
        !wrap(lookup->wrap, y, picture->height, &row))
        return vec(0, 0, 0);
    const float *v = &picture->values[((size_t)row * picture->width + column) * bands];
    *alpha = picture->has_alpha ? (double)v[bands - 1] : 1;
    double first = decode(picture, lookup, v[0]);
    if (bands < 3)
        return vec(first, first, first);
    return vec(first, decode(picture, lookup, v[1]), decode(picture, lookup, v[2]));
}

struct vec oracle_picture_sample(const struct oracle_picture *picture,
                                 const struct oracle_lookup *lookup, double u, double v,
                                 double *alpha)
{
    double x = u * picture->width - 0.5, y = v * picture->height - 0.5;
    if (!(fabs(x) < 1e9) || !(fabs(y) < 1e9))
        x = y = 0;
    if (lookup->nearest)
        return texel(picture, lookup, (long)floor(x + 0.5), (long)floor(y + 0.5), alpha);
    double fx = x - floor(x), fy = y - floor(y);
    struct vec sum = vec(0, 0, 0);
    *alpha = 0;
    for (int i = 0; i < 4; i++) {
        double weight = (i & 1 ? fx : 1 - fx) * (i & 2 ? fy : 1 - fy), a;
        sum = along(sum,
                    texel(picture, lookup, (long)floor(x) + (i & 1), (long)floor(y) + (i >> 1), &a),
                    weight);
        *alpha += weight * a;
    }
    return sum;
}
