#define _XOPEN_SOURCE 700

#include "show.h"

#include "open_file.h"
#include "../common/files.h"
#include "../common/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <time.h>

#ifdef HAVE_STORE
#include <sluice/store.h>
#endif
#ifdef HAVE_EXR
#include <sluice/exr.h>
#endif

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static uint64_t texel_size(const SluiceImageInfo *image)
{
    uint64_t size = 0;
    for (uint32_t l = 0; l < image->mipLevelCount; l++)
        size += sluiceGetFormatRegionSize(image->format, level_size(image->width, l),
                                          level_size(image->height, l));
    return size * (image->arrayLayerCount ? image->arrayLayerCount : 1);
}

#if defined(HAVE_STORE) || defined(HAVE_EXR)
static const char *name_of(const char *const *names, unsigned count, unsigned value)
{
    return value < count ? names[value] : "unknown";
}
#endif

#ifdef HAVE_STORE
static const char *const spaces[] = {"undefined", "sRGB", "linear sRGB", "linear Rec. 2020",
                                     "ACEScg"};
static const char *const meanings[] = {"color", "color, straight alpha", "color, premultiplied",
                                       "normals", "data"};
static const char *const modes[] = {"repeat", "mirrored repeat", "clamp to edge",
                                    "clamp to border"};

static void print_time(int64_t nanoseconds)
{
    char text[32];
    time_t seconds = (time_t)(nanoseconds / 1000000000);
    struct tm broken;
    if (gmtime_r(&seconds, &broken) &&
        strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &broken) > 0)
        printf(", %s", text);
    printf("\n");
}

static void print_levels(const SluiceStoreLayout *layout)
{
    for (uint32_t l = 0; l < layout->tailFirstLevel; l++)
        printf("  level %-2u                %u x %u, %u x %u tiles\n", l,
               level_size(layout->width, l), level_size(layout->height, l),
               layout->levelWidthInTiles[l], layout->levelHeightInTiles[l]);
    printf("  mip tail                levels %u to %u, %u bytes\n", layout->tailFirstLevel,
           layout->mipLevelCount - 1, layout->tailSize);
}

static void print_store(const SluiceStoreInfo *s)
{
    printf("  version                 %u.%u\n", s->versionMajor, s->versionMinor);
    printf("  meaning                 %s\n", name_of(meanings, 5, s->meaning));
    printf("  color space             %s\n", name_of(spaces, 5, s->colorSpace));
    printf("  address modes           u %s, v %s\n", name_of(modes, 4, s->addressModeU),
           name_of(modes, 4, s->addressModeV));
    printf("  source                  ");
    text_write(stdout, s->pSourceName);
    printf(", %" PRIu64 " bytes", s->sourceSize);
    print_time(s->sourceModifiedTimeNs);
    printf("  hash of the settings    %016" PRIx64 "\n", s->settingsHash);
    printf("  Zstandard level         %u\n", s->compressionLevel);
    printf("  tiles                   %u x %u texels, %" PRIu64 " per layer\n", s->layout.tileWidth,
           s->layout.tileHeight, s->layout.tileCount);
    print_levels(&s->layout);
}

static void print_store_json(const SluiceStoreInfo *s)
{
    printf(", \"version\": \"%u.%u\", \"meaning\": \"%s\", \"colorSpace\": \"%s\"", s->versionMajor,
           s->versionMinor, name_of(meanings, 5, s->meaning), name_of(spaces, 5, s->colorSpace));
    printf(", \"addressModeU\": \"%s\", \"addressModeV\": \"%s\", \"sourceName\": ",
           name_of(modes, 4, s->addressModeU), name_of(modes, 4, s->addressModeV));
    text_write_json(stdout, s->pSourceName);
    printf(", \"sourceSize\": %" PRIu64 ", \"sourceModifiedTimeNs\": %" PRId64
           ", \"settingsHash\": \"%016" PRIx64 "\", \"compressionLevel\": %u",
           s->sourceSize, s->sourceModifiedTimeNs, s->settingsHash, s->compressionLevel);
    printf(", \"tileWidth\": %u, \"tileHeight\": %u, \"tileCount\": %" PRIu64
           ", \"tailFirstLevel\": %u, \"tailSize\": %u",
           s->layout.tileWidth, s->layout.tileHeight, s->layout.tileCount, s->layout.tailFirstLevel,
           s->layout.tailSize);
}
#endif

static void show_what_is_in_a_store(const struct texture_file *file, bool json)
{
#ifdef HAVE_STORE
    SluiceStoreInfo info = {.structSize = sizeof info};
    if (!file->is_store || sluiceGetStoreInfo(file->source, &info) != SLUICE_SUCCESS)
        return;
    if (json)
        print_store_json(&info);
    else
        print_store(&info);
#else
    (void)file, (void)json;
#endif
}

#ifdef HAVE_EXR
static const char *const storages[] = {"scanlines", "tiles", "tiles, mip-mapped",
                                       "tiles, rip-mapped"};

static uint64_t mib(uint64_t size)
{
    return (size + (1 << 20) - 1) >> 20;
}

static void print_exr(const SluiceExrInfo *e)
{
    printf("  storage                 %s, %u x %u texels each, %s\n",
           name_of(storages, 4, e->storage), e->chunkWidth, e->chunkHeight, e->pCompression);
    printf("  channels                %s\n", e->pChannels);
    if (e->hasChromaticities) {
        const float *c = e->chromaticities;
        printf("  primaries               %g %g, %g %g, %g %g, white %g %g%s\n", (double)c[0],
               (double)c[1], (double)c[2], (double)c[3], (double)c[4], (double)c[5], (double)c[6],
               (double)c[7], e->convertsPrimaries ? "; read as those of Rec. 709" : "");
    }
    if (e->chainSize)
        printf("  levels                  only level 0; readers build the others in %" PRIu64
               " MiB of memory;\n"
               "                          sluice-bake FILE -o DIR writes a store with all levels\n",
               mib(e->chainSize));
}

/* JSON has no words for what is no finite number. */
static void write_number(const char *before, float value)
{
    if (isfinite(value))
        printf("%s%.9g", before, (double)value);
    else
        printf("%snull", before);
}

static void print_exr_json(const SluiceExrInfo *e)
{
    printf(", \"storage\": \"%s\", \"chunkWidth\": %u, \"chunkHeight\": %u"
           ", \"compression\": \"%s\", \"channels\": ",
           name_of(storages, 4, e->storage), e->chunkWidth, e->chunkHeight, e->pCompression);
    text_write_json(stdout, e->pChannels);
    printf(", \"chainSize\": %" PRIu64 ", \"readSize\": %" PRIu64, e->chainSize, e->readSize);
    if (!e->hasChromaticities)
        return;
    printf(", \"convertsPrimaries\": %s, \"chromaticities\": [",
           e->convertsPrimaries ? "true" : "false");
    for (int i = 0; i < 8; i++)
        write_number(i ? ", " : "", e->chromaticities[i]);
    printf("]");
}
#endif

static void show_what_is_in_an_exr(const struct texture_file *file, bool json)
{
#ifdef HAVE_EXR
    SluiceExrInfo info = {.structSize = sizeof info};
    if (sluiceGetExrInfo(file->source, &info) != SLUICE_SUCCESS)
        return;
    if (json)
        print_exr_json(&info);
    else
        print_exr(&info);
#else
    (void)file, (void)json;
#endif
}

static uint64_t size_of(const struct texture_file *file, const char *path)
{
    return file->remote.file ? file->remote.input.size : files_size(path);
}

static void print_file(const struct texture_file *file, const char *path)
{
    const SluiceImageInfo *image = &file->image;
    text_write(stdout, path);
    printf(": %s\n", file->kind);
    const uint32_t layers = image->arrayLayerCount ? image->arrayLayerCount : 1;
    printf("  size                    %u x %u texels, %u level%s, %u layer%s\n", image->width,
           image->height, image->mipLevelCount, image->mipLevelCount == 1 ? "" : "s", layers,
           layers == 1 ? "" : "s");
    if (image->cube)
        printf("  cube maps               %u of six faces each\n", image->arrayLayerCount / 6);
    printf("  format                  %s\n", sluiceGetFormatName(image->format));
    printf("  texels                  %" PRIu64 " bytes\n", texel_size(image));
    printf("  file                    %" PRIu64 " bytes\n", size_of(file, path));
    show_what_is_in_a_store(file, false);
    show_what_is_in_an_exr(file, false);
}

static void print_file_json(const struct texture_file *file, const char *path)
{
    const SluiceImageInfo *image = &file->image;
    printf("{\"file\": ");
    text_write_json(stdout, path);
    printf(", \"kind\": \"%s\", \"width\": %u, \"height\": %u, \"mipLevelCount\": %u"
           ", \"arrayLayerCount\": %u, \"cube\": %s, \"format\": \"%s\", \"texelSize\": %" PRIu64
           ", \"fileSize\": %" PRIu64,
           file->kind, image->width, image->height, image->mipLevelCount,
           image->arrayLayerCount ? image->arrayLayerCount : 1, image->cube ? "true" : "false",
           sluiceGetFormatName(image->format), texel_size(image), size_of(file, path));
    show_what_is_in_a_store(file, true);
    show_what_is_in_an_exr(file, true);
    printf("}\n");
}

int show_file(const struct options *options, const char *path)
{
    const struct texture_opening opening = {.memory = UINT64_MAX}; /* no texel is read */
    struct texture_file file;
    if (!open_texture_file(&file, path, &opening))
        return NOT_SHOWN;
    if (options->json)
        print_file_json(&file, path);
    else
        print_file(&file, path);
    close_texture_file(&file);
    return ALL_SHOWN;
}
