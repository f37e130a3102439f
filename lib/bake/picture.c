#include "bake/picture.h"

#include "base/log.h"
#include "base/system.h"
#include "image/file_signature.h"
#include "image/input_file.h"

#include <errno.h>
#include <string.h>

#ifdef SLC_HAVE_EXR
#include <sluice/exr.h>
#endif
#ifdef SLC_HAVE_CONTAINER
#include <sluice/dds.h>
#include <sluice/ktx2.h>
#endif

/* Reads the first bytes, or the whole file if it is shorter. Refuses pipes and devices: libvips
 * would wait. */
static SluiceResult read_start(const struct slc_input_choice *choice,
                               const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                               char *bytes, size_t size)
{
    struct slc_input_file file;
    SluiceResult result = slc_input_file_init_choice(&file, choice, cb, log);
    if (result == SLUICE_SUCCESS)
        result = slc_input_file_open(&file);
    if (result == SLUICE_SUCCESS && slc_input_file_read_some(&file, 0, bytes, size) < 0)
        result =
            slc_input_fail(&file, slc_system_result(errno), "cannot read: %s", strerror(errno));
    slc_input_file_finish(&file);
    return result;
}

static SluiceResult look_inside(const struct slc_input_choice *choice,
                                const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                                enum slc_file_signature *kind)
{
    char bytes[SLC_SIGNATURE_SIZE] = {0};
    SluiceResult result = read_start(choice, cb, log, bytes, sizeof bytes);
    *kind = slc_file_signature(bytes);
    return result;
}

/* Opens only level 0, read in strips, whatever its size. */
static SluiceResult open_exr(const char *path, const struct slc_picture_opening *opening,
                             const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                             SluiceImageSource **source)
{
#ifdef SLC_HAVE_EXR
    SluiceExrImageSourceCreateInfo info = {.structSize = sizeof info,
                                           .pPath = path,
                                           .pAllocator = cb,
                                           .log = *log,
                                           .maxImageSize = UINT64_MAX,
                                           .levelZeroAlone = true,
                                           .maxMemorySize = opening->max_memory,
                                           .keepPrimaries = opening->keep_primaries,
                                           .pInput = opening->input};
    return sluiceCreateExrImageSource(&info, source);
#else
    (void)cb, (void)source, (void)opening;
    slc_log(log, SLUICE_LOG_ERROR, "%s: this build reads no OpenEXR files", path);
    return SLUICE_ERROR_UNSUPPORTED;
#endif
}

static void describe_exr(SluiceImageSource *source, struct slc_picture *picture)
{
#ifdef SLC_HAVE_EXR
    SluiceExrInfo info = {.structSize = sizeof info};
    if (sluiceGetExrInfo(source, &info) != SLUICE_SUCCESS)
        return;
    picture->memory += info.readSize;
    picture->foreign_primaries = info.foreignPrimaries;
#else
    (void)source, (void)picture;
#endif
}

static SluiceResult open_container(const char *path, const SluiceInput *input,
                                   enum slc_file_signature kind,
                                   const SluiceAllocationCallbacks *cb,
                                   const SluiceLogCallback *log, SluiceImageSource **source)
{
#ifdef SLC_HAVE_CONTAINER
    if (kind == SLC_SIGNATURE_DDS) {
        SluiceDdsImageSourceCreateInfo info = {.structSize = sizeof info,
                                               .pPath = path,
                                               .pInput = input,
                                               .pAllocator = cb,
                                               .log = *log};
        return sluiceCreateDdsImageSource(&info, source);
    }
    SluiceKtx2ImageSourceCreateInfo info = {
        .structSize = sizeof info, .pPath = path, .pInput = input, .pAllocator = cb, .log = *log};
    return sluiceCreateKtx2ImageSource(&info, source);
#else
    (void)cb, (void)source, (void)input;
    slc_log(log, SLUICE_LOG_ERROR, "%s: this build reads no %s files", path,
            kind == SLC_SIGNATURE_DDS ? "DDS" : "KTX2");
    return SLUICE_ERROR_UNSUPPORTED;
#endif
}

SluiceResult slc_picture_open(const char *path, const struct slc_picture_opening *opening,
                              const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log,
                              struct slc_picture **picture)
{
    SluiceImageSource *source = NULL;
    enum slc_file_signature kind = SLC_SIGNATURE_OTHER;
    struct slc_input_choice choice = {.path = path, .input = opening->input};
    SluiceResult result = look_inside(&choice, cb, log, &kind);
    if (result != SLUICE_SUCCESS)
        return result;
    if (kind == SLC_SIGNATURE_NEURAL) {
        slc_log(log, SLUICE_LOG_ERROR,
                "%s: is a neural set, which is not baked; open it with sluice-open", path);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    if (kind == SLC_SIGNATURE_OTHER || kind == SLC_SIGNATURE_STORE ||
        kind == SLC_SIGNATURE_CATALOGUE) /* libvips refuses the last two */
        return slc_picture_open_vips(path, opening, cb, log, picture);
    if (opening->first_level > 0) {
        slc_log(log, SLUICE_LOG_ERROR,
                "%s: firstLevel is %u; OpenEXR, DDS and KTX2 files are baked with all levels", path,
                opening->first_level);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    if (kind == SLC_SIGNATURE_EXR)
        result = open_exr(path, opening, cb, log, &source);
    else
        result = open_container(path, opening->input, kind, cb, log, &source);
    if (result == SLUICE_SUCCESS)
        result = slc_picture_of_source(source, true, path, cb, log, picture);
    if (result == SLUICE_SUCCESS && kind == SLC_SIGNATURE_EXR)
        describe_exr(source, *picture);
    else if (result == SLUICE_SUCCESS)
        (*picture)->premultiplied = false;
    return result;
}

void slc_picture_close(struct slc_picture *picture)
{
    if (picture)
        picture->implementation->close(picture);
}
