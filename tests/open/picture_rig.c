#define _XOPEN_SOURCE 700

#include "open/picture_rig.h"

#include "base/alloc.h"
#include "base/cache_folder.h"
#include "base/checked.h"
#include "open/store_cache.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

void picture_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct picture_fixture *f = user;
    f->errors += severity == SLUICE_LOG_ERROR;
    f->warnings += severity == SLUICE_LOG_WARNING;
    if (severity == SLUICE_LOG_ERROR)
        snprintf(f->last, sizeof f->last, "%s", message);
    if (severity == SLUICE_LOG_WARNING)
        snprintf(f->last_warning, sizeof f->last_warning, "%s", message);
}

void write_picture(const char *path, uint32_t width, uint32_t height, uint32_t seed)
{
    uint8_t *samples = malloc((size_t)width * height * 3);
    for (uint32_t i = 0; i < width * height * 3; i++)
        samples[i] = (uint8_t)(i / 3 % width / 7 + seed + i % 3 * 40);
    write_png(path, samples, width, height, 3, false);
    free(samples);
}

void picture_opener(struct picture_fixture *f, uint64_t max_cache_size)
{
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .maxOpenFileCount = 1,
                                        .pCacheFolder = f->cache,
                                        .maxCacheSize = max_cache_size,
                                        .bakeThreadCount = 1,
                                        .log = {f, picture_log}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f->opener));
}

void picture_setup(struct picture_fixture *f)
{
    memset(f, 0, sizeof *f);
    bake_folder_init(&f->folder);
    snprintf(f->cache, sizeof f->cache, "%s/cache", f->folder.path);
    bake_folder_file(&f->folder, "a.png", f->png);
    write_picture(f->png, PICTURE_WIDTH, PICTURE_HEIGHT, 1);
    picture_opener(f, 0);
}

void picture_teardown(struct picture_fixture *f)
{
    char command[500];
    sluiceDestroyImageOpener(f->opener);
    snprintf(command, sizeof command, "rm -rf '%s'", f->cache);
    assert_int_equal(system(command), 0);
    bake_folder_finish(&f->folder);
}

void store_path(const struct picture_fixture *f, const char *picture, char path[512])
{
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    char *made;
    CHECK_OK(slc_store_cache_path(f->cache, picture, 0, &cb, &made));
    snprintf(path, 512, "%s", made);
    slc_free(&cb, made, strlen(made) + 1, 1);
}

SluiceOpenedImageInfo state_of(SluiceImageSource *source)
{
    SluiceOpenedImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetOpenedImageInfo(source, &info));
    return info;
}

void wait_a_little(void)
{
    const struct timespec time = {0, 2000000};
    nanosleep(&time, NULL);
}

SluiceOpenedImageInfo wait_for(SluiceImageSource *source)
{
    SluiceOpenedImageInfo info = state_of(source);
    for (int i = 0; !info.ready && info.failure == SLUICE_SUCCESS && i < 60000; i++) {
        wait_a_little();
        info = state_of(source);
    }
    return info;
}

SluiceResult read_texel(SluiceImageSource *source, uint32_t level, uint8_t texel[4])
{
    SluiceImageRegion region = {level, 0, 0, 1, 1, 0};
    return sluiceReadImageRegion(source, &region, texel, 4);
}

void check_baked(struct picture_fixture *f, SluiceImageSource *source, const char *picture)
{
    char baked[256];
    SluiceImageInfo info = {.structSize = sizeof info};
    bake_folder_file(&f->folder, "baked.store", baked);
    bake_picture_file(picture, baked, NULL);
    CHECK_OK(sluiceGetImageInfo(source, &info));
    assert_string_equal(info.pName, picture);
    for (uint32_t level = 0; level < info.mipLevelCount; level++) {
        size_t size;
        uint8_t *expected = read_bytes(baked, level, &size), *texels = malloc(size);
        SluiceImageRegion region = {level, 0, 0, slc_mip_size(info.width, level),
                                    slc_mip_size(info.height, level)};
        CHECK_OK(sluiceReadImageRegion(source, &region, texels, (size_t)region.width * 4));
        assert_memory_equal(texels, expected, size);
        free(expected);
        free(texels);
    }
    unlink(baked);
}

SluiceStoreWriter *begin_writing(const char *path)
{
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = path,
                                  .width = 16,
                                  .height = 16,
                                  .format = SLUICE_FORMAT_R8_UNORM};
    SluiceStoreWriter *writer;
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    return writer;
}
