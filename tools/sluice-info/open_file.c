#include "open_file.h"

#include "file_report.h"

#include "../common/input.h"
#include "../common/text.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#ifdef HAVE_STORE
#include <sluice/store.h>
#endif
#ifdef HAVE_EXR
#include <sluice/exr.h>
#endif
#ifdef HAVE_CONTAINER
#include <sluice/dds.h>
#include <sluice/ktx2.h>
#endif

/* Prints a message of the library, which names the file. */
static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct texture_file *file = user;
    if (severity == SLUICE_LOG_INFO)
        return;
    text_say("sluice-info: %s", message);
    file->has_spoken = true;
}

static bool read_remote_start(struct texture_file *file, const char *url, SluiceLogCallback log,
                              char bytes[12])
{
    if (!remote_open(&file->remote, &file->session, url, &log))
        return false;
    const SluiceInput *input = &file->remote.input;
    SluiceResult result = SLUICE_SUCCESS;
    if (input->size >= 12)
        result = input->pfnRead(input->pUserData, 0, bytes, 12);
    return result == SLUICE_SUCCESS;
}

static bool read_start(const char *path, char bytes[12])
{
    FILE *file = input_open(path);
    memset(bytes, 0, 12);
    if (file)
        (void)!fread(bytes, 1, 12, file);
    bool failed = !file || ferror(file);
    if (failed)
        text_say("sluice-info: %s: %s", path, input_reason(errno));
    if (file)
        fclose(file);
    return !failed;
}

static SluiceResult open_store(struct texture_file *file, const char *path, SluiceLogCallback log)
{
#ifdef HAVE_STORE
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info,
                                             .pPath = path,
                                             .log = log,
                                             .pInput = remote_input(&file->remote)};
    file->kind = "tile store";
    file->is_store = true;
    return sluiceCreateStoreImageSource(&info, &file->source);
#else
    (void)file, (void)path, (void)log;
    return SLUICE_ERROR_UNSUPPORTED;
#endif
}

static SluiceResult open_exr(struct texture_file *file, const char *path,
                             const struct texture_opening *opening, SluiceLogCallback log)
{
#ifdef HAVE_EXR
    SluiceExrImageSourceCreateInfo info = {.structSize = sizeof info,
                                           .pPath = path,
                                           .log = log,
                                           .pInput = remote_input(&file->remote),
                                           .maxImageSize = UINT64_MAX,
                                           .levelZeroAlone = opening->level_zero_alone,
                                           .maxMemorySize = opening->memory};
    file->kind = "OpenEXR";
    SluiceResult result = sluiceCreateExrImageSource(&info, &file->source);
    if (result == SLUICE_ERROR_LIMIT_EXCEEDED)
        text_say("sluice-info: --memory raises the limit");
    return result;
#else
    (void)file, (void)path, (void)opening, (void)log;
    return SLUICE_ERROR_UNSUPPORTED;
#endif
}

static SluiceResult open_container(struct texture_file *file, const char *path, bool is_dds,
                                   const struct texture_opening *opening, SluiceLogCallback log)
{
#ifdef HAVE_CONTAINER
    SluiceDdsImageSourceCreateInfo dds = {
        .structSize = sizeof dds, .pPath = path, .log = log, .pInput = remote_input(&file->remote)};
    SluiceKtx2ImageSourceCreateInfo ktx2 = {.structSize = sizeof ktx2,
                                            .pPath = path,
                                            .log = log,
                                            .pInput = remote_input(&file->remote),
                                            .maxCacheSize = opening->memory};
    file->kind = is_dds ? "DDS" : "KTX2";
    return is_dds ? sluiceCreateDdsImageSource(&dds, &file->source)
                  : sluiceCreateKtx2ImageSource(&ktx2, &file->source);
#else
    (void)file, (void)path, (void)is_dds, (void)opening, (void)log;
    return SLUICE_ERROR_UNSUPPORTED;
#endif
}

enum start { START_UNKNOWN, START_EXR, START_DDS, START_KTX2, START_STORE };

static enum start start_of(const char bytes[12])
{
    return memcmp(bytes, "\x76\x2F\x31\x01", 4) == 0            ? START_EXR
           : memcmp(bytes, "DDS ", 4) == 0                      ? START_DDS
           : memcmp(bytes, "\xABKTX 20\xBB\r\n\x1A\n", 12) == 0 ? START_KTX2
           : memcmp(bytes, "\x89SLS\r\n\x1A\n", 8) == 0         ? START_STORE
                                                                : START_UNKNOWN;
}

bool is_texture_file(const char *path)
{
    char start[12] = {0};
    FILE *file = remote_is_url(path) ? NULL : input_open(path);
    if (!file)
        return false;
    (void)!fread(start, 1, sizeof start, file);
    fclose(file);
    return start_of(start) != START_UNKNOWN;
}

bool open_texture_file(struct texture_file *file, const char *path,
                       const struct texture_opening *opening)
{
    char start[12] = {0};
    SluiceLogCallback log = {file, on_log};
    SluiceResult result;
    *file = (struct texture_file){0};
    if (remote_is_url(path) ? !read_remote_start(file, path, log, start)
                            : !read_start(path, start)) {
        close_texture_file(file);
        return false;
    }
    switch (start_of(start)) {
    case START_EXR: result = open_exr(file, path, opening, log); break;
    case START_DDS: result = open_container(file, path, true, opening, log); break;
    case START_KTX2: result = open_container(file, path, false, opening, log); break;
    case START_STORE: result = open_store(file, path, log); break;
    default:
        text_say(
            "sluice-info: %s: is not a tile store, OpenEXR, DDS, KTX2 or .ntc file; sluice-bake "
            "makes tile stores of other pictures",
            path);
        close_texture_file(file);
        return false;
    }
    file->image.structSize = sizeof file->image;
    if (result == SLUICE_SUCCESS)
        result = sluiceGetImageInfo(file->source, &file->image);
    if (result == SLUICE_SUCCESS)
        return true;
    if (!file->has_spoken)
        text_say("sluice-info: %s: %s", path, sluiceGetResultName(result));
    close_texture_file(file);
    return false;
}

void close_texture_file(struct texture_file *file)
{
    sluiceDestroyImageSource(file->source);
    file->source = NULL;
    remote_close(&file->remote);
    remote_end(&file->session);
}
