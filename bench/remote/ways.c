#define _XOPEN_SOURCE 700
#define _FILE_OFFSET_BITS 64

#include "ways.h"

#include <curl/curl.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void fail(const char *what)
{
    fprintf(stderr, "remote_figures: %s failed\n", what);
    exit(1);
}

static void print_message(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    (void)severity;
    fprintf(stderr, "%s\n", message);
}

static const SluiceLogCallback log_to_stderr = {NULL, print_message};

/* Texels that no server compresses. */
static void fill(unsigned char *texels, size_t size, uint32_t seed)
{
    for (size_t i = 0; i < size; i++) {
        seed = seed * 1664525u + 1013904223u;
        texels[i] = (unsigned char)(seed >> 24);
    }
}

static void write_tail(SluiceStoreWriter *writer, const SluiceStoreLayout *layout,
                       const unsigned char *texels)
{
    const void *levels[SLUICE_STORE_MAX_MIP_LEVELS];
    for (uint32_t l = layout->tailFirstLevel; l < layout->mipLevelCount; l++)
        levels[l - layout->tailFirstLevel] = texels;
    if (sluiceWriteStoreTail(writer, 0, levels, NULL))
        fail("writing the tail");
}

void make_store(const char *path, uint32_t edge)
{
    static unsigned char texels[TILE_SIZE];
    SluiceStoreCreateInfo create = {.structSize = sizeof create,
                                    .pPath = path,
                                    .width = edge,
                                    .height = edge,
                                    .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                    .log = log_to_stderr};
    SluiceStoreWriter *writer = NULL;
    SluiceStoreLayout layout;
    if (sluiceCreateStoreWriter(&create, &writer) || sluiceGetStoreWriterLayout(writer, &layout))
        fail("creating a store");
    for (uint32_t l = 0; l < layout.tailFirstLevel; l++)
        for (uint32_t y = 0; y < layout.levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < layout.levelWidthInTiles[l]; x++) {
                fill(texels, sizeof texels, l << 28 | y << 14 | x);
                if (sluiceWriteStoreTile(writer, 0, l, x, y, texels, (size_t)layout.tileWidth * 4))
                    fail("writing a tile");
            }
    write_tail(writer, &layout, texels);
    if (sluiceFinishStore(writer))
        fail("finishing the store");
    sluiceDestroyStoreWriter(writer);
}

/* An input over a file that notes the last read. */
struct noted {
    int file;
    uint64_t offset, size;
};

static SluiceResult read_noted(void *user, uint64_t offset, void *bytes, size_t size)
{
    struct noted *noted = user;
    noted->offset = offset;
    noted->size = size;
    return pread(noted->file, bytes, size, (off_t)offset) == (ssize_t)size ? SLUICE_SUCCESS
                                                                           : SLUICE_ERROR_IO;
}

static void add_tile(struct tiles *tiles, SluiceImageSource *source,
                     const SluiceImageRegion *region, const struct noted *noted)
{
    static unsigned char texels[TILE_SIZE];
    /* The first read of a tile may read the index, too. */
    for (int i = 0; i < 2; i++)
        if (sluiceReadImageRegion(source, region, texels, (size_t)region->width * 4))
            fail("reading the store");
    tiles->items[tiles->count++] = (struct tile){*region, noted->offset, noted->size};
}

struct tiles find_tiles(const char *path)
{
    struct noted noted = {.file = open(path, O_RDONLY)};
    struct stat status;
    if (noted.file < 0 || fstat(noted.file, &status) != 0)
        fail(path);
    SluiceInput input = {.structSize = sizeof input,
                         .size = (uint64_t)status.st_size,
                         .pUserData = &noted,
                         .pfnRead = read_noted};
    SluiceStoreImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = path, .pInput = &input, .log = log_to_stderr};
    SluiceImageSource *source = NULL;
    SluiceStoreInfo info = {.structSize = sizeof info};
    if (sluiceCreateStoreImageSource(&create, &source) || sluiceGetStoreInfo(source, &info))
        fail("opening the store");
    const SluiceStoreLayout *layout = &info.layout;
    struct tiles tiles = {calloc(layout->tileCount, sizeof *tiles.items), 0};
    if (!tiles.items)
        fail("finding memory");
    for (uint32_t y = 0; y < layout->levelHeightInTiles[0]; y++)
        for (uint32_t x = 0; x < layout->levelWidthInTiles[0]; x++) {
            SluiceImageRegion region;
            if (sluiceGetStoreTileRegion(layout, 0, x, y, &region))
                fail("finding a tile");
            add_tile(&tiles, source, &region, &noted);
        }
    sluiceDestroyImageSource(source);
    close(noted.file);
    return tiles;
}

/* With sluice-http. */

struct sluice {
    SluiceHttpClient *client;
    SluiceHttpFile *file;
    SluiceInput input;
    SluiceImageSource *source; ///< NULL: ranges are read, not tiles
};

static bool read_range(struct way *way, uint32_t reader, const struct tile *tile,
                       unsigned char *texels)
{
    const struct sluice *sluice = way->state;
    (void)reader;
    return sluice->input.pfnRead(sluice->input.pUserData, tile->offset, texels,
                                 (size_t)tile->size) == SLUICE_SUCCESS;
}

static bool read_tile(struct way *way, uint32_t reader, const struct tile *tile,
                      unsigned char *texels)
{
    const struct sluice *sluice = way->state;
    (void)reader;
    return sluiceReadImageRegion(sluice->source, &tile->region, texels,
                                 (size_t)tile->region.width * 4) == SLUICE_SUCCESS;
}

static void finish_sluice(struct way *way)
{
    struct sluice *sluice = way->state;
    sluiceDestroyImageSource(sluice->source);
    sluiceDestroyHttpFile(sluice->file);
    sluiceDestroyHttpClient(sluice->client);
    free(sluice);
}

struct way open_input(const char *url, uint32_t reader_count)
{
    struct sluice *sluice = calloc(1, sizeof *sluice);
    SluiceHttpClientCreateInfo info = {
        .structSize = sizeof info, .maxConnectionsPerHost = reader_count, .log = log_to_stderr};
    if (!sluice)
        fail("finding memory");
    sluice->input.structSize = sizeof sluice->input;
    if (sluiceCreateHttpClient(&info, &sluice->client) ||
        sluiceOpenHttpFile(sluice->client, url, &sluice->file) ||
        sluiceGetHttpInput(sluice->file, &sluice->input))
        fail("opening the URL");
    return (struct way){read_range, finish_sluice, sluice};
}

struct way open_source(const char *url, uint32_t reader_count)
{
    struct way way = open_input(url, reader_count);
    struct sluice *sluice = way.state;
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = url,
                                               .pInput = &sluice->input,
                                               .alwaysCheckRawTiles = true,
                                               .log = log_to_stderr};
    if (sluiceCreateStoreImageSource(&create, &sluice->source))
        fail("opening the store");
    way.read = read_tile;
    return way;
}

SluiceHttpStatistics get_statistics(const struct way *way)
{
    const struct sluice *sluice = way->state;
    SluiceHttpStatistics statistics = {.structSize = sizeof statistics};
    if (sluiceGetHttpStatistics(sluice->client, &statistics))
        fail("asking the client");
    return statistics;
}

/* With libcurl alone: a handle per thread. */

struct plain {
    CURL *handles[MAX_READERS];
    uint32_t count;
};

struct body {
    unsigned char *bytes;
    size_t received, size;
};

static size_t take_body(char *bytes, size_t size, size_t count, void *user)
{
    struct body *body = user;
    size *= count;
    if (size > body->size - body->received)
        return 0;
    memcpy(body->bytes + body->received, bytes, size);
    body->received += size;
    return size;
}

static bool read_plain(struct way *way, uint32_t reader, const struct tile *tile,
                       unsigned char *texels)
{
    struct plain *plain = way->state;
    struct body body = {texels, 0, (size_t)tile->size};
    char range[64];
    snprintf(range, sizeof range, "%llu-%llu", (unsigned long long)tile->offset,
             (unsigned long long)(tile->offset + tile->size - 1));
    curl_easy_setopt(plain->handles[reader], CURLOPT_RANGE, range);
    curl_easy_setopt(plain->handles[reader], CURLOPT_WRITEDATA, &body);
    return curl_easy_perform(plain->handles[reader]) == CURLE_OK && body.received == body.size;
}

static void finish_plain(struct way *way)
{
    struct plain *plain = way->state;
    for (uint32_t i = 0; i < plain->count; i++)
        curl_easy_cleanup(plain->handles[i]);
    free(plain);
}

struct way open_plain(const char *url, uint32_t reader_count)
{
    struct plain *plain = calloc(1, sizeof *plain);
    if (!plain || reader_count > MAX_READERS)
        fail("finding memory");
    for (; plain->count < reader_count; plain->count++) {
        CURL *easy = plain->handles[plain->count] = curl_easy_init();
        if (!easy)
            fail("libcurl");
        curl_easy_setopt(easy, CURLOPT_URL, url);
        curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
        curl_easy_setopt(easy, CURLOPT_HTTP_VERSION, (long)CURL_HTTP_VERSION_1_1);
        curl_easy_setopt(easy, CURLOPT_BUFFERSIZE, 128L << 10);
        curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, take_body);
    }
    return (struct way){read_plain, finish_plain, plain};
}
