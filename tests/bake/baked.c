#define _XOPEN_SOURCE 700

#include "bake/baked.h"

#include "base/checked.h"
#include "image/convert.h"
#include "support/test.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <vips/vips.h>

void bake_folder_init(struct bake_folder *folder)
{
    strcpy(folder->path, "/tmp/sluice-bake-XXXXXX");
    assert_non_null(mkdtemp(folder->path));
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *where)
{
    (void)status, (void)kind, (void)where;
    return remove(path);
}

void bake_folder_finish(struct bake_folder *folder)
{
    assert_int_equal(nftw(folder->path, remove_entry, 8, FTW_DEPTH | FTW_PHYS), 0);
}

const char *bake_folder_file(const struct bake_folder *folder, const char *name, char path[256])
{
    snprintf(path, 256, "%s/%s", folder->path, name);
    return path;
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    *info = ((struct plain_source *)base)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t pitch)
{
    struct plain_source *source = (struct plain_source *)base;
    size_t size = sluiceGetFormatTexelSize(source->info.format);
    for (uint32_t y = 0; y < region->height; y++)
        memcpy((char *)texels + y * pitch,
               (const char *)source->texels +
                   ((size_t)(region->y + y) * source->info.width + region->x) * size,
               region->width * size);
    return SLUICE_SUCCESS;
}

static void keep(SluiceImageSource *base)
{
    (void)base;
}

void plain_source_init(struct plain_source *source, SluiceFormat format, uint32_t width,
                       uint32_t height, const void *texels)
{
    static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                         keep};
    *source = (struct plain_source){.base.pInterface = &interface, .texels = texels};
    source->info = (SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                                     .width = width,
                                     .height = height,
                                     .mipLevelCount = 1,
                                     .format = format,
                                     .pName = "plain"};
}

void *read_bytes(const char *path, uint32_t level, size_t *size)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetImageInfo(source, &info));
    uint32_t width = slc_mip_size(info.width, level), height = slc_mip_size(info.height, level);
    SluiceImageRegion region = {level, 0, 0, width, height, 0};
    *size = (size_t)sluiceGetFormatRegionSize(info.format, width, height);
    void *bytes = malloc(*size);
    CHECK_OK(sluiceReadImageRegion(source, &region, bytes,
                                   (size_t)sluiceGetFormatRegionSize(info.format, width, 1)));
    sluiceDestroyImageSource(source);
    return bytes;
}

float *read_level(const char *path, uint32_t level, uint32_t *width, uint32_t *height)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetImageInfo(source, &info));
    sluiceDestroyImageSource(source);
    *width = slc_mip_size(info.width, level);
    *height = slc_mip_size(info.height, level);
    size_t size, count = (size_t)*width * *height;
    void *bytes = read_bytes(path, level, &size);
    float *rgba = malloc(4 * count * sizeof *rgba);
    slc_texels_to_rgba(info.format, bytes, rgba, count);
    free(bytes);
    return rgba;
}

void write_png(const char *path, const void *samples, uint32_t width, uint32_t height,
               uint32_t channels, bool wide)
{
    size_t size = (size_t)width * height * channels * (wide ? 2 : 1);
    assert_int_equal(VIPS_INIT("test"), 0);
    VipsImage *image =
        vips_image_new_from_memory(samples, size, (int)width, (int)height, (int)channels,
                                   wide ? VIPS_FORMAT_USHORT : VIPS_FORMAT_UCHAR);
    assert_non_null(image);
    VipsInterpretation color = wide ? VIPS_INTERPRETATION_RGB16 : VIPS_INTERPRETATION_sRGB;
    VipsInterpretation gray = wide ? VIPS_INTERPRETATION_GREY16 : VIPS_INTERPRETATION_B_W;
    VipsImage *named;
    assert_int_equal(vips_copy(image, &named, "interpretation", channels > 2 ? color : gray, NULL),
                     0);
    assert_int_equal(vips_image_write_to_file(named, path, NULL), 0);
    g_object_unref(named);
    g_object_unref(image);
}

static void bake_with(const SluiceBakeInfo *info)
{
    SluiceBakerCreateInfo create = {.structSize = sizeof create, .threadCount = 1};
    SluiceBaker *baker;
    CHECK_OK(sluiceCreateBaker(&create, &baker));
    CHECK_OK(sluiceBakeFile(baker, info, NULL));
    sluiceDestroyBaker(baker);
}

void bake_source(SluiceImageSource *source, const char *path, const SluiceBakeSettings *settings)
{
    SluiceBakeInfo info = {
        .structSize = sizeof info, .source = source, .pOutputPath = path, .pSettings = settings};
    bake_with(&info);
}

void bake_picture_file(const char *input, const char *path, const SluiceBakeSettings *settings)
{
    SluiceBakeInfo info = {
        .structSize = sizeof info, .pInputPath = input, .pOutputPath = path, .pSettings = settings};
    bake_with(&info);
}
