#include "bake/picture.h"

#include "base/log.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#ifdef SLC_HAVE_EXR
#include <sluice/exr.h>
#endif
#ifdef SLC_HAVE_CONTAINER
#include <sluice/dds.h>
#include <sluice/ktx2.h>
#endif

enum kind { OTHER, EXR, DDS, KTX2 };

static SluiceResult look_inside(const char *path, const SluiceLogCallback *log, enum kind *kind)
{
    static const char ktx2[] = "\xABKTX 20\xBB\r\n\x1A\n";
    char bytes[12] = {0};
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(bytes, 1, sizeof bytes, file) : 0;
    bool failed = !file || ferror(file);
    int error = errno;
    if (file)
        fclose(file);
    if (failed) {
        slc_log(log, SLUICE_LOG_ERROR, "%s: %s", path, strerror(error));
        return error == ENOENT || error == ENOTDIR ? SLUICE_ERROR_FILE_NOT_FOUND : SLUICE_ERROR_IO;
    }
    *kind = OTHER;
    if (size >= 4 && memcmp(bytes, "\x76\x2F\x31\x01", 4) == 0)
        *kind = EXR;
    else if (size >= 4 && memcmp(bytes, "DDS ", 4) == 0)
        *kind = DDS;
    else if (size == 12 && memcmp(bytes, ktx2, 12) == 0)
        *kind = KTX2;
    return SLUICE_SUCCESS;
}

/* Level 0 alone, in strips, whatever its size. */
static SluiceResult open_exr(const char *path, const SluiceAllocationCallbacks *cb,
                             const SluiceLogCallback *log, SluiceImageSource **source)
{
#ifdef SLC_HAVE_EXR
    SluiceExrImageSourceCreateInfo info = {.pPath = path,
                                           .pAllocator = cb,
                                           .log = *log,
                                           .maxImageSize = UINT64_MAX,
                                           .levelZeroAlone = true};
    return sluiceCreateExrImageSource(&info, source);
#else
    (void)cb, (void)source;
    slc_log(log, SLUICE_LOG_ERROR, "%s: this build reads no OpenEXR files", path);
    return SLUICE_ERROR_UNSUPPORTED;
#endif
}

static SluiceResult open_container(const char *path, enum kind kind,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceLogCallback *log, SluiceImageSource **source)
{
#ifdef SLC_HAVE_CONTAINER
    if (kind == DDS) {
        SluiceDdsImageSourceCreateInfo info = {.pPath = path, .pAllocator = cb, .log = *log};
        return sluiceCreateDdsImageSource(&info, source);
    }
    SluiceKtx2ImageSourceCreateInfo info = {.pPath = path, .pAllocator = cb, .log = *log};
    return sluiceCreateKtx2ImageSource(&info, source);
#else
    (void)cb, (void)source;
    slc_log(log, SLUICE_LOG_ERROR, "%s: this build reads no %s files", path,
            kind == DDS ? "DDS" : "KTX2");
    return SLUICE_ERROR_UNSUPPORTED;
#endif
}

SluiceResult slc_picture_open(const char *path, const SluiceAllocationCallbacks *cb,
                              const SluiceLogCallback *log, struct slc_picture **picture)
{
    SluiceImageSource *source = NULL;
    enum kind kind = OTHER;
    SluiceResult result = look_inside(path, log, &kind);
    if (result != SLUICE_SUCCESS)
        return result;
    if (kind == OTHER)
        return slc_picture_open_vips(path, cb, log, picture);
    if (kind == EXR)
        result = open_exr(path, cb, log, &source);
    else
        result = open_container(path, kind, cb, log, &source);
    if (result == SLUICE_SUCCESS)
        result = slc_picture_of_source(source, true, path, cb, log, picture);
    if (result == SLUICE_SUCCESS && kind != EXR)
        (*picture)->premultiplied = false;
    return result;
}

void slc_picture_close(struct slc_picture *picture)
{
    if (picture)
        picture->implementation->close(picture);
}
