#include "store/store_layout.h"

#include "image/info.h"
#include "base/little_endian.h"

#include <string.h>
#include <xxhash.h>

/* Offsets of the header's fields. docs/store.md has this table, too. */
enum {
    AT_MAGIC = 0,
    AT_MAJOR = 8,
    AT_MINOR = 12,
    AT_WIDTH = 16,
    AT_HEIGHT = 20,
    AT_LEVEL_COUNT = 24,
    AT_LAYER_COUNT = 28,
    AT_FORMAT = 32,
    AT_TILE_WIDTH = 36,
    AT_TILE_HEIGHT = 40,
    AT_TAIL_LEVEL = 44,
    AT_COLOR_SPACE = 48,
    AT_MEANING = 52,
    AT_ADDRESS_U = 56,
    AT_ADDRESS_V = 60,
    AT_COMPRESSION = 64,
    AT_NAME_SIZE = 68,
    AT_SOURCE_SIZE = 72,
    AT_SOURCE_TIME = 80,
    AT_SETTINGS = 88,
    AT_CHUNK_COUNT = 96,
    AT_DATA_OFFSET = 104,
    AT_CUBE = 112,
    AT_NAME = SLC_STORE_NAME_OFFSET,
    AT_IDENTITY = 4064, /* hash of all bytes before it */
    AT_FILE_SIZE = 4072,
    AT_CHECKSUM = 4088 /* checksum of all bytes before it, also in blocks of the index */
};

_Static_assert(AT_NAME + SLUICE_STORE_MAX_SOURCE_NAME <= AT_IDENTITY, "names fit");
_Static_assert(SLC_STORE_BLOCK_ENTRIES *SLC_STORE_ENTRY_SIZE <= AT_CHECKSUM, "entries fit");

/* Magic number like PNG's: transfers in text mode damage it. */
static const unsigned char magic[8] = {0x89, 'S', 'L', 'S', '\r', '\n', 0x1A, '\n'};

static uint64_t count_blocks(const struct slc_store_grid *grid)
{
    return (grid->chunk_count + SLC_STORE_BLOCK_ENTRIES - 1) / SLC_STORE_BLOCK_ENTRIES;
}

void slc_store_header_write(struct slc_store_header *header,
                            unsigned char bytes[SLC_STORE_HEADER_SIZE])
{
    const SluiceStoreLayout *layout = &header->grid.layout;
    header->block_count = count_blocks(&header->grid);
    header->data_offset = slc_store_block_offset(header->block_count);
    memset(bytes, 0, SLC_STORE_HEADER_SIZE);
    memcpy(bytes + AT_MAGIC, magic, sizeof magic);
    slc_put_u32(bytes + AT_MAJOR, header->major);
    slc_put_u32(bytes + AT_MINOR, header->minor);
    slc_put_u32(bytes + AT_WIDTH, layout->width);
    slc_put_u32(bytes + AT_HEIGHT, layout->height);
    slc_put_u32(bytes + AT_LEVEL_COUNT, layout->mipLevelCount);
    slc_put_u32(bytes + AT_LAYER_COUNT, header->grid.layer_count);
    slc_put_u32(bytes + AT_FORMAT, layout->format);
    slc_put_u32(bytes + AT_TILE_WIDTH, layout->tileWidth);
    slc_put_u32(bytes + AT_TILE_HEIGHT, layout->tileHeight);
    slc_put_u32(bytes + AT_TAIL_LEVEL, layout->tailFirstLevel);
    slc_put_u32(bytes + AT_COLOR_SPACE, header->color_space);
    slc_put_u32(bytes + AT_MEANING, header->meaning);
    slc_put_u32(bytes + AT_ADDRESS_U, header->address_mode_u);
    slc_put_u32(bytes + AT_ADDRESS_V, header->address_mode_v);
    slc_put_u32(bytes + AT_COMPRESSION, header->compression_level);
    slc_put_u32(bytes + AT_NAME_SIZE, header->name_size);
    slc_put_u64(bytes + AT_SOURCE_SIZE, header->source_size);
    slc_put_u64(bytes + AT_SOURCE_TIME, (uint64_t)header->source_time);
    slc_put_u64(bytes + AT_SETTINGS, header->settings_hash);
    slc_put_u64(bytes + AT_CHUNK_COUNT, header->grid.chunk_count);
    slc_put_u64(bytes + AT_DATA_OFFSET, header->data_offset);
    slc_put_u32(bytes + AT_CUBE, header->cube);
    memcpy(bytes + AT_NAME, header->name, header->name_size);
    header->identity = XXH3_64bits(bytes, AT_IDENTITY);
    slc_put_u64(bytes + AT_IDENTITY, header->identity);
    slc_put_u64(bytes + AT_FILE_SIZE, header->file_size);
    slc_put_u64(bytes + AT_CHECKSUM, XXH3_64bits(bytes, AT_CHECKSUM));
}

bool slc_store_header_matches(const unsigned char a[SLC_STORE_HEADER_SIZE],
                              const unsigned char b[SLC_STORE_HEADER_SIZE])
{
    return memcmp(a, b, AT_FILE_SIZE) == 0;
}

/* Checks magic number, version and checksum, before any other field. */
static SluiceResult check_frame(const unsigned char *bytes, uint32_t *offset, const char **message)
{
    *offset = AT_MAGIC;
    *message = "is not a tile store, or its beginning is damaged";
    if (memcmp(bytes + AT_MAGIC, magic, sizeof magic) != 0)
        return SLUICE_ERROR_CORRUPT_DATA;
    uint32_t major = slc_get_u32(bytes + AT_MAJOR);
    *offset = AT_MAJOR;
    *message = "is of a newer major version than this library reads; update Sluice, or bake it "
               "again with this version";
    if (major > SLUICE_STORE_VERSION_MAJOR)
        return SLUICE_ERROR_UNSUPPORTED;
    *message = "has a major version that never was";
    if (major < SLUICE_STORE_VERSION_MAJOR)
        return SLUICE_ERROR_CORRUPT_DATA;
    *offset = AT_CHECKSUM;
    *message = "the header's checksum is wrong; the file is damaged";
    if (slc_get_u64(bytes + AT_CHECKSUM) != XXH3_64bits(bytes, AT_CHECKSUM))
        return SLUICE_ERROR_CORRUPT_DATA;
    *offset = AT_IDENTITY;
    *message = "the identity is not that of the header";
    if (slc_get_u64(bytes + AT_IDENTITY) != XXH3_64bits(bytes, AT_IDENTITY))
        return SLUICE_ERROR_CORRUPT_DATA;
    return SLUICE_SUCCESS;
}

static SluiceResult read_grid(struct slc_store_header *header, const unsigned char *bytes,
                              uint32_t *offset, const char **message)
{
    uint32_t format = slc_get_u32(bytes + AT_FORMAT);
    *offset = AT_FORMAT;
    *message = "has a format that this version of Sluice does not know; update it";
    if (format == SLUICE_FORMAT_UNDEFINED || format >= SLUICE_FORMAT_COUNT)
        return SLUICE_ERROR_UNSUPPORTED;
    *offset = AT_WIDTH;
    *message = "the size of the image is out of range";
    if (slc_store_grid_init(&header->grid, slc_get_u32(bytes + AT_WIDTH),
                            slc_get_u32(bytes + AT_HEIGHT), (SluiceFormat)format,
                            slc_get_u32(bytes + AT_LAYER_COUNT)) != SLUICE_SUCCESS)
        return SLUICE_ERROR_CORRUPT_DATA;
    header->block_count = count_blocks(&header->grid);
    header->data_offset = slc_store_block_offset(header->block_count);
    return SLUICE_SUCCESS;
}

/* Checks fields that follow from size and format. They are stored for other readers. */
static SluiceResult check_consequences(const struct slc_store_header *header,
                                       const unsigned char *bytes, uint32_t *offset,
                                       const char **message)
{
    const SluiceStoreLayout *layout = &header->grid.layout;
    const struct {
        uint32_t at;
        uint64_t value;
    } facts[] = {
        {AT_LEVEL_COUNT, layout->mipLevelCount},    {AT_TILE_WIDTH, layout->tileWidth},
        {AT_TILE_HEIGHT, layout->tileHeight},       {AT_TAIL_LEVEL, layout->tailFirstLevel},
        {AT_CHUNK_COUNT, header->grid.chunk_count}, {AT_DATA_OFFSET, header->data_offset}};
    *message = "a number in the header does not follow from size and format";
    for (size_t i = 0; i < sizeof facts / sizeof facts[0]; i++) {
        *offset = facts[i].at;
        uint64_t value = facts[i].at < AT_CHUNK_COUNT ? slc_get_u32(bytes + facts[i].at)
                                                      : slc_get_u64(bytes + facts[i].at);
        if (value != facts[i].value)
            return SLUICE_ERROR_CORRUPT_DATA;
    }
    return SLUICE_SUCCESS;
}

/* Reads enums. Unknown values of a newer minor version become the neutral value; else they are
 * damage. */
static SluiceResult read_choices(struct slc_store_header *header, const unsigned char *bytes,
                                 uint32_t *offset, const char **message)
{
    const struct {
        uint32_t at, last, otherwise;
    } choices[] = {
        {AT_COLOR_SPACE, SLUICE_STORE_COLOR_SPACE_ACESCG, SLUICE_STORE_COLOR_SPACE_UNDEFINED},
        {AT_MEANING, SLUICE_STORE_MEANING_DATA, SLUICE_STORE_MEANING_DATA},
        {AT_ADDRESS_U, SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_BORDER,
         SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_EDGE},
        {AT_ADDRESS_V, SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_BORDER,
         SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_EDGE},
        {AT_CUBE, true, false}};
    uint32_t values[sizeof choices / sizeof choices[0]];
    *message = "color space, meaning, address mode or cube flag has a value that this version does "
               "not have";
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; i++) {
        *offset = choices[i].at;
        values[i] = slc_get_u32(bytes + choices[i].at);
        bool is_known = values[i] <= choices[i].last;
        if (!is_known && header->minor <= SLUICE_STORE_VERSION_MINOR)
            return SLUICE_ERROR_CORRUPT_DATA;
        values[i] = is_known ? values[i] : choices[i].otherwise;
    }
    header->color_space = (SluiceStoreColorSpace)values[0];
    header->meaning = (SluiceStoreMeaning)values[1];
    header->address_mode_u = (SluiceStoreAddressMode)values[2];
    header->address_mode_v = (SluiceStoreAddressMode)values[3];
    header->cube = values[4];
    return SLUICE_SUCCESS;
}

static SluiceResult check_cube(const struct slc_store_header *header, uint32_t *offset,
                               const char **message)
{
    const SluiceStoreLayout *layout = &header->grid.layout;
    *offset = AT_HEIGHT;
    *message = "faces of cube maps are not square";
    if (header->cube && layout->width != layout->height)
        return SLUICE_ERROR_CORRUPT_DATA;
    *offset = AT_LAYER_COUNT;
    *message = "the number of layers of cube maps is no multiple of 6";
    if (header->cube && header->grid.layer_count % SLC_CUBE_FACES)
        return SLUICE_ERROR_CORRUPT_DATA;
    return SLUICE_SUCCESS;
}

static SluiceResult read_properties(struct slc_store_header *header, const unsigned char *bytes,
                                    uint32_t *offset, const char **message)
{
    header->compression_level = slc_get_u32(bytes + AT_COMPRESSION);
    header->name_size = slc_get_u32(bytes + AT_NAME_SIZE);
    header->name = (const char *)bytes + AT_NAME;
    header->source_size = slc_get_u64(bytes + AT_SOURCE_SIZE);
    header->source_time = (int64_t)slc_get_u64(bytes + AT_SOURCE_TIME);
    header->settings_hash = slc_get_u64(bytes + AT_SETTINGS);
    *offset = AT_NAME_SIZE;
    *message = "the name of the source is too long";
    if (header->name_size > SLUICE_STORE_MAX_SOURCE_NAME)
        return SLUICE_ERROR_CORRUPT_DATA;
    *offset = AT_FILE_SIZE;
    *message = "was never finished; write it again, or resume writing it";
    header->file_size = slc_get_u64(bytes + AT_FILE_SIZE);
    return header->file_size ? SLUICE_SUCCESS : SLUICE_ERROR_CORRUPT_DATA;
}

SluiceResult slc_store_header_read(struct slc_store_header *header,
                                   const unsigned char bytes[SLC_STORE_HEADER_SIZE],
                                   uint32_t *offset, const char **message)
{
    *header = (struct slc_store_header){.major = slc_get_u32(bytes + AT_MAJOR),
                                        .minor = slc_get_u32(bytes + AT_MINOR),
                                        .identity = slc_get_u64(bytes + AT_IDENTITY)};
    SluiceResult result = check_frame(bytes, offset, message);
    if (result == SLUICE_SUCCESS)
        result = read_grid(header, bytes, offset, message);
    if (result == SLUICE_SUCCESS)
        result = check_consequences(header, bytes, offset, message);
    if (result == SLUICE_SUCCESS)
        result = read_choices(header, bytes, offset, message);
    if (result == SLUICE_SUCCESS)
        result = check_cube(header, offset, message);
    if (result == SLUICE_SUCCESS)
        result = read_properties(header, bytes, offset, message);
    return result;
}

bool slc_store_header_number(const unsigned char bytes[SLC_STORE_HEADER_SIZE], uint32_t offset,
                             uint32_t *value)
{
    if (offset != AT_CUBE && (offset < AT_MAJOR || offset > AT_NAME_SIZE))
        return false;
    *value = slc_get_u32(bytes + offset);
    return true;
}

void slc_store_entry_write(const struct slc_store_entry *entry,
                           unsigned char bytes[SLC_STORE_ENTRY_SIZE])
{
    slc_put_u64(bytes, entry->offset);
    slc_put_u64(bytes + 8, entry->checksum);
    slc_put_u32(bytes + 16, entry->size);
}

struct slc_store_entry slc_store_entry_read(const unsigned char bytes[SLC_STORE_ENTRY_SIZE])
{
    return (struct slc_store_entry){slc_get_u64(bytes), slc_get_u64(bytes + 8),
                                    slc_get_u32(bytes + 16)};
}

static uint64_t block_checksum(const struct slc_store_header *header, uint64_t block,
                               const unsigned char *bytes)
{
    return XXH3_64bits_withSeed(bytes, AT_CHECKSUM, header->identity + block);
}

void slc_store_block_seal(const struct slc_store_header *header, uint64_t block,
                          unsigned char bytes[SLC_STORE_BLOCK_SIZE])
{
    memset(bytes + SLC_STORE_BLOCK_ENTRIES * SLC_STORE_ENTRY_SIZE, 0,
           SLC_STORE_BLOCK_SIZE - SLC_STORE_BLOCK_ENTRIES * SLC_STORE_ENTRY_SIZE);
    slc_put_u64(bytes + AT_CHECKSUM, block_checksum(header, block, bytes));
}

bool slc_store_block_is_sound(const struct slc_store_header *header, uint64_t block,
                              const unsigned char bytes[SLC_STORE_BLOCK_SIZE])
{
    return slc_get_u64(bytes + AT_CHECKSUM) == block_checksum(header, block, bytes);
}

uint64_t slc_store_chunk_checksum(const struct slc_store_header *header, uint64_t number,
                                  const void *bytes, size_t size)
{
    return XXH3_64bits_withSeed(bytes, size, header->identity + number);
}

const char *slc_store_entry_defect(const struct slc_store_header *header, uint64_t end,
                                   const struct slc_store_place *place,
                                   const struct slc_store_entry *entry)
{
    uint32_t size = slc_store_chunk_size(&header->grid, place);
    if (entry->offset < header->data_offset || entry->offset > end ||
        entry->size > end - entry->offset)
        return "a tile lies outside the file's data";
    if (entry->size == 0 || entry->size > size)
        return "a tile has no bytes, or more than its texels";
    if (header->compression_level > 0)
        return NULL;
    if (entry->size != size)
        return "a tile of an uncompressed file has not the size of its texels";
    if (entry->offset != header->data_offset + slc_store_chunk_offset(&header->grid, place))
        return "a tile of an uncompressed file is not where it should be";
    return NULL;
}
