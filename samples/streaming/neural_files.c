#define _XOPEN_SOURCE 700
#include "neural_files.h"

#if defined(HAVE_NEURAL) && defined(HAVE_BAKE)

#include <sluice/neural_source.h>

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../../tools/common/bake_jobs.h"
#include "../../tools/common/files.h"
#include "../../tools/common/log.h"
#include "../../tools/common/text.h"
#include "cache.h"
#include "exposure.h"

static const SluiceLogCallback to_stderr = {NULL, log_say};

static SluiceResult read_counted(void *user, uint64_t offset, void *bytes, size_t size)
{
    const struct neural_file *file = user;
    for (size_t done = 0; done < size;) {
        ssize_t got =
            pread(file->descriptor, (char *)bytes + done, size - done, (off_t)(offset + done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return SLUICE_ERROR_IO;
        done += (size_t)got;
    }
    atomic_fetch_add(file->bytes_read, size);
    return SLUICE_SUCCESS;
}

/** `file` must not move afterwards. */
static bool open_counted(const char *path, atomic_uint_least64_t *bytes_read,
                         struct neural_file *file)
{
    struct stat status;
    *file = (struct neural_file){open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK),
                                 .bytes_read = bytes_read};
    if (file->descriptor < 0 || fstat(file->descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        text_say("%s: cannot read: %s", path,
                 file->descriptor < 0 ? strerror(errno) : "is not a regular file");
        return false;
    }
    file->input = (SluiceInput){.structSize = sizeof file->input,
                                .size = (uint64_t)status.st_size,
                                .pUserData = file,
                                .pfnRead = read_counted};
    return true;
}

/** Makes "folder of the set/name.png". NULL if there is no such file. Free the result. */
static char *find_original(const char *set_path, const char *name)
{
    static const char *const suffixes[] = {"png", "exr", "tif", "tiff", "jpg", "webp", "hdr"};
    const char *slash = strrchr(set_path, '/');
    int folder = slash ? (int)(slash - set_path) : 1;
    size_t size = strlen(set_path) + strlen(name) + 16;
    char *path = malloc(size);
    bool found = false;
    for (size_t i = 0; path && !found && i < sizeof suffixes / sizeof *suffixes; i++) {
        snprintf(path, size, "%.*s/%s.%s", folder, slash ? set_path : ".", name, suffixes[i]);
        found = access(path, R_OK) == 0;
    }
    if (path && !found)
        text_say("%s: its texture %s has no original beside it, such as %s.png, to compare with",
                 set_path, name, name);
    if (!found)
        free(path);
    return found ? path : NULL;
}

/** Formats of a texture: raw texels, blocks, and texels decoded by the GPU. */
struct formats {
    SluiceFormat raw, blocks, decoded;
};

static bool is_hdr(const SluiceNeuralTexture *texture)
{
    return texture->rgbColorSpace == SLUICE_NEURAL_COLOR_HLG ||
           texture->format == SLUICE_NEURAL_CHANNEL_FLOAT16 ||
           texture->format == SLUICE_NEURAL_CHANNEL_FLOAT32;
}

static struct formats formats_of(const SluiceNeuralTexture *texture)
{
    static const struct formats linear[] = {
        {SLUICE_FORMAT_R8_UNORM, SLUICE_FORMAT_BC4_UNORM_BLOCK, SLUICE_FORMAT_BC4_UNORM_BLOCK},
        {SLUICE_FORMAT_R8G8_UNORM, SLUICE_FORMAT_BC5_UNORM_BLOCK, SLUICE_FORMAT_BC5_UNORM_BLOCK},
        {SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_FORMAT_BC7_UNORM_BLOCK,
         SLUICE_FORMAT_BC7_UNORM_BLOCK},
        {SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_FORMAT_BC7_UNORM_BLOCK,
         SLUICE_FORMAT_BC7_UNORM_BLOCK}};
    const struct formats srgb = {SLUICE_FORMAT_R8G8B8A8_SRGB, SLUICE_FORMAT_BC7_SRGB_BLOCK,
                                 SLUICE_FORMAT_BC7_SRGB_BLOCK};
    const struct formats hdr = {SLUICE_FORMAT_R16G16B16A16_SFLOAT, SLUICE_FORMAT_BC6H_UFLOAT_BLOCK,
                                SLUICE_FORMAT_R16G16B16A16_SFLOAT};
    if (is_hdr(texture))
        return hdr;
    return texture->rgbColorSpace == SLUICE_NEURAL_COLOR_SRGB ? srgb
                                                              : linear[texture->channelCount - 1];
}

static bool is_hangable(const char *path, const SluiceNeuralTexture *texture)
{
    if (is_hdr(texture) && texture->channelCount < 3)
        text_say("%s: its texture %s is left out: it has floats, and less than three channels",
                 path, texture->pName);
    else if (strchr(texture->pName, '/') || !*texture->pName)
        text_say("%s: its texture '%s' is left out: no file has that name", path, texture->pName);
    else
        return true;
    return false;
}

/* Texture of the set before its sources are open. */
struct hanging {
    SluiceNeuralTexture texture;
    char *original, *stores[2]; ///< owned; raw texels and blocks
};

static char *store_path(const char *original, const char *cache, const char *kind)
{
    char folder[4096], *whole = realpath(original, NULL), *path = NULL;
    if (whole && cache_path(cache, "neural", folder, sizeof folder)) {
        size_t size = strlen(folder) + strlen(whole) + 32;
        path = malloc(size);
        if (path)
            snprintf(path, size, "%s%s.%s" SLUICE_STORE_EXTENSION, folder, whole, kind);
    }
    free(whole);
    return path;
}

static bool bake(struct hanging *hangings, uint32_t count, const struct settings *settings)
{
    struct bake_job jobs[2 * SLUICE_NEURAL_MAX_CHANNELS] = {0};
    const struct bake_conditions conditions = {.speaker = ""};
    uint32_t job_count = 0;
    for (uint32_t i = 0; i < 2 * count; i++) {
        struct hanging *hanging = &hangings[i / 2];
        struct formats formats = formats_of(&hanging->texture);
        bool srgb = hanging->texture.rgbColorSpace == SLUICE_NEURAL_COLOR_SRGB;
        hanging->stores[i % 2] =
            store_path(hanging->original, settings->cache, i % 2 ? "blocks" : "raw");
        if (!hanging->stores[i % 2])
            return false;
        jobs[job_count++] =
            (struct bake_job){.input = hanging->original,
                              .output = hanging->stores[i % 2],
                              .size = files_size(hanging->original),
                              .settings = {.structSize = sizeof(SluiceBakeSettings),
                                           .format = i % 2 ? formats.blocks : formats.raw,
                                           .transfer = srgb ? SLUICE_BAKE_TRANSFER_SRGB
                                                            : SLUICE_BAKE_TRANSFER_LINEAR}};
    }
    if (!bake_jobs_run(jobs, job_count, &conditions))
        return false;
    for (uint32_t i = 0; i < job_count; i++)
        if (!jobs[i].is_done || jobs[i].result != SLUICE_SUCCESS) {
            text_say("%s", jobs[i].message[0] ? jobs[i].message : "a picture cannot be baked");
            return false;
        }
    return true;
}

static bool open_store(struct neural_files *files, SluiceStoreReadPool *pool, const char *path,
                       bool streamed, SluiceImageSource **source)
{
    struct neural_file *file = &files->stores[files->store_count];
    if (!open_counted(path, streamed ? &files->bytes_read : &files->bytes_beside, file))
        return false;
    files->store_count++;
    const SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info,
                                                   .pPath = path,
                                                   .pInput = &file->input,
                                                   .log = to_stderr,
                                                   .readPool = pool};
    return sluiceCreateStoreImageSource(&info, source) == SLUICE_SUCCESS;
}

static bool open_neural_source(const struct neural_files *files, uint32_t texture,
                               SluiceImageSource **source)
{
    const SluiceNeuralImageSourceCreateInfo info = {
        .structSize = sizeof info, .set = files->set, .textureIndex = texture, .log = to_stderr};
    return sluiceCreateNeuralImageSource(&info, source) == SLUICE_SUCCESS;
}

static bool find_spaces(const struct neural_files *files, struct neural_picture *neural)
{
    for (uint32_t c = 0; c < neural->texture.channelCount; c++) {
        if (sluiceGetNeuralChannel(files->set, neural->texture.firstChannel + c,
                                   &neural->from[c]) != SLUICE_SUCCESS)
            return false;
        neural->to[c] =
            c < 3 && !neural->hdr ? neural->texture.rgbColorSpace : SLUICE_NEURAL_COLOR_LINEAR;
    }
    return true;
}

/** Adds a picture for a texture in a mode. Counts it before it is complete, so that it is closed
 * after an error. */
static bool hang(struct picture_list *list, const struct hanging *hanging, uint32_t texture,
                 enum neural_mode mode, bool takes_blocks)
{
    struct neural_files *files = list->neural;
    struct picture *picture = &list->pictures[list->count++];
    struct formats formats = formats_of(&hanging->texture);
    struct neural_picture *neural = calloc(1, sizeof *neural);
    *picture = (struct picture){.path = strdup(hanging->original), .neural = neural};
    if (!picture->path || !neural)
        return false;
    *neural = (struct neural_picture){
        .texture = hanging->texture, .mode = mode, .hdr = is_hdr(&hanging->texture)};
    neural->format = takes_blocks || neural->hdr                  ? formats.decoded
                     : formats.raw == SLUICE_FORMAT_R8G8B8A8_SRGB ? formats.raw
                                                                  : SLUICE_FORMAT_R8G8B8A8_UNORM;
    picture->info.structSize = sizeof picture->info;
    picture->gray = hanging->texture.channelCount == 1;
    bool opened =
        find_spaces(files, neural) &&
        open_store(files, list->pool, hanging->stores[0], false, &neural->original) &&
        sluiceGetImageInfo(neural->original, &picture->info) == SLUICE_SUCCESS &&
        exposure_measure(neural->original, &picture->info, &picture->exposure) == SLUICE_SUCCESS;
    if (opened && (mode == NEURAL_RAW || mode == NEURAL_BC7))
        opened = open_store(files, list->pool, hanging->stores[mode == NEURAL_BC7], true,
                            &picture->color);
    else if (opened && mode == NEURAL_LOAD)
        opened = open_neural_source(files, texture, &picture->color);
    if (opened &&
        (picture->info.width != files->info.width || picture->info.height != files->info.height)) {
        text_say("%s: has %u x %u texels; the set has %u x %u", picture->path, picture->info.width,
                 picture->info.height, files->info.width, files->info.height);
        return false;
    }
    return opened;
}

static bool open_set(const struct settings *settings, struct neural_files *files)
{
    bool decodes = false;
    for (uint32_t i = 0; i < settings->neural_mode_count; i++)
        decodes = decodes || settings->neural_modes[i] >= NEURAL_LOAD;
    if (!open_counted(settings->neural, decodes ? &files->bytes_read : &files->bytes_beside,
                      &files->file))
        return false;
    const SluiceNeuralSetCreateInfo info = {.structSize = sizeof info,
                                            .pPath = settings->neural,
                                            .pInput = &files->file.input,
                                            .log = to_stderr};
    files->info.structSize = sizeof files->info;
    SluiceResult result = sluiceOpenNeuralSet(&info, &files->set);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetNeuralSetInfo(files->set, &files->info);
    if (result == SLUICE_SUCCESS && files->info.hasInt8)
        return true;
    text_say("%s: %s", settings->neural,
             result == SLUICE_SUCCESS ? "has no INT8 weights" : sluiceGetResultName(result));
    return false;
}

static bool hang_all(const struct settings *settings, const struct picture_limits *limits,
                     struct hanging *hangings, struct picture_list *list)
{
    uint32_t indices[SLUICE_NEURAL_MAX_CHANNELS], count = 0;
    for (uint32_t i = 0; i < list->neural->info.textureCount && count < SLUICE_NEURAL_MAX_CHANNELS;
         i++) {
        struct hanging *hanging = &hangings[count];
        hanging->texture.structSize = sizeof hanging->texture;
        if (sluiceGetNeuralTexture(list->neural->set, i, &hanging->texture) != SLUICE_SUCCESS)
            return false;
        if (!is_hangable(settings->neural, &hanging->texture))
            continue;
        indices[count] = i;
        hanging->original = find_original(settings->neural, hanging->texture.pName);
        if (!hanging->original)
            return false;
        count++;
    }
    if (count == 0)
        text_say("%s: has no texture that can hang", settings->neural);
    if (count == 0 || !bake(hangings, count, settings))
        return false;
    list->pictures = calloc((size_t)count * NEURAL_MODE_COUNT, sizeof *list->pictures);
    list->neural->stores =
        calloc((size_t)count * NEURAL_MODE_COUNT * 2, sizeof *list->neural->stores);
    bool hung = list->pictures && list->neural->stores;
    bool takes_blocks = limits->takes_blocks && settings->format != PIXEL_FORMAT_RGBA8;
    uint32_t modes = settings->neural_mode_count, places = count * modes;
    for (uint32_t i = 0; hung && i < places; i++) {
        /* Colors hang where the walk looks: it rests before the last picture, and picture 0 is far
         * away. */
        uint32_t at = modes == 1 ? places - 1 - i : (i + places - 1) % places;
        hung = hang(list, &hangings[at / modes], indices[at / modes],
                    settings->neural_modes[at % modes], takes_blocks);
    }
    return hung;
}

bool neural_files_open(const struct settings *settings, const struct picture_limits *limits,
                       struct picture_list *list)
{
    struct hanging hangings[SLUICE_NEURAL_MAX_CHANNELS] = {0};
    list->neural = calloc(1, sizeof *list->neural);
    bool opened = list->neural && sluiceCreateStoreReadPool(NULL, &list->pool) == SLUICE_SUCCESS;
    if (list->neural)
        list->neural->file.descriptor = -1;
    if (!opened)
        fprintf(stderr, "out of memory\n");
    opened =
        opened && open_set(settings, list->neural) && hang_all(settings, limits, hangings, list);
    for (uint32_t i = 0; i < SLUICE_NEURAL_MAX_CHANNELS; i++) {
        free(hangings[i].original);
        free(hangings[i].stores[0]);
        free(hangings[i].stores[1]);
    }
    return opened;
}

void neural_files_close(struct neural_files *files)
{
    if (!files)
        return;
    sluiceDestroyNeuralSet(files->set);
    for (uint32_t i = 0; i < files->store_count; i++)
        close(files->stores[i].descriptor);
    if (files->file.descriptor >= 0)
        close(files->file.descriptor);
    free(files->stores);
    free(files);
}

#else

#include "../../tools/common/text.h"

bool neural_files_open(const struct settings *settings, const struct picture_limits *limits,
                       struct picture_list *list)
{
    (void)limits, (void)list;
    text_say("%s: this build of Sluice was made without sluice-neural or sluice-bake, which neural "
             "sets need here",
             settings->neural);
    return false;
}

void neural_files_close(struct neural_files *files)
{
    (void)files;
}

#endif /* HAVE_NEURAL && HAVE_BAKE */
