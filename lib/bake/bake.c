#include "bake/baker.h"
#include "bake/copy.h"
#include "bake/inputs.h"
#include "bake/levels.h"
#include "bake/settings.h"
#include "base/alloc.h"
#include "base/log.h"
#include "base/part_file.h"
#include "base/struct_size.h"
#include "image/format_size.h"
#include "image/info.h"
#include "platform/file.h"

#include <string.h>

/* Bytes that zstd and the store's writer take per thread. */
#define MEMORY_PER_THREAD ((uint64_t)3 << 20)
/* Bytes of compressed tiles that wait for their turn: 16 of 128 KiB. */
#define MEMORY_OF_TURNS ((uint64_t)2 << 20)

/* State of one call of sluiceBakeFile. */
struct bake {
    SluiceBaker *baker;
    const SluiceBakeInfo *info;
    SluiceBakeSettings settings; ///< settings of `info`
    SluiceBakeReport report;
    struct slc_bake_inputs inputs;
    uint64_t settings_hash;
    uint32_t index; ///< index of the picture in `inputs`
    struct slc_picture *picture;
    struct slc_plan plan; ///< plan of the picture
    SluiceStoreCreateInfo store;
    SluiceImageInfo image; ///< info of the first picture, as stored
    uint64_t memory;       ///< bytes that suffice for each picture
    SluiceStoreWriter *writer;
    uint64_t next_turn; ///< next turn of the writer
};

static void report_image(struct bake *bake, const SluiceStoreLayout *layout, uint32_t layer_count)
{
    bake->report.width = layout->width;
    bake->report.height = layout->height;
    bake->report.mipLevelCount = layout->mipLevelCount;
    bake->report.format = layout->format;
    bake->report.arrayLayerCount = layer_count;
}

/* True if the store exists and was made from equal input with equal settings. */
static bool is_up_to_date(struct bake *bake)
{
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info,
                                             .pPath = bake->info->pOutputPath,
                                             .pAllocator = &bake->baker->allocator};
    SluiceImageSource *source;
    SluiceStoreInfo store = {.structSize = sizeof store};
    if (!slc_bake_inputs_are_files(&bake->inputs) || bake->info->force ||
        sluiceCreateStoreImageSource(&info, &source) != SLUICE_SUCCESS)
        return false;
    bool is_same = sluiceGetStoreInfo(source, &store) == SLUICE_SUCCESS &&
                   store.sourceSize == bake->inputs.size &&
                   store.sourceModifiedTimeNs == bake->inputs.time &&
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
    const char *path = slc_bake_input_path(&bake->inputs, bake->index);
    if (path || info->pInput)
        return slc_picture_open(path ? path : "(memory)", &opening, cb, &bake->baker->log,
                                &bake->picture);
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

static void describe_store(struct bake *bake)
{
    const SluiceBakeSettings *settings = &bake->settings;
    const SluiceImageInfo *image = &bake->image;
    bake->store = (SluiceStoreCreateInfo){
        .structSize = sizeof(SluiceStoreCreateInfo),
        .pPath = bake->info->pOutputPath,
        .width = image->width,
        .height = image->height,
        .arrayLayerCount = image->arrayLayerCount * bake->inputs.count,
        .format = image->format,
        .colorSpace = bake->plan.color_space,
        .meaning = bake->plan.meaning,
        .addressModeU = address_mode(settings->wrapX),
        .addressModeV = address_mode(settings->wrapY),
        .pSourceName = slc_base_name(slc_bake_input_path(&bake->inputs, 0)),
        .sourceSize = bake->inputs.size,
        .sourceModifiedTimeNs = bake->inputs.time,
        .settingsHash = bake->settings_hash,
        .compressionLevel = settings->uncompressed       ? 0
                            : settings->compressionLevel ? settings->compressionLevel
                                                         : SLUICE_BAKE_DEFAULT_COMPRESSION,
        .flags = slc_bake_inputs_are_files(&bake->inputs) ? SLUICE_STORE_WRITER_RESUME : 0,
        .pAllocator = &bake->baker->allocator,
        .log = bake->baker->log,
        .cube = image->cube || bake->info->cube,
    };
}

/* Guesses the meaning from the channels, because levels of files do not record it. */
static SluiceStoreMeaning meaning_of_levels(SluiceFormat format, bool normals)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    (void)sluiceGetFormatInfo(format, &info);
    if (slc_format_is_integer(format))
        return SLUICE_STORE_MEANING_DATA;
    if (normals)
        return SLUICE_STORE_MEANING_NORMAL;
    return info.channelCount < 3    ? SLUICE_STORE_MEANING_DATA
           : info.channelCount == 3 ? SLUICE_STORE_MEANING_COLOR
                                    : SLUICE_STORE_MEANING_COLOR_ALPHA;
}

/* Refuses other formats for integers, which must be stored exactly. */
static SluiceResult check_integers(const struct bake *bake, const SluiceImageInfo *image)
{
    SluiceFormat format = bake->settings.format;
    if (!slc_format_is_integer(image->format) || format == SLUICE_FORMAT_UNDEFINED ||
        format == image->format)
        return SLUICE_SUCCESS;
    slc_log(&bake->baker->log, SLUICE_LOG_ERROR,
            "%s: format is %s; integers are stored as they are: it must be %s or UNDEFINED",
            bake->picture->name, sluiceGetFormatName(format), sluiceGetFormatName(image->format));
    return SLUICE_ERROR_UNSUPPORTED;
}

/* Describes stored levels. Files of blocks often do not record sRGB; the settings may set it. */
static SluiceResult describe_levels(struct bake *bake, SluiceImageInfo *image)
{
    const SluiceBakeSettings *settings = &bake->settings;
    SluiceResult result = sluiceGetImageInfo(bake->picture->levels, image);
    if (result == SLUICE_SUCCESS)
        result = check_integers(bake, image);
    if (result != SLUICE_SUCCESS)
        return result;
    if (settings->transfer != SLUICE_BAKE_TRANSFER_AUTO)
        image->format =
            slc_format_twin(image->format, settings->transfer == SLUICE_BAKE_TRANSFER_SRGB);
    bake->plan =
        (struct slc_plan){.meaning = meaning_of_levels(image->format, settings->normalMap)};
    if (slc_format_is_srgb(image->format))
        bake->plan.color_space = SLUICE_STORE_COLOR_SPACE_SRGB;
    return SLUICE_SUCCESS;
}

static SluiceResult describe_picture(struct bake *bake, SluiceImageInfo *image)
{
    const struct slc_picture *picture = bake->picture;
    if (picture->levels)
        return describe_levels(bake, image);
    SluiceResult result =
        slc_plan_make(picture, &bake->settings, bake->baker->decoded16, &bake->plan);
    image->width = picture->width;
    image->height = picture->height;
    image->format = bake->plan.format;
    image->cube = picture->cube;
    return result;
}

/* Merges the meaning of a picture. The more specific one wins: of five opaque faces and one face
 * with alpha, the one with alpha. */
static void merge_meanings(struct bake *bake)
{
    if (bake->store.meaning == SLUICE_STORE_MEANING_COLOR)
        bake->store.meaning = bake->plan.meaning;
    if (bake->store.colorSpace != bake->plan.color_space)
        bake->store.colorSpace = SLUICE_STORE_COLOR_SPACE_UNDEFINED;
}

static SluiceResult check_cube(const struct bake *bake)
{
    const SluiceLogCallback *log = &bake->baker->log;
    uint32_t layers = bake->store.arrayLayerCount;
    if (!bake->store.cube)
        return SLUICE_SUCCESS;
    if (bake->image.width != bake->image.height)
        return slc_log_refusal(log, "%s: is %u x %u texels; faces of cube maps are square",
                               bake->picture->name, bake->image.width, bake->image.height);
    if (layers % SLC_CUBE_FACES)
        return slc_log_refusal(log, "%s: %u layers are no cube maps, which have %u faces each",
                               bake->picture->name, layers, SLC_CUBE_FACES);
    return SLUICE_SUCCESS;
}

/* Checks that the picture's layers match those of the first picture. */
static SluiceResult check_layers(const struct bake *bake, const SluiceImageInfo *image)
{
    const SluiceImageInfo *first = &bake->image;
    if (image->width == first->width && image->height == first->height &&
        image->format == first->format && image->arrayLayerCount == first->arrayLayerCount &&
        image->cube == first->cube)
        return SLUICE_SUCCESS;
    if (image->cube != first->cube)
        return slc_log_refusal(&bake->baker->log,
                               "%s: is %s, and %s is %s; layers of a store are alike",
                               bake->picture->name, image->cube ? "a cube map" : "no cube map",
                               slc_bake_input_path(&bake->inputs, 0), first->cube ? "one" : "none");
    return slc_log_refusal(&bake->baker->log,
                           "%s: is %u x %u texels, %s, %u layers; %s is %u x %u texels, %s, %u "
                           "layers; layers of a store are alike",
                           bake->picture->name, image->width, image->height,
                           sluiceGetFormatName(image->format), image->arrayLayerCount,
                           slc_bake_input_path(&bake->inputs, 0), first->width, first->height,
                           sluiceGetFormatName(first->format), first->arrayLayerCount);
}

/* Opens the picture `index` and plans how it becomes layers of the store. */
static SluiceResult begin_picture(struct bake *bake, uint32_t index)
{
    SluiceImageInfo image = {.structSize = sizeof image};
    bake->index = index;
    SluiceResult result = open_picture(bake);
    if (result == SLUICE_SUCCESS)
        result = describe_picture(bake, &image);
    if (result != SLUICE_SUCCESS)
        return result;
    image.arrayLayerCount = bake->picture->layer_count;
    if (bake->image.width > 0) /* the first picture was described */
        return check_layers(bake, &image);
    uint64_t layers = (uint64_t)image.arrayLayerCount * bake->inputs.count;
    if (layers > SLUICE_STORE_MAX_ARRAY_LAYERS)
        return slc_log_refusal(&bake->baker->log, "%s: %llu layers are baked; at most %u can be",
                               bake->picture->name, (unsigned long long)layers,
                               SLUICE_STORE_MAX_ARRAY_LAYERS);
    bake->image = image;
    describe_store(bake);
    return check_cube(bake);
}

static void end_picture(struct bake *bake)
{
    slc_picture_close(bake->picture);
    bake->picture = NULL;
}

static SluiceResult filter_levels(struct bake *bake, const SluiceStoreLayout *layout,
                                  uint32_t layer)
{
    struct slc_baking baking = {.allocator = bake->baker->allocator,
                                .picture = bake->picture,
                                .astc = &bake->baker->astc,
                                .plan = bake->plan,
                                .layer = layer,
                                .next_turn = &bake->next_turn,
                                .layer_count = bake->store.arrayLayerCount,
                                .user = bake->info->pUserData,
                                .progress = bake->info->pfnProgress};
    SluiceResult result = slc_baking_init(&baking, &bake->baker->jobs, layout);
    if (result == SLUICE_SUCCESS)
        result = slc_baking_run(&baking, bake->writer);
    bake->report.replacedTexelCount += baking.replaced.texels;
    bake->report.nanTexelCount += baking.replaced.nan;
    bake->report.infiniteTexelCount += baking.replaced.infinite;
    bake->report.clampedTexelCount += baking.replaced.clamped;
    slc_baking_finish(&baking);
    bake->report.resumedTileCount += baking.tiler.found_tile_count;
    return result;
}

static SluiceResult copy_levels(struct bake *bake, const SluiceStoreLayout *layout,
                                uint32_t first_layer)
{
    struct slc_copy copy = {.allocator = bake->baker->allocator,
                            .jobs = &bake->baker->jobs,
                            .source = bake->picture->levels,
                            .writer = bake->writer,
                            .next_turn = &bake->next_turn,
                            .layout = *layout,
                            .first_layer = first_layer,
                            .layer_count = bake->image.arrayLayerCount,
                            .all_layer_count = bake->store.arrayLayerCount,
                            .user = bake->info->pUserData,
                            .progress = bake->info->pfnProgress};
    SluiceResult result = slc_copy_run(&copy);
    bake->report.resumedTileCount += copy.found_tile_count;
    return result;
}

/* Writes all layers of the picture. */
static SluiceResult write_layers(struct bake *bake, const SluiceStoreLayout *layout)
{
    struct slc_picture *picture = bake->picture;
    uint32_t first = bake->index * bake->image.arrayLayerCount;
    SluiceResult result = SLUICE_SUCCESS;
    if (picture->levels)
        return copy_levels(bake, layout, first);
    for (uint32_t i = 0; i < picture->layer_count && result == SLUICE_SUCCESS; i++) {
        picture->layer = i;
        if (i > 0)
            result = picture->implementation->rewind(picture);
        if (result == SLUICE_SUCCESS)
            result = filter_levels(bake, layout, first + i);
    }
    return result;
}

static SluiceResult write_pictures(struct bake *bake, const SluiceStoreLayout *layout)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < bake->inputs.count && result == SLUICE_SUCCESS; i++) {
        if (bake->inputs.count > 1) {
            end_picture(bake);
            result = begin_picture(bake, i);
        }
        if (result == SLUICE_SUCCESS)
            result = write_layers(bake, layout);
    }
    return result;
}

/* Removes the unfinished file of a broken picture, unless another writer has it by now. */
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
        result = write_pictures(bake, layout);
    if (result == SLUICE_SUCCESS)
        result = sluiceFinishStore(bake->writer);
    sluiceDestroyStoreWriter(bake->writer);
    bool can_resume = result == SLUICE_ERROR_CANCELED || result == SLUICE_NOT_READY;
    if (bake->writer && result != SLUICE_SUCCESS && !can_resume)
        remove_part_file(bake);
    return result;
}

/* Returns the bytes that baking the picture takes, with all buffers. */
static uint64_t memory_for_picture(const struct bake *bake, const SluiceStoreLayout *layout)
{
    const struct slc_bake_jobs *jobs = &bake->baker->jobs;
    uint64_t size = bake->picture->memory + MEMORY_PER_THREAD * (jobs->thread_count + 1);
    size += jobs->thread_count ? MEMORY_OF_TURNS : 0;
    return size + (bake->picture->levels ? slc_copy_memory(layout, jobs->thread_count)
                                         : slc_baking_memory(bake->picture, &bake->plan, layout));
}

/* Opens and checks all pictures in turn, before anything is written. A single picture stays open.
 */
static SluiceResult look_at_pictures(struct bake *bake, SluiceStoreLayout *layout)
{
    uint64_t memory = 0;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < bake->inputs.count && result == SLUICE_SUCCESS; i++) {
        end_picture(bake);
        result = begin_picture(bake, i);
        if (result == SLUICE_SUCCESS && i == 0)
            result = sluiceGetStoreLayout(bake->store.width, bake->store.height, bake->store.format,
                                          layout);
        if (result != SLUICE_SUCCESS)
            return result;
        merge_meanings(bake);
        memory = memory_for_picture(bake, layout);
        bake->memory = memory > bake->memory ? memory : bake->memory;
    }
    bake->report.inputSize = bake->inputs.size;
    report_image(bake, layout, bake->store.arrayLayerCount);
    return result;
}

static SluiceResult bake_with_memory(struct bake *bake, const SluiceStoreLayout *layout)
{
    SluiceBaker *baker = bake->baker;
    bake->report.memorySize = bake->memory;
    bool is_whole = bake->picture->unpacked_size > 0;
    SluiceResult result = slc_baker_reserve(baker, bake->memory, bake->info);
    if (result == SLUICE_ERROR_LIMIT_EXCEEDED)
        slc_log(&baker->log, SLUICE_LOG_ERROR,
                "%s: baking it takes %llu KiB of memory%s; maxMemory is %llu KiB; raise it%s",
                bake->picture->name, (unsigned long long)(bake->memory >> 10),
                is_whole ? ", because its file is unpacked as a whole" : "",
                (unsigned long long)(baker->max_memory >> 10),
                is_whole ? ", or write the picture as a plain PNG or TIFF file" : "");
    if (result != SLUICE_SUCCESS)
        return result;
    result = write_store(bake, layout);
    slc_baker_give_back(baker, bake->memory);
    return result;
}

static SluiceResult bake_pictures(struct bake *bake)
{
    struct slc_file_status status;
    SluiceStoreLayout layout;
    SluiceResult result = look_at_pictures(bake, &layout);
    if (result == SLUICE_SUCCESS)
        result = bake_with_memory(bake, &layout);
    if (result == SLUICE_SUCCESS && slc_path_get_status(bake->info->pOutputPath, &status))
        bake->report.outputSize = status.size;
    end_picture(bake);
    return result;
}

static SluiceResult bake_file(struct bake *bake)
{
    SluiceResult result = slc_bake_inputs_init(&bake->inputs, bake->info, &bake->baker->log);
    if (result != SLUICE_SUCCESS)
        return result;
    /* A preview must not count as a store of the picture. */
    bake->settings_hash = slc_hash_settings(&bake->settings) ^ bake->inputs.hash ^
                          bake->info->firstLevel * UINT64_C(0x9E3779B97F4A7C15);
    bake->report.inputSize = bake->inputs.size;
    return is_up_to_date(bake) ? SLUICE_SUCCESS : bake_pictures(bake);
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
    return result;
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
        result = slc_bake_inputs_init(&bake.inputs, &info, &baker->log);
    if (result == SLUICE_SUCCESS)
        result = look_at_pictures(&bake, &layout);
    if (result == SLUICE_SUCCESS)
        slc_struct_write(SLC_STRUCT(SluiceBakeReport), pReport, &bake.report);
    end_picture(&bake);
    return result;
}
