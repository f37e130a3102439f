#define _XOPEN_SOURCE 700

#include "bake/baker.h"
#include "bake/copy.h"
#include "bake/levels.h"
#include "bake/settings.h"
#include "base/alloc.h"
#include "base/log.h"
#include "base/part_file.h"
#include "base/same_file.h"
#include "base/struct_size.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* What zstd and the store's writer take per thread. */
#define MEMORY_PER_THREAD ((uint64_t)3 << 20)

/* One call of sluiceBakeFile. */
struct bake {
    SluiceBaker *baker;
    const SluiceBakeInfo *info;
    SluiceBakeSettings settings; ///< of `info`
    SluiceBakeReport report;
    uint64_t source_size, settings_hash;
    int64_t source_time;
    struct slc_picture *picture;
    struct slc_plan plan;
    SluiceStoreCreateInfo store;
    SluiceStoreWriter *writer;
};

static bool is_file(const struct bake *bake)
{
    return bake->info->pInputPath && !bake->info->pInput && bake->info->firstLevel == 0;
}

static SluiceResult look_at_input(struct bake *bake)
{
    struct stat status;
    const char *path = bake->info->pInputPath;
    if (!path || bake->info->pInput)
        return SLUICE_SUCCESS;
    if (stat(path, &status) != 0) {
        slc_log(&bake->baker->log, SLUICE_LOG_ERROR, "%s: %s", path, strerror(errno));
        return errno == ENOENT || errno == ENOTDIR ? SLUICE_ERROR_FILE_NOT_FOUND : SLUICE_ERROR_IO;
    }
    if (bake->info->pOutputPath && slc_output_replaces_input(bake->info->pOutputPath, path))
        return slc_log_refusal(&bake->baker->log, "%s: the store would take its place", path);
    bake->source_size = (uint64_t)status.st_size;
    bake->source_time =
        (int64_t)status.st_mtim.tv_sec * INT64_C(1000000000) + status.st_mtim.tv_nsec;
    return SLUICE_SUCCESS;
}

static void report_image(struct bake *bake, const SluiceStoreLayout *layout, uint32_t layer_count)
{
    bake->report.width = layout->width;
    bake->report.height = layout->height;
    bake->report.mipLevelCount = layout->mipLevelCount;
    bake->report.format = layout->format;
    bake->report.arrayLayerCount = layer_count;
}

/* Whether a store is there that was made from the same input in the same way. */
static bool is_up_to_date(struct bake *bake)
{
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info,
                                             .pPath = bake->info->pOutputPath,
                                             .pAllocator = &bake->baker->allocator};
    SluiceImageSource *source;
    SluiceStoreInfo store = {.structSize = sizeof store};
    if (!is_file(bake) || bake->info->force ||
        sluiceCreateStoreImageSource(&info, &source) != SLUICE_SUCCESS)
        return false;
    bool is_same = sluiceGetStoreInfo(source, &store) == SLUICE_SUCCESS &&
                   store.sourceSize == bake->source_size &&
                   store.sourceModifiedTimeNs == bake->source_time &&
                   store.settingsHash == bake->settings_hash;
    if (is_same) {
        report_image(bake, &store.layout, store.arrayLayerCount);
        bake->report.skipped = true;
        bake->report.outputSize = store.fileSize;
    }
    sluiceDestroyImageSource(source);
    return is_same;
}

static SluiceResult open_picture(struct bake *bake)
{
    const SluiceBakeInfo *info = bake->info;
    const SluiceAllocationCallbacks *cb = &bake->baker->allocator;
    struct slc_picture_opening opening = {
        .max_memory = bake->baker->max_memory,
        .keep_primaries = bake->settings.keepPrimaries || bake->settings.normalMap,
        .input = info->pInput,
        .first_level = info->firstLevel,
    };
    if (info->pInputPath || info->pInput)
        return slc_picture_open(info->pInputPath ? info->pInputPath : "(memory)", &opening, cb,
                                &bake->baker->log, &bake->picture);
    const char *name = info->pOutputPath ? info->pOutputPath : "(source)";
    if (info->firstLevel > 0) {
        slc_log(&bake->baker->log, SLUICE_LOG_ERROR,
                "%s: firstLevel is %u; sources are baked with all levels", name, info->firstLevel);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    return slc_picture_of_source(info->source, false, name, cb, &bake->baker->log, &bake->picture);
}

static SluiceStoreAddressMode address_mode(SluiceBakeWrap wrap)
{
    return wrap == SLUICE_BAKE_WRAP_CLAMP    ? SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_EDGE
           : wrap == SLUICE_BAKE_WRAP_REPEAT ? SLUICE_STORE_ADDRESS_MODE_REPEAT
                                             : SLUICE_STORE_ADDRESS_MODE_MIRRORED_REPEAT;
}

/* The name without its folders: stores are moved together with what they were made from. */
static const char *base_name(const char *path)
{
    const char *slash = path ? strrchr(path, '/') : NULL;
    return slash ? slash + 1 : path;
}

static void describe_store(struct bake *bake, const SluiceImageInfo *image)
{
    const SluiceBakeSettings *settings = &bake->settings;
    bake->store = (SluiceStoreCreateInfo){
        .structSize = sizeof(SluiceStoreCreateInfo),
        .pPath = bake->info->pOutputPath,
        .width = image->width,
        .height = image->height,
        .arrayLayerCount = image->arrayLayerCount ? image->arrayLayerCount : 1,
        .format = image->format,
        .colorSpace = bake->plan.color_space,
        .meaning = bake->plan.meaning,
        .addressModeU = address_mode(settings->wrapX),
        .addressModeV = address_mode(settings->wrapY),
        .pSourceName = base_name(bake->info->pInputPath),
        .sourceSize = bake->source_size,
        .sourceModifiedTimeNs = bake->source_time,
        .settingsHash = bake->settings_hash,
        .compressionLevel = settings->uncompressed       ? 0
                            : settings->compressionLevel ? settings->compressionLevel
                                                         : SLUICE_BAKE_DEFAULT_COMPRESSION,
        .flags = is_file(bake) ? SLUICE_STORE_WRITER_RESUME : 0,
        .pAllocator = &bake->baker->allocator,
        .log = bake->baker->log,
        .cube = image->cube,
    };
}

/* By the channels alone: nobody says more. */
static SluiceStoreMeaning meaning_of_blocks(SluiceFormat format, bool normals)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    (void)sluiceGetFormatInfo(format, &info);
    if (normals)
        return SLUICE_STORE_MEANING_NORMAL;
    return info.channelCount < 3    ? SLUICE_STORE_MEANING_DATA
           : info.channelCount == 3 ? SLUICE_STORE_MEANING_COLOR
                                    : SLUICE_STORE_MEANING_COLOR_ALPHA;
}

/* Many files of blocks do not know whether they hold sRGB; the settings may say so. */
static SluiceResult describe_blocks(struct bake *bake)
{
    const SluiceBakeSettings *settings = &bake->settings;
    SluiceImageInfo image = {.structSize = sizeof image};
    SluiceResult result = sluiceGetImageInfo(bake->picture->blocks, &image);
    if (result != SLUICE_SUCCESS)
        return result;
    if (settings->transfer != SLUICE_BAKE_TRANSFER_AUTO)
        image.format =
            slc_format_twin(image.format, settings->transfer == SLUICE_BAKE_TRANSFER_SRGB);
    bake->plan.meaning = meaning_of_blocks(image.format, settings->normalMap);
    if (slc_format_is_srgb(image.format))
        bake->plan.color_space = SLUICE_STORE_COLOR_SPACE_SRGB;
    describe_store(bake, &image);
    return SLUICE_SUCCESS;
}

static SluiceResult describe_picture(struct bake *bake)
{
    struct slc_picture *picture = bake->picture;
    SluiceImageInfo image = {
        .structSize = sizeof image, .width = picture->width, .height = picture->height};
    if (picture->blocks)
        return describe_blocks(bake);
    SluiceResult result =
        slc_plan_make(picture, &bake->settings, bake->baker->decoded16, &bake->plan);
    image.format = bake->plan.format;
    if (result == SLUICE_SUCCESS)
        describe_store(bake, &image);
    return result;
}

static SluiceResult filter_levels(struct bake *bake, const SluiceStoreLayout *layout)
{
    struct slc_baking baking = {.allocator = bake->baker->allocator,
                                .picture = bake->picture,
                                .astc = &bake->baker->astc,
                                .plan = bake->plan,
                                .user = bake->info->pUserData,
                                .progress = bake->info->pfnProgress};
    SluiceResult result = slc_baking_init(&baking, &bake->baker->jobs, layout);
    if (result == SLUICE_SUCCESS)
        result = slc_baking_run(&baking, bake->writer);
    bake->report.replacedTexelCount = baking.replaced.texels;
    bake->report.nanTexelCount = baking.replaced.nan;
    bake->report.infiniteTexelCount = baking.replaced.infinite;
    bake->report.clampedTexelCount = baking.replaced.clamped;
    slc_baking_finish(&baking);
    bake->report.resumedTileCount = baking.tiler.found_tile_count;
    return result;
}

static SluiceResult copy_levels(struct bake *bake, const SluiceStoreLayout *layout)
{
    struct slc_copy copy = {.allocator = bake->baker->allocator,
                            .jobs = &bake->baker->jobs,
                            .source = bake->picture->blocks,
                            .writer = bake->writer,
                            .layout = *layout,
                            .layer_count = bake->store.arrayLayerCount,
                            .user = bake->info->pUserData,
                            .progress = bake->info->pfnProgress};
    SluiceResult result = slc_copy_run(&copy);
    bake->report.resumedTileCount = copy.found_tile_count;
    return result;
}

/* Removes the half file of a broken picture, unless another writer has it by now. */
static void remove_part_file(struct bake *bake)
{
    static const SluiceLogCallback silent;
    struct slc_part_file part;
    if (slc_part_file_open(&part, bake->store.pPath, SLC_PART_FILE_RESUME, &bake->baker->allocator,
                           &silent) == SLUICE_SUCCESS)
        slc_part_file_remove(&part);
    slc_part_file_close(&part);
}

static SluiceResult write_store(struct bake *bake, const SluiceStoreLayout *layout)
{
    SluiceResult result = sluiceCreateStoreWriter(&bake->store, &bake->writer);
    if (result == SLUICE_SUCCESS)
        result = bake->picture->blocks ? copy_levels(bake, layout) : filter_levels(bake, layout);
    if (result == SLUICE_SUCCESS)
        result = sluiceFinishStore(bake->writer);
    sluiceDestroyStoreWriter(bake->writer);
    if (bake->writer && result != SLUICE_SUCCESS && result != SLUICE_ERROR_CANCELED)
        remove_part_file(bake);
    return result;
}

static SluiceResult bake_with_memory(struct bake *bake, const SluiceStoreLayout *layout)
{
    SluiceBaker *baker = bake->baker;
    uint64_t size = bake->picture->memory + MEMORY_PER_THREAD * (baker->jobs.thread_count + 1);
    size += bake->picture->blocks ? slc_copy_memory(layout, baker->jobs.thread_count)
                                  : slc_baking_memory(bake->picture, &bake->plan, layout);
    bake->report.memorySize = size;
    bool is_whole = bake->picture->unpacked_size > 0;
    SluiceResult result = slc_baker_reserve(baker, size, bake->info);
    if (result == SLUICE_ERROR_LIMIT_EXCEEDED)
        slc_log(&baker->log, SLUICE_LOG_ERROR,
                "%s: baking it takes %llu KiB of memory%s; maxMemory is %llu KiB; raise it%s",
                bake->picture->name, (unsigned long long)(size >> 10),
                is_whole ? ", because its file is unpacked as a whole" : "",
                (unsigned long long)(baker->max_memory >> 10),
                is_whole ? ", or write the picture as a plain PNG or TIFF file" : "");
    if (result != SLUICE_SUCCESS)
        return result;
    result = write_store(bake, layout);
    slc_baker_give_back(baker, size);
    return result;
}

static SluiceResult bake_picture(struct bake *bake)
{
    struct stat status;
    SluiceStoreLayout layout;
    SluiceResult result = describe_picture(bake);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetStoreLayout(bake->store.width, bake->store.height, bake->store.format,
                                      &layout);
    if (result != SLUICE_SUCCESS)
        return result;
    report_image(bake, &layout, bake->store.arrayLayerCount);
    result = bake_with_memory(bake, &layout);
    if (result == SLUICE_SUCCESS && stat(bake->info->pOutputPath, &status) == 0)
        bake->report.outputSize = (uint64_t)status.st_size;
    return result;
}

static SluiceResult bake_file(struct bake *bake)
{
    SluiceResult result = look_at_input(bake);
    if (result != SLUICE_SUCCESS)
        return result;
    /* A preview is no store of the picture. */
    bake->settings_hash =
        slc_hash_settings(&bake->settings) ^ bake->info->firstLevel * UINT64_C(0x9E3779B97F4A7C15);
    bake->report.inputSize = bake->source_size;
    if (is_up_to_date(bake))
        return SLUICE_SUCCESS;
    result = open_picture(bake);
    if (result == SLUICE_SUCCESS)
        result = bake_picture(bake);
    slc_picture_close(bake->picture);
    return result;
}

/* Checks the arguments that sluiceBakeFile and sluiceDescribeBake share. */
static SluiceResult read_arguments(struct bake *bake, SluiceBakeInfo *info,
                                   const SluiceBakeInfo *given, const SluiceBakeReport *report)
{
    const SluiceLogCallback *log = &bake->baker->log;
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceBakeInfo), info, given, log);
    if (result == SLUICE_SUCCESS && info->pSettings)
        result =
            slc_struct_read(SLC_STRUCT(SluiceBakeSettings), &bake->settings, info->pSettings, log);
    if (result == SLUICE_SUCCESS && report)
        result = slc_struct_check(SLC_STRUCT(SluiceBakeReport), report, log);
    if (result == SLUICE_SUCCESS)
        result = slc_check_settings(&bake->settings, log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!info->pInputPath && !info->pInput && !info->source)
        return SLUICE_ERROR_NULL_POINTER;
    return SLUICE_SUCCESS;
}

static const SluiceBakeSettings default_settings = {.structSize = sizeof default_settings};

SluiceResult sluiceBakeFile(SluiceBaker *baker, const SluiceBakeInfo *pInfo,
                            SluiceBakeReport *pReport)
{
    if (!baker || !pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceBakeInfo info = {.structSize = sizeof info};
    struct bake bake = {.baker = baker, .info = &info, .settings = default_settings};
    SluiceResult result = read_arguments(&bake, &info, pInfo, pReport);
    if (result == SLUICE_SUCCESS && !info.pOutputPath)
        result = SLUICE_ERROR_NULL_POINTER;
    if (result != SLUICE_SUCCESS)
        return result;
    result = bake_file(&bake);
    if (pReport)
        slc_struct_write(SLC_STRUCT(SluiceBakeReport), pReport, &bake.report);
    return result;
}

SluiceResult sluiceDescribeBake(SluiceBaker *baker, const SluiceBakeInfo *pInfo,
                                SluiceBakeReport *pReport)
{
    if (!baker || !pInfo || !pReport)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceBakeInfo info = {.structSize = sizeof info};
    struct bake bake = {.baker = baker, .info = &info, .settings = default_settings};
    SluiceStoreLayout layout;
    SluiceResult result = read_arguments(&bake, &info, pInfo, pReport);
    if (result == SLUICE_SUCCESS)
        result = look_at_input(&bake);
    if (result == SLUICE_SUCCESS)
        result = open_picture(&bake);
    if (result == SLUICE_SUCCESS)
        result = describe_picture(&bake);
    if (result == SLUICE_SUCCESS)
        result =
            sluiceGetStoreLayout(bake.store.width, bake.store.height, bake.store.format, &layout);
    if (result == SLUICE_SUCCESS) {
        bake.report.inputSize = bake.source_size;
        report_image(&bake, &layout, bake.store.arrayLayerCount);
        slc_struct_write(SLC_STRUCT(SluiceBakeReport), pReport, &bake.report);
    }
    slc_picture_close(bake.picture);
    return result;
}
