#include "picture_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include <openexr.h>

#include <sluice/dds.h>
#include <sluice/exr.h>
#include <sluice/ktx2.h>

#include "../../tools/common/input.h"
#include "../../tools/common/log.h"
#include "../../tools/common/text.h"

static const SluiceLogCallback to_stderr = {NULL, log_say};

static void say_nothing(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

/* Returns false for unreadable files: the later reader reports the error. */
static bool exr_has_levels(const char *path)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context = NULL;
    exr_storage_t storage;
    exr_tile_level_mode_t levels = EXR_TILE_ONE_LEVEL;
    exr_tile_round_mode_t rounding;
    uint32_t width, height;
    init.error_handler_fn = say_nothing;
    if (exr_start_read(&context, path, &init) != EXR_ERR_SUCCESS)
        return false;
    bool tiled =
        exr_get_storage(context, 0, &storage) == EXR_ERR_SUCCESS && storage == EXR_STORAGE_TILED &&
        exr_get_tile_descriptor(context, 0, &width, &height, &levels, &rounding) == EXR_ERR_SUCCESS;
    exr_finish(&context);
    return tiled && levels != EXR_TILE_ONE_LEVEL;
}

SluiceResult picture_file_kind(const char *path, enum picture_kind *kind)
{
    static const char store[] = "\x89SLS\r\n\x1A\n", ktx2[] = "\xABKTX 20\xBB\r\n\x1A\n";
    char bytes[12] = {0};
    FILE *file = input_open(path);
    if (file)
        (void)!fread(bytes, 1, sizeof bytes, file);
    bool failed = !file || ferror(file);
    bool later = !file && (errno == EMFILE || errno == ENFILE);
    if (failed && !later)
        text_say("%s: %s", path, input_reason(errno));
    if (file)
        fclose(file);
    if (memcmp(bytes, store, 8) == 0)
        *kind = PICTURE_STORE;
    else if (memcmp(bytes, "\x76\x2F\x31\x01", 4) == 0)
        *kind = exr_has_levels(path) ? PICTURE_EXR : PICTURE_EXR_LEVEL_ZERO;
    else if (memcmp(bytes, "DDS ", 4) == 0)
        *kind = PICTURE_DDS;
    else
        *kind = memcmp(bytes, ktx2, 12) == 0 ? PICTURE_KTX2 : PICTURE_OTHER;
    return later ? SLUICE_NOT_READY : failed ? SLUICE_ERROR_IO : SLUICE_SUCCESS;
}

/** Halves memory and bandwidth by dropping precision that screens cannot show. */
static SluiceFormat narrowed(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_R32_SFLOAT: return SLUICE_FORMAT_R16_SFLOAT;
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: return SLUICE_FORMAT_R16G16B16A16_SFLOAT;
    default: return format;
    }
}

SluiceResult picture_file_exr_format(const char *path, enum pixel_format pixels,
                                     SluiceFormat *format)
{
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = path,
                                             .log = to_stderr,
                                             .maxMemorySize = UINT64_MAX}; /* no texel is read */
    SluiceImageSource *source = NULL;
    SluiceImageInfo info = {.structSize = sizeof info};
    *format = pixels == PIXEL_FORMAT_RGBA8 ? SLUICE_FORMAT_R8G8B8A8_SRGB
                                           : SLUICE_FORMAT_R16G16B16A16_SFLOAT;
    if (pixels != PIXEL_FORMAT_AUTO)
        return SLUICE_SUCCESS;
    SluiceResult result = sluiceCreateExrImageSource(&create, &source);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetImageInfo(source, &info);
    if (result == SLUICE_SUCCESS)
        *format = narrowed(info.format);
    sluiceDestroyImageSource(source);
    return result;
}

static SluiceResult open_exr(const char *path, const struct picture_opening *opening,
                             SluiceImageSource **source)
{
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = path,
                                             .log = to_stderr,
                                             .memoryBudget = opening->memory};
    SluiceResult result = picture_file_exr_format(path, opening->pixels, &create.format);
    return result == SLUICE_SUCCESS ? sluiceCreateExrImageSource(&create, source) : result;
}

static SluiceResult lacking(const char *path, const char *what)
{
    text_say("%s: this build of Sluice was made without %s", path, what);
    return SLUICE_ERROR_UNSUPPORTED;
}

static SluiceResult open_store(const char *path, const struct picture_opening *opening,
                               SluiceImageSource **source)
{
#ifdef HAVE_STORE
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = path,
                                               .pInput = opening->input,
                                               .log = to_stderr,
                                               .readPool = opening->pool};
    return sluiceCreateStoreImageSource(&create, source);
#else
    (void)opening, (void)source;
    return lacking(path, "sluice-store, which reads tile stores (it needs libzstd and libxxhash)");
#endif
}

#ifdef HAVE_CONTAINER
/* Headers without a DXGI format cannot declare sRGB. Pictures hold sRGB colors. */
static SluiceFormat dds_color_format(const char *path, SluiceFormat format)
{
    char bytes[88] = {0};
    FILE *file = input_open(path);
    bool says = !file || fread(bytes, 1, sizeof bytes, file) != sizeof bytes ||
                memcmp(bytes + 84, "DX10", 4) == 0;
    if (file)
        fclose(file);
    if (says)
        return format;
    switch (format) {
    case SLUICE_FORMAT_R8G8B8A8_UNORM: return SLUICE_FORMAT_R8G8B8A8_SRGB;
    case SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK: return SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK;
    case SLUICE_FORMAT_BC2_UNORM_BLOCK: return SLUICE_FORMAT_BC2_SRGB_BLOCK;
    case SLUICE_FORMAT_BC3_UNORM_BLOCK: return SLUICE_FORMAT_BC3_SRGB_BLOCK;
    default: return format;
    }
}

static SluiceResult open_dds(const char *path, SluiceImageSource **source)
{
    SluiceDdsImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = path, .log = to_stderr};
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceCreateDdsImageSource(&create, source);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetImageInfo(*source, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    create.format = dds_color_format(path, info.format);
    sluiceDestroyImageSource(*source);
    *source = NULL;
    return sluiceCreateDdsImageSource(&create, source);
}
#endif

static SluiceResult open_container(const char *path, bool is_dds, SluiceImageSource **source)
{
#ifdef HAVE_CONTAINER
    SluiceKtx2ImageSourceCreateInfo ktx2 = {
        .structSize = sizeof ktx2, .pPath = path, .log = to_stderr};
    return is_dds ? open_dds(path, source) : sluiceCreateKtx2ImageSource(&ktx2, source);
#else
    (void)is_dds, (void)source;
    return lacking(path, "sluice-container, which reads DDS and KTX2 files");
#endif
}

SluiceResult picture_file_open(const char *path, enum picture_kind kind,
                               const struct picture_opening *opening, SluiceImageSource **source,
                               SluiceImageInfo *info)
{
    SluiceResult result = SLUICE_ERROR_UNSUPPORTED;
    *source = NULL;
    info->structSize = sizeof *info;
    switch (kind) {
    case PICTURE_STORE: result = open_store(path, opening, source); break;
    case PICTURE_EXR:
    case PICTURE_EXR_LEVEL_ZERO: result = open_exr(path, opening, source); break;
    case PICTURE_DDS:
    case PICTURE_KTX2: result = open_container(path, kind == PICTURE_DDS, source); break;
    case PICTURE_OTHER:
        result = lacking(path, "sluice-bake, which reads such pictures (it needs libvips, libzstd "
                               "and libxxhash)");
        break;
    }
    if (result == SLUICE_SUCCESS)
        result = sluiceGetImageInfo(*source, info);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyImageSource(*source);
        *source = NULL;
    }
    return result;
}
