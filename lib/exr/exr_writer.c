#include <sluice/exr.h>

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/part_file.h"
#include "base/struct_size.h"
#include "image/convert.h"
#include "image/format_size.h"
#include "image/half.h"
#include "platform/thread.h"

#include <openexr.h>
#include <string.h>

/* Position of a tile. Tiles are made and written level by level, row by row. */
struct tile {
    uint64_t index;
    SluiceImageRegion region;
    uint32_t x, y; ///< column and row among the tiles of its level
};

struct writer {
    SluiceExrWriteInfo info;
    SluiceAllocationCallbacks allocator;
    SluiceImageSource *source;
    SluiceImageInfo image;
    uint32_t channel_count;
    uint64_t tile_count, texel_count;
    struct slc_part_file file;
    bool write_failed; ///< And was logged.
    exr_context_t context;

    struct slc_mutex mutex;    ///< guards the fields below and every write
    struct slc_condition turn; ///< a tile was written, or writing failed
    struct tile next;          ///< next tile to make
    uint64_t written_count, written_texels;
    SluiceResult result; ///< the first failure
};

/* Buffers of one thread for one tile. */
struct tile_buffers {
    char *texels; ///< in the source's format
    char *packed; ///< file layout: in each row channel by channel, A, B, G, R
    size_t texels_size, packed_size;
};

static SluiceResult fail(const struct writer *writer, SluiceResult result, const char *what)
{
    slc_log(&writer->info.log, SLUICE_LOG_ERROR, "%s: %s", writer->info.pPath, what);
    return result;
}

static SluiceResult library_result(const struct writer *writer, exr_result_t result)
{
    if (result == EXR_ERR_SUCCESS)
        return SLUICE_SUCCESS;
    if (result == EXR_ERR_OUT_OF_MEMORY)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (writer->write_failed) /* already logged */
        return SLUICE_ERROR_IO;
    return fail(writer, SLUICE_ERROR_INVALID_ARGUMENT, exr_get_default_error_message(result));
}

static int64_t on_write(exr_const_context_t context, void *user, const void *buffer, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t error)
{
    (void)context;
    (void)error;
    struct writer *writer = user;
    if (slc_part_file_write(&writer->file, offset, buffer, size) == SLUICE_SUCCESS)
        return (int64_t)size;
    writer->write_failed = true;
    return -1;
}

/* Ignores messages: results suffice, and the context may be locked here. */
static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

/* Returns the channel names in alphabetical order, which is the order in the file. */
static const char *const *channel_names(uint32_t count)
{
    static const char *const names[5][5] = {
        {NULL}, {"Y"}, {"G", "R"}, {"B", "G", "R"}, {"A", "B", "G", "R"}};
    return names[count];
}

/* Returns the RGBA component of a channel of the file. */
static uint32_t channel_component(uint32_t channel_count, uint32_t channel)
{
    return channel_count - 1 - channel;
}

static exr_result_t define_image(struct writer *writer)
{
    exr_context_t context = writer->context;
    int part;
    exr_result_t result = exr_add_part(context, NULL, EXR_STORAGE_TILED, &part);
    if (result == EXR_ERR_SUCCESS)
        result = exr_initialize_required_attr_simple(
            context, part, (int32_t)writer->image.width, (int32_t)writer->image.height,
            writer->info.uncompressed ? EXR_COMPRESSION_NONE : EXR_COMPRESSION_ZIP);
    if (result == EXR_ERR_SUCCESS)
        result =
            exr_set_tile_descriptor(context, part, writer->info.tileWidth, writer->info.tileHeight,
                                    EXR_TILE_MIPMAP_LEVELS, EXR_TILE_ROUND_DOWN);
    const char *const *names = channel_names(writer->channel_count);
    for (uint32_t i = 0; i < writer->channel_count && result == EXR_ERR_SUCCESS; i++)
        result = exr_add_channel(context, part, names[i], EXR_PIXEL_HALF,
                                 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    return result == EXR_ERR_SUCCESS ? exr_write_header(context) : result;
}

static exr_result_t start_context(struct writer *writer)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = on_error;
    init.user_data = writer;
    init.write_fn = on_write;
    init.zip_level = 4; /* twice as fast as 6; files grow by a few percent */
    exr_result_t result =
        exr_start_write(&writer->context, writer->info.pPath, EXR_WRITE_FILE_DIRECTLY, &init);
    if (result != EXR_ERR_SUCCESS) {
        writer->context = NULL;
        return result;
    }
    return define_image(writer);
}

/* Converts texels to halves. Half sources keep their bits, including infinities and NaN. */
static void convert_texels(SluiceFormat format, const char *texels, uint16_t (*halves)[4],
                           uint32_t count)
{
    enum { BATCH = 64 };
    uint32_t texel_size = sluiceGetFormatTexelSize(format);
    if (slc_format_is_half(format)) {
        for (uint32_t i = 0; i < count; i++)
            memcpy(halves[i], texels + (size_t)i * texel_size, texel_size);
        return;
    }
    float rgba[4 * BATCH];
    for (uint32_t done = 0; done < count; done += BATCH) {
        uint32_t step = slc_min_u32(BATCH, count - done);
        slc_texels_to_rgba(format, texels + (size_t)done * texel_size, rgba, step);
        for (uint32_t i = 0; i < 4 * step; i++)
            halves[done + i / 4][i % 4] = slc_half_from_float(rgba[i]);
    }
}

static void pack_tile(const struct writer *writer, const struct tile *tile, const char *texels,
                      char *packed)
{
    enum { BATCH = 64 };
    uint16_t halves[BATCH][4];
    uint32_t width = tile->region.width, channels = writer->channel_count;
    size_t texel_size = sluiceGetFormatTexelSize(writer->image.format);
    for (uint32_t y = 0; y < tile->region.height; y++, packed += (size_t)2 * channels * width)
        for (uint32_t x = 0; x < width; x += BATCH) {
            uint32_t count = slc_min_u32(BATCH, width - x);
            convert_texels(writer->image.format, texels + ((size_t)y * width + x) * texel_size,
                           halves, count);
            for (uint32_t c = 0; c < channels; c++) {
                uint32_t component = channel_component(channels, c);
                unsigned char *out = (unsigned char *)packed + 2 * ((size_t)c * width + x);
                for (uint32_t i = 0; i < count; i++, out += 2) {
                    out[0] = (unsigned char)(halves[i][component] & 0xFF);
                    out[1] = (unsigned char)(halves[i][component] >> 8);
                }
            }
        }
}

static SluiceResult make_tile(struct writer *writer, const struct tile *tile,
                              const struct tile_buffers *buffers)
{
    size_t pitch = (size_t)tile->region.width * sluiceGetFormatTexelSize(writer->image.format);
    SluiceResult result =
        sluiceReadImageRegion(writer->source, &tile->region, buffers->texels, pitch);
    if (result != SLUICE_SUCCESS)
        return result;
    pack_tile(writer, tile, buffers->texels, buffers->packed);
    return SLUICE_SUCCESS;
}

static exr_chunk_info_t describe_chunk(const struct writer *writer, const struct tile *tile)
{
    /* Filled by hand: up to 3.1, exr_write_tile_chunk_info returns the full tile size for the last
     * tiles of NPOT levels > 0. */
    return (exr_chunk_info_t){
        .idx = (int32_t)tile->index,
        .start_x = (int32_t)tile->x,
        .start_y = (int32_t)tile->y,
        .width = (int32_t)tile->region.width,
        .height = (int32_t)tile->region.height,
        .level_x = (uint8_t)tile->region.mipLevel,
        .level_y = (uint8_t)tile->region.mipLevel,
        .type = EXR_STORAGE_TILED,
        .compression = EXR_COMPRESSION_ZIP,
        .unpacked_size =
            (uint64_t)tile->region.width * tile->region.height * 2 * writer->channel_count,
    };
}

/* Compresses a tile with the library's encoder. The tile is written later, in its turn. */
static exr_result_t compress_tile(struct writer *writer, const struct tile *tile,
                                  const char *packed, exr_encode_pipeline_t *pipeline)
{
    exr_chunk_info_t info = describe_chunk(writer, tile);
    exr_result_t result = exr_encoding_initialize(writer->context, 0, &info, pipeline);
    if (result != EXR_ERR_SUCCESS)
        return result;
    size_t plane = (size_t)2 * tile->region.width;
    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        channel->encode_from_ptr = (const uint8_t *)packed + (size_t)c * plane;
        channel->user_bytes_per_element = 2;
        channel->user_data_type = EXR_PIXEL_HALF;
        channel->user_pixel_stride = 2;
        channel->user_line_stride = (int32_t)(plane * writer->channel_count);
    }
    result = exr_encoding_choose_default_routines(writer->context, 0, pipeline);
    pipeline->yield_until_ready_fn = NULL;
    pipeline->write_fn = NULL;
    return result == EXR_ERR_SUCCESS ? exr_encoding_run(writer->context, 0, pipeline) : result;
}

static void advance(struct writer *writer, struct tile *tile)
{
    uint32_t level = tile->region.mipLevel;
    uint32_t width = slc_mip_size(writer->image.width, level);
    uint32_t height = slc_mip_size(writer->image.height, level);
    tile->index++;
    if (++tile->x * (uint64_t)writer->info.tileWidth < width)
        return;
    tile->x = 0;
    if (++tile->y * (uint64_t)writer->info.tileHeight < height)
        return;
    tile->y = 0;
    tile->region.mipLevel++;
}

/* Takes the next tile. The mutex is held. False: no tile is left. */
static bool take_tile(struct writer *writer, struct tile *tile)
{
    if (writer->result != SLUICE_SUCCESS || writer->next.index == writer->tile_count)
        return false;
    *tile = writer->next;
    SluiceImageRegion *region = &tile->region;
    region->x = tile->x * writer->info.tileWidth;
    region->y = tile->y * writer->info.tileHeight;
    region->width = slc_min_u32(writer->info.tileWidth,
                                slc_mip_size(writer->image.width, region->mipLevel) - region->x);
    region->height = slc_min_u32(writer->info.tileHeight,
                                 slc_mip_size(writer->image.height, region->mipLevel) - region->y);
    advance(writer, &writer->next);
    return true;
}

/* Writes a tile in order, so that neighbors are close in the file. The mutex is held. */
static SluiceResult put_tile(struct writer *writer, const struct tile *tile, const void *bytes,
                             uint64_t size)
{
    int level = (int)tile->region.mipLevel;
    exr_result_t result = exr_write_tile_chunk(writer->context, 0, (int)tile->x, (int)tile->y,
                                               level, level, bytes, size);
    if (result != EXR_ERR_SUCCESS)
        return library_result(writer, result);
    writer->written_count++;
    writer->written_texels += (uint64_t)tile->region.width * tile->region.height;
    if (writer->info.pfnProgress &&
        !writer->info.pfnProgress(writer->info.pUserData, writer->written_texels,
                                  writer->texel_count))
        return SLUICE_ERROR_CANCELED;
    return SLUICE_SUCCESS;
}

/* Makes a tile with the mutex unlocked, then locks it and waits for the tile's turn. */
static void write_tile(struct writer *writer, const struct tile *tile,
                       const struct tile_buffers *buffers)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    const void *bytes = buffers->packed;
    uint64_t size = (uint64_t)tile->region.width * tile->region.height * 2 * writer->channel_count;
    bool compresses = !writer->info.uncompressed;
    exr_result_t encoding = EXR_ERR_SUCCESS;
    SluiceResult result = make_tile(writer, tile, buffers);
    if (result == SLUICE_SUCCESS && compresses) {
        encoding = compress_tile(writer, tile, buffers->packed, &pipeline);
        bytes = pipeline.compressed_buffer;
        size = pipeline.compressed_bytes;
    }
    slc_mutex_lock(&writer->mutex);
    while (writer->written_count != tile->index && writer->result == SLUICE_SUCCESS)
        slc_condition_wait(&writer->turn, &writer->mutex);
    if (writer->result == SLUICE_SUCCESS) {
        if (result == SLUICE_SUCCESS)
            result = library_result(writer, encoding);
        if (result == SLUICE_SUCCESS)
            result = put_tile(writer, tile, bytes, size);
        writer->result = result;
    }
    if (compresses)
        exr_encoding_destroy(writer->context, &pipeline);
    slc_condition_broadcast(&writer->turn);
}

static void report(struct writer *writer, SluiceResult result)
{
    slc_mutex_lock(&writer->mutex);
    if (writer->result == SLUICE_SUCCESS)
        writer->result = result;
    slc_condition_broadcast(&writer->turn);
    slc_mutex_unlock(&writer->mutex);
}

static void *worker_main(void *argument)
{
    struct writer *writer = argument;
    const SluiceAllocationCallbacks *cb = &writer->allocator;
    size_t texels = (size_t)writer->info.tileWidth * writer->info.tileHeight;
    struct tile_buffers buffers = {
        .texels_size = texels * sluiceGetFormatTexelSize(writer->image.format),
        .packed_size = texels * 2 * writer->channel_count,
    };
    buffers.texels = slc_alloc(cb, buffers.texels_size, 1);
    buffers.packed = slc_alloc(cb, buffers.packed_size, 1);
    if (buffers.texels && buffers.packed) {
        struct tile tile;
        slc_mutex_lock(&writer->mutex);
        while (take_tile(writer, &tile)) {
            slc_mutex_unlock(&writer->mutex);
            write_tile(writer, &tile, &buffers); /* returns with the mutex */
        }
        slc_mutex_unlock(&writer->mutex);
    } else {
        report(writer, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
    slc_free(cb, buffers.texels, buffers.texels_size, 1);
    slc_free(cb, buffers.packed, buffers.packed_size, 1);
    return NULL;
}

/* Runs the calling thread and as many others as can be started. */
static SluiceResult run_workers(struct writer *writer)
{
    uint32_t extra = writer->info.threadCount - 1, started = 0;
    struct slc_thread *threads = NULL;
    if (extra > 0) {
        threads = slc_alloc(&writer->allocator, extra, sizeof *threads);
        if (!threads)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    while (started < extra && slc_thread_start(&threads[started], worker_main, writer))
        started++;
    worker_main(writer);
    for (uint32_t i = 0; i < started; i++)
        slc_thread_join(&threads[i]);
    slc_free(&writer->allocator, threads, extra, sizeof *threads);
    return writer->result;
}

static SluiceResult write_image(struct writer *writer)
{
    SluiceResult result = slc_part_file_open(&writer->file, writer->info.pPath, 0,
                                             &writer->allocator, &writer->info.log);
    if (result != SLUICE_SUCCESS) {
        slc_part_file_close(&writer->file);
        return result == SLUICE_ERROR_FILE_NOT_FOUND ? SLUICE_ERROR_IO : result;
    }
    result = library_result(writer, start_context(writer));
    if (result == SLUICE_SUCCESS)
        result = run_workers(writer);
    if (writer->context) {
        exr_result_t finished = exr_finish(&writer->context);
        if (result == SLUICE_SUCCESS)
            result = library_result(writer, finished);
    }
    SluiceResult closed = slc_part_file_finish(&writer->file, result == SLUICE_SUCCESS);
    return result == SLUICE_SUCCESS ? closed : result;
}

static void count_tiles(struct writer *writer)
{
    for (uint32_t level = 0; level < writer->image.mipLevelCount; level++) {
        uint32_t width = slc_mip_size(writer->image.width, level);
        uint32_t height = slc_mip_size(writer->image.height, level);
        writer->texel_count += (uint64_t)width * height;
        writer->tile_count += (uint64_t)slc_div_up_u32(width, writer->info.tileWidth) *
                              slc_div_up_u32(height, writer->info.tileHeight);
    }
}

static SluiceResult prepare(struct writer *writer)
{
    SluiceExrWriteInfo *info = &writer->info;
    if (info->tileWidth == 0)
        info->tileWidth = 128;
    if (info->tileHeight == 0)
        info->tileHeight = 128;
    if (info->threadCount == 0)
        info->threadCount = 1;
    if ((uint64_t)info->tileWidth * info->tileHeight > 1u << 24)
        return fail(writer, SLUICE_ERROR_INVALID_ARGUMENT, "tiles have at most 2^24 texels");
    writer->image.structSize = sizeof writer->image;
    SluiceResult result = sluiceGetImageInfo(writer->source, &writer->image);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceImageInfo *image = &writer->image;
    writer->channel_count = slc_format_channel_count(image->format);
    if (writer->channel_count == 0 || image->width == 0 || image->height == 0 ||
        image->mipLevelCount != slc_mip_count(slc_max_u32(image->width, image->height)))
        return fail(writer, SLUICE_ERROR_INVALID_ARGUMENT,
                    "the source has no texels, an unknown format or not all levels");
    if (writer->channel_count == 4 && info->opaque)
        writer->channel_count = 3;
    if (image->width > 1u << 20 || image->height > 1u << 20)
        return fail(writer, SLUICE_ERROR_UNSUPPORTED,
                    "images have at most 2^20 texels in either direction");
    count_tiles(writer);
    if (writer->tile_count > INT32_MAX)
        return fail(writer, SLUICE_ERROR_LIMIT_EXCEEDED,
                    "there would be more than 2^31 tiles; use larger ones");
    return SLUICE_SUCCESS;
}

SluiceResult sluiceWriteExrFile(const SluiceExrWriteInfo *pInfo, SluiceImageSource *source)
{
    if (!pInfo || !source || !pInfo->pPath || !slc_allocator_is_valid(pInfo->pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    struct writer writer = {.allocator = slc_allocator(pInfo->pAllocator), .source = source};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceExrWriteInfo), &writer.info, pInfo, &pInfo->log);
    if (result == SLUICE_SUCCESS)
        result = prepare(&writer);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_mutex_init(&writer.mutex);
    slc_condition_init(&writer.turn);
    result = write_image(&writer);
    slc_mutex_finish(&writer.mutex);
    slc_condition_finish(&writer.turn);
    return result;
}
