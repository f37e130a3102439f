#define _XOPEN_SOURCE 700

#include "file_report.h"

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

static void print_time(FILE *out, int64_t nanoseconds)
{
    char text[32];
    time_t seconds = (time_t)(nanoseconds / 1000000000);
    struct tm broken;
    if (gmtime_r(&seconds, &broken) &&
        strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &broken) > 0)
        fprintf(out, ", %s", text);
    fprintf(out, "\n");
}

static void print_levels(FILE *out, const SluiceStoreLayout *layout)
{
    for (uint32_t l = 0; l < layout->tailFirstLevel; l++)
        fprintf(out, "  level %-2u                %u x %u, %u x %u tiles\n", l,
                level_size(layout->width, l), level_size(layout->height, l),
                layout->levelWidthInTiles[l], layout->levelHeightInTiles[l]);
    fprintf(out, "  mip tail                levels %u to %u, %u bytes\n", layout->tailFirstLevel,
            layout->mipLevelCount - 1, layout->tailSize);
}

static void print_store(FILE *out, const SluiceStoreInfo *s)
{
    fprintf(out, "  version                 %u.%u\n", s->versionMajor, s->versionMinor);
    fprintf(out, "  meaning                 %s\n", name_of(meanings, 5, s->meaning));
    fprintf(out, "  color space             %s\n", name_of(spaces, 5, s->colorSpace));
    fprintf(out, "  address modes           u %s, v %s\n", name_of(modes, 4, s->addressModeU),
            name_of(modes, 4, s->addressModeV));
    fprintf(out, "  source                  ");
    text_write(out, s->pSourceName);
    fprintf(out, ", %" PRIu64 " bytes", s->sourceSize);
    print_time(out, s->sourceModifiedTimeNs);
    fprintf(out, "  hash of the settings    %016" PRIx64 "\n", s->settingsHash);
    fprintf(out, "  Zstandard level         %u\n", s->compressionLevel);
    fprintf(out, "  tiles                   %u x %u texels, %" PRIu64 " per layer\n",
            s->layout.tileWidth, s->layout.tileHeight, s->layout.tileCount);
    print_levels(out, &s->layout);
}

static void print_store_json(FILE *out, const SluiceStoreInfo *s)
{
    fprintf(out, ", \"version\": \"%u.%u\", \"meaning\": \"%s\", \"colorSpace\": \"%s\"",
            s->versionMajor, s->versionMinor, name_of(meanings, 5, s->meaning),
            name_of(spaces, 5, s->colorSpace));
    fprintf(out, ", \"addressModeU\": \"%s\", \"addressModeV\": \"%s\", \"sourceName\": ",
            name_of(modes, 4, s->addressModeU), name_of(modes, 4, s->addressModeV));
    text_write_json(out, s->pSourceName);
    fprintf(out,
            ", \"sourceSize\": %" PRIu64 ", \"sourceModifiedTimeNs\": %" PRId64
            ", \"settingsHash\": \"%016" PRIx64 "\", \"compressionLevel\": %u",
            s->sourceSize, s->sourceModifiedTimeNs, s->settingsHash, s->compressionLevel);
    fprintf(out,
            ", \"tileWidth\": %u, \"tileHeight\": %u, \"tileCount\": %" PRIu64
            ", \"tailFirstLevel\": %u, \"tailSize\": %u",
            s->layout.tileWidth, s->layout.tileHeight, s->layout.tileCount,
            s->layout.tailFirstLevel, s->layout.tailSize);
}
#endif

static void show_what_is_in_a_store(FILE *out, const struct texture_file *file, bool json)
{
#ifdef HAVE_STORE
    SluiceStoreInfo info = {.structSize = sizeof info};
    if (!file->is_store || sluiceGetStoreInfo(file->source, &info) != SLUICE_SUCCESS)
        return;
    if (json)
        print_store_json(out, &info);
    else
        print_store(out, &info);
#else
    (void)out, (void)file, (void)json;
#endif
}

#ifdef HAVE_EXR
static const char *const storages[] = {"scanlines", "tiles", "tiles, mip-mapped",
                                       "tiles, rip-mapped"};

static uint64_t mib(uint64_t size)
{
    return (size + (1 << 20) - 1) >> 20;
}

static void print_exr(FILE *out, const SluiceExrInfo *e)
{
    fprintf(out, "  storage                 %s, %u x %u texels each, %s\n",
            name_of(storages, 4, e->storage), e->chunkWidth, e->chunkHeight, e->pCompression);
    fprintf(out, "  channels                %s\n", e->pChannels);
    if (e->hasChromaticities) {
        const float *c = e->chromaticities;
        fprintf(out, "  primaries               %g %g, %g %g, %g %g, white %g %g%s\n", (double)c[0],
                (double)c[1], (double)c[2], (double)c[3], (double)c[4], (double)c[5], (double)c[6],
                (double)c[7], e->convertsPrimaries ? "; read as those of Rec. 709" : "");
    }
    if (e->chainSize)
        fprintf(
            out,
            "  levels                  only level 0; readers build the others in %" PRIu64
            " MiB of memory;\n"
            "                          sluice-bake FILE -o DIR writes a store with all levels\n",
            mib(e->chainSize));
}

/* Writes null for values that are not finite, because JSON has no numbers for them. */
static void write_number(FILE *out, const char *before, float value)
{
    if (isfinite(value))
        fprintf(out, "%s%.9g", before, (double)value);
    else
        fprintf(out, "%snull", before);
}

static void print_exr_json(FILE *out, const SluiceExrInfo *e)
{
    fprintf(out,
            ", \"storage\": \"%s\", \"chunkWidth\": %u, \"chunkHeight\": %u"
            ", \"compression\": \"%s\", \"channels\": ",
            name_of(storages, 4, e->storage), e->chunkWidth, e->chunkHeight, e->pCompression);
    text_write_json(out, e->pChannels);
    fprintf(out, ", \"chainSize\": %" PRIu64 ", \"readSize\": %" PRIu64, e->chainSize, e->readSize);
    if (!e->hasChromaticities)
        return;
    fprintf(out, ", \"convertsPrimaries\": %s, \"chromaticities\": [",
            e->convertsPrimaries ? "true" : "false");
    for (int i = 0; i < 8; i++)
        write_number(out, i ? ", " : "", e->chromaticities[i]);
    fprintf(out, "]");
}
#endif

static void show_what_is_in_an_exr(FILE *out, const struct texture_file *file, bool json)
{
#ifdef HAVE_EXR
    SluiceExrInfo info = {.structSize = sizeof info};
    if (sluiceGetExrInfo(file->source, &info) != SLUICE_SUCCESS)
        return;
    if (json)
        print_exr_json(out, &info);
    else
        print_exr(out, &info);
#else
    (void)out, (void)file, (void)json;
#endif
}

static uint64_t size_of(const struct texture_file *file, const char *path)
{
    return file->remote.file ? file->remote.input.size : files_size(path);
}

static void print_file(FILE *out, const struct texture_file *file, const char *path)
{
    const SluiceImageInfo *image = &file->image;
    text_write(out, path);
    fprintf(out, ": %s\n", file->kind);
    const uint32_t layers = image->arrayLayerCount ? image->arrayLayerCount : 1;
    fprintf(out, "  size                    %u x %u texels, %u level%s, %u layer%s\n", image->width,
            image->height, image->mipLevelCount, image->mipLevelCount == 1 ? "" : "s", layers,
            layers == 1 ? "" : "s");
    if (image->cube)
        fprintf(out, "  cube maps               %u of six faces each\n",
                image->arrayLayerCount / 6);
    fprintf(out, "  format                  %s\n", sluiceGetFormatName(image->format));
    fprintf(out, "  texels                  %" PRIu64 " bytes\n", texel_size(image));
    fprintf(out, "  file                    %" PRIu64 " bytes\n", size_of(file, path));
    show_what_is_in_a_store(out, file, false);
    show_what_is_in_an_exr(out, file, false);
}

static void print_file_json(FILE *out, const struct texture_file *file, const char *path)
{
    const SluiceImageInfo *image = &file->image;
    fprintf(out, "{\"file\": ");
    text_write_json(out, path);
    fprintf(out,
            ", \"kind\": \"%s\", \"width\": %u, \"height\": %u, \"mipLevelCount\": %u"
            ", \"arrayLayerCount\": %u, \"cube\": %s, \"format\": \"%s\", \"texelSize\": %" PRIu64
            ", \"fileSize\": %" PRIu64,
            file->kind, image->width, image->height, image->mipLevelCount,
            image->arrayLayerCount ? image->arrayLayerCount : 1, image->cube ? "true" : "false",
            sluiceGetFormatName(image->format), texel_size(image), size_of(file, path));
    show_what_is_in_a_store(out, file, true);
    show_what_is_in_an_exr(out, file, true);
    fprintf(out, "}\n");
}

bool report_texture_file(const char *path, bool json, FILE *out)
{
    const struct texture_opening opening = {
        .memory = UINT64_MAX}; /* no limit, because no texel is read */
    struct texture_file file;
    if (!open_texture_file(&file, path, &opening))
        return false;
    if (json)
        print_file_json(out, &file, path);
    else
        print_file(out, &file, path);
    close_texture_file(&file);
    return true;
}
