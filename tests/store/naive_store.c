#include "store/naive_store.h"

#include <sluice/image.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include <zstd.h>

static uint64_t number_at(const uint8_t *bytes, int size)
{
    uint64_t value = 0;
    for (int i = size - 1; i >= 0; i--)
        value = value * 256 + bytes[i];
    return value;
}

static void put_number(uint8_t *bytes, uint64_t value)
{
    for (int i = 0; i < 8; i++, value /= 256)
        bytes[i] = (uint8_t)(value % 256);
}

static uint32_t size_at_level(uint32_t size, uint32_t level)
{
    for (; level > 0; level--)
        size = size / 2 > 0 ? size / 2 : 1;
    return size;
}

static void describe_format(struct naive_store *store)
{
    static const uint8_t sizes[SLUICE_FORMAT_COUNT] = {
        0, 1, 4, 4, 2,  4,  8,  4,  8,  16, 2,  4,  4,  4,          /* to E5B9G9R9 */
        8, 8, 8, 8, 16, 16, 16, 16, 8,  8,  16, 16, 16, 16, 16, 16, /* BC1 to BC7 */
        2, 4, 8,                                                    /* R16, R16G16, R16G16B16A16 */
        8, 8, 8, 8, 16, 16, 8,  8,  16, 16, 16, 16, 16, 16,         /* ETC2, EAC, ASTC */
        1, 2, 4, 2, 4,  8,                                          /* SNORM */
        1, 2, 4, 2, 4,  8,  4,  8,  16,                             /* UINT */
        1, 2, 4, 2, 4,  8,  4,  8,  16                              /* SINT */
    };
    store->block_size = store->format < SLUICE_FORMAT_COUNT ? sizes[store->format] : 0;
    bool is_plain = store->format < SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK ||
                    (store->format >= SLUICE_FORMAT_R16_UNORM &&
                     store->format <= SLUICE_FORMAT_R16G16B16A16_UNORM) ||
                    store->format >= SLUICE_FORMAT_R8_SNORM;
    store->block_extent = is_plain                                              ? 1
                          : store->format >= SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK ? 8
                                                                                : 4;
}

/* The standard shapes: twice the blocks of 4 x 4 bytes are lost in one direction, then the other.
 */
static bool tile_shape_is_standard(const struct naive_store *store)
{
    uint32_t width = 256, height = 256, size = 1;
    for (; size < store->block_size; size *= 2) {
        if (width == height)
            height /= 2;
        else
            width /= 2;
    }
    return size == store->block_size && store->tile_width == width * store->block_extent &&
           store->tile_height == height * store->block_extent;
}

static bool fits_without_filling(const struct naive_store *store, uint32_t level)
{
    uint32_t width = size_at_level(store->width, level);
    uint32_t height = size_at_level(store->height, level);
    if (width > store->tile_width || height > store->tile_height)
        return false;
    return !(width == store->tile_width && height == store->tile_height);
}

static uint32_t tiles_across(uint32_t size, uint32_t tile)
{
    return (size + tile - 1) / tile;
}

static const char *check_numbers(struct naive_store *store)
{
    describe_format(store);
    if (store->block_size == 0 || !tile_shape_is_standard(store))
        return "format or tile shape";
    uint32_t levels = 1, tail = 0;
    while ((store->width > store->height ? store->width : store->height) >> levels)
        levels++;
    while (!fits_without_filling(store, tail))
        tail++;
    if (levels != store->levels || tail != store->tail)
        return "level counts";
    uint64_t chunks = 1;
    for (uint32_t l = 0; l < tail; l++)
        chunks += (uint64_t)tiles_across(size_at_level(store->width, l), store->tile_width) *
                  tiles_across(size_at_level(store->height, l), store->tile_height);
    if (chunks * store->layers != store->chunks)
        return "chunk count";
    return store->data == 4096 + 4096 * ((store->chunks + 203) / 204) ? NULL : "data offset";
}

const char *naive_store_init(struct naive_store *store, uint8_t *bytes, size_t size)
{
    *store = (struct naive_store){.bytes = bytes, .size = size};
    if (size < 4096 || memcmp(bytes, "\x89SLS\r\n\x1A\n", 8) != 0)
        return "beginning";
    if (number_at(bytes + 8, 4) != 1)
        return "major version";
    if (number_at(bytes + 4088, 8) != XXH3_64bits(bytes, 4088))
        return "header checksum";
    store->identity = number_at(bytes + 4064, 8);
    if (store->identity != XXH3_64bits(bytes, 4064))
        return "identity";
    if (number_at(bytes + 4072, 8) != size)
        return "file size";
    uint32_t *const fields[] = {&store->width,       &store->height,    &store->levels,
                                &store->layers,      &store->format,    &store->tile_width,
                                &store->tile_height, &store->tail,      &store->color_space,
                                &store->meaning,     &store->address_u, &store->address_v,
                                &store->compression};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++)
        *fields[i] = (uint32_t)number_at(bytes + 16 + 4 * i, 4);
    uint64_t name_size = number_at(bytes + 68, 4);
    if (name_size > 3900)
        return "name";
    memcpy(store->name, bytes + 128, name_size);
    store->source_size = number_at(bytes + 72, 8);
    store->source_time = (int64_t)number_at(bytes + 80, 8);
    store->settings = number_at(bytes + 88, 8);
    store->chunks = number_at(bytes + 96, 8);
    store->data = number_at(bytes + 104, 8);
    return check_numbers(store);
}

const char *naive_store_load(struct naive_store *store, const char *path)
{
    *store = (struct naive_store){0};
    FILE *file = fopen(path, "rb");
    if (!file)
        return "cannot be opened";
    fseek(file, 0, SEEK_END);
    size_t size = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = malloc(size + 1);
    bool is_read = fread(bytes, 1, size, file) == size;
    fclose(file);
    const char *message = naive_store_init(store, bytes, size);
    return is_read ? message : "cannot be read";
}

void naive_store_finish(struct naive_store *store)
{
    free(store->bytes);
}

/* Bytes of a rectangle of texels, given as its extent. */
static size_t blocks_size(const struct naive_store *store, uint32_t width, uint32_t height)
{
    return (size_t)tiles_across(width, store->block_extent) *
           tiles_across(height, store->block_extent) * store->block_size;
}

size_t naive_store_level_size(const struct naive_store *store, uint32_t level)
{
    return blocks_size(store, size_at_level(store->width, level),
                       size_at_level(store->height, level));
}

/* A chunk found by counting all of them from the first. */
struct walk {
    uint64_t number;
    uint32_t layer, level, x, y; ///< texels
    uint32_t width, height;
};

static bool walk_next(const struct naive_store *store, struct walk *walk)
{
    walk->number++;
    walk->x += store->tile_width;
    if (walk->level == store->tail || walk->x >= size_at_level(store->width, walk->level)) {
        walk->x = 0;
        walk->y += store->tile_height;
    }
    if (walk->level == store->tail || walk->y >= size_at_level(store->height, walk->level)) {
        walk->x = walk->y = 0;
        walk->level++;
    }
    if (walk->level > store->tail) {
        walk->level = 0;
        walk->layer++;
    }
    return walk->layer < store->layers;
}

static void walk_measure(const struct naive_store *store, struct walk *walk)
{
    walk->width = size_at_level(store->width, walk->level) - walk->x;
    walk->height = size_at_level(store->height, walk->level) - walk->y;
    if (walk->width > store->tile_width)
        walk->width = store->tile_width;
    if (walk->height > store->tile_height)
        walk->height = store->tile_height;
}

static size_t walk_size(const struct naive_store *store, const struct walk *walk)
{
    if (walk->level < store->tail)
        return blocks_size(store, walk->width, walk->height);
    size_t size = 0;
    for (uint32_t l = store->tail; l < store->levels; l++)
        size += naive_store_level_size(store, l);
    return size;
}

static struct naive_chunk chunk_of(const struct naive_store *store, struct walk *walk)
{
    walk_measure(store, walk);
    struct naive_chunk chunk = {.entry = 4096 + walk->number / 204 * 4096 + walk->number % 204 * 20,
                                .texel_size = (uint32_t)walk_size(store, walk)};
    const uint8_t *entry = store->bytes + chunk.entry;
    chunk.offset = number_at(entry, 8);
    chunk.checksum = number_at(entry + 8, 8);
    chunk.size = (uint32_t)number_at(entry + 16, 4);
    return chunk;
}

struct naive_chunk naive_store_chunk(const struct naive_store *store, uint64_t number)
{
    struct walk walk = {0};
    while (walk.number < number)
        walk_next(store, &walk);
    return chunk_of(store, &walk);
}

static const char *unpack(const struct naive_store *store, uint64_t number,
                          const struct naive_chunk *chunk, uint8_t *texels)
{
    uint64_t block = number / 204, at = 4096 + 4096 * block;
    if (at + 4096 > store->size ||
        number_at(store->bytes + at + 4088, 8) !=
            XXH3_64bits_withSeed(store->bytes + at, 4088, store->identity + block))
        return "index";
    if (chunk->offset < store->data || chunk->offset > store->size ||
        chunk->size > store->size - chunk->offset || chunk->size == 0)
        return "place of a chunk";
    const uint8_t *bytes = store->bytes + chunk->offset;
    if (XXH3_64bits_withSeed(bytes, chunk->size, store->identity + number) != chunk->checksum)
        return "checksum of a chunk";
    if (store->compression == 0 && (chunk->offset % 4096 != 0 || chunk->size != chunk->texel_size))
        return "chunk of an uncompressed file";
    if (chunk->size == chunk->texel_size) {
        memcpy(texels, bytes, chunk->size);
        return NULL;
    }
    if (chunk->size > chunk->texel_size ||
        ZSTD_getFrameContentSize(bytes, chunk->size) != chunk->texel_size)
        return "content size";
    return ZSTD_decompress(texels, chunk->texel_size, bytes, chunk->size) == chunk->texel_size
               ? NULL
               : "zstd";
}

static void place_tile(const struct naive_store *store, const struct walk *walk,
                       const uint8_t *texels, uint8_t *out)
{
    size_t pitch = blocks_size(store, size_at_level(store->width, walk->level), 1);
    size_t row = blocks_size(store, walk->width, 1);
    out +=
        walk->y / store->block_extent * pitch + walk->x / store->block_extent * store->block_size;
    for (size_t y = 0; y < tiles_across(walk->height, store->block_extent); y++)
        memcpy(out + y * pitch, texels + y * row, row);
}

const char *naive_store_level(const struct naive_store *store, uint32_t layer, uint32_t level,
                              uint8_t *out)
{
    static uint8_t texels[131072];
    struct walk walk = {0};
    do {
        if (walk.layer != layer || walk.level != (level < store->tail ? level : store->tail))
            continue;
        struct naive_chunk chunk = chunk_of(store, &walk);
        const char *message = unpack(store, walk.number, &chunk, texels);
        if (message)
            return message;
        const uint8_t *from = texels;
        for (uint32_t l = store->tail; l < level; l++)
            from += naive_store_level_size(store, l);
        if (level >= store->tail)
            memcpy(out, from, naive_store_level_size(store, level));
        else
            place_tile(store, &walk, texels, out);
    } while (walk_next(store, &walk));
    return NULL;
}

static void reseal_chunk(uint8_t *bytes, size_t size, uint64_t identity, uint64_t number)
{
    uint8_t *entry = bytes + 4096 + number / 204 * 4096 + number % 204 * 20;
    uint64_t offset = number_at(entry, 8), length = number_at(entry + 16, 4);
    if (length > 0 && offset <= size && length <= size - offset)
        put_number(entry + 8, XXH3_64bits_withSeed(bytes + offset, length, identity + number));
}

void naive_store_reseal(uint8_t *bytes, size_t size)
{
    if (size < 4096)
        return;
    uint64_t identity = XXH3_64bits(bytes, 4064), count = number_at(bytes + 96, 8);
    put_number(bytes + 4064, identity);
    put_number(bytes + 4088, XXH3_64bits(bytes, 4088));
    for (uint64_t block = 0; block * 204 < count && 8192 + block * 4096 <= size; block++) {
        for (uint64_t i = 0; i < 204 && block * 204 + i < count; i++)
            reseal_chunk(bytes, size, identity, block * 204 + i);
        uint8_t *at = bytes + 4096 + block * 4096;
        put_number(at + 4088, XXH3_64bits_withSeed(at, 4088, identity + block));
    }
}
