#include "http/http_cache.h"

#include "base/alloc.h"
#include "base/cache_folder.h"
#include "base/little_endian.h"
#include "base/log.h"

#include <stdio.h>
#include <string.h>
#include <xxhash.h>

#define SUFFIX ".range"
#define PART_SUFFIX ".part"
#define DIGITS 32u
#define HEADER_SIZE 56u
static const char magic[8] = {'S', 'L', 'H', 'C', '0', '0', '0', '2'};

struct slc_http_key slc_http_cache_key(const char *url, const char *name, const char *version,
                                       uint64_t offset, uint64_t size)
{
    uint8_t place[16];
    slc_put_u64(place, offset);
    slc_put_u64(place + 8, size);
    XXH128_hash_t hash = XXH3_128bits(url, strlen(url));
    hash = XXH3_128bits_withSeed(version, strlen(version), hash.low64 ^ hash.high64 * 3);
    hash = XXH3_128bits_withSeed(place, sizeof place, hash.low64 ^ hash.high64 * 3);
    return (struct slc_http_key){hash.low64, hash.high64, name, version};
}

/* Makes a file's header. File layout: header, name, version, bytes. */
static void make_header(uint8_t header[HEADER_SIZE], struct slc_http_key key, const void *bytes,
                        size_t size)
{
    memcpy(header, magic, sizeof magic);
    slc_put_u64(header + 8, key.low);
    slc_put_u64(header + 16, key.high);
    slc_put_u64(header + 24, size);
    slc_put_u64(header + 32, strlen(key.name));
    slc_put_u64(header + 40, strlen(key.version));
    slc_put_u64(header + 48, XXH3_64bits_withSeed(bytes, size, key.low));
}

/* Returns the file offset of the range's bytes. */
static uint64_t start_of(struct slc_http_key key)
{
    return HEADER_SIZE + strlen(key.name) + strlen(key.version);
}

/* Makes the path of a range's file. False: too long. */
static bool make_path(const struct slc_http_cache *cache, struct slc_http_key key, char *path,
                      size_t size)
{
    int length = snprintf(path, size, "%s/%016llx%016llx" SUFFIX, cache->folder,
                          (unsigned long long)key.high, (unsigned long long)key.low);
    return length > 0 && (size_t)length < size;
}

static bool read_all(int descriptor, uint64_t offset, void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        int64_t got =
            slc_file_read_at(descriptor, offset + done, (char *)bytes + done, size - done);
        if (got > 0)
            done += (size_t)got;
        else if (got == 0 || errno != EINTR)
            return false;
    }
    return true;
}

static bool write_all(int descriptor, uint64_t offset, const void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        int64_t got =
            slc_file_write_at(descriptor, offset + done, (const char *)bytes + done, size - done);
        if (got > 0)
            done += (size_t)got;
        else if (got == 0 || errno != EINTR)
            return false;
    }
    return true;
}

/* Compares a text with the file's. An attacker can make hashes of URLs equal, but not texts. */
static bool has_text(int descriptor, uint64_t offset, const char *text)
{
    char found[256];
    for (size_t left = strlen(text); left > 0;) {
        size_t size = left < sizeof found ? left : sizeof found;
        if (!read_all(descriptor, offset, found, size) || memcmp(found, text, size) != 0)
            return false;
        offset += size;
        text += size;
        left -= size;
    }
    return true;
}

bool slc_http_cache_read(struct slc_http_cache *cache, struct slc_http_key key, void *bytes,
                         size_t size)
{
    char path[4096];
    uint8_t found[HEADER_SIZE], expected[HEADER_SIZE];
    int descriptor = make_path(cache, key, path, sizeof path) ? slc_file_open(path) : -1;
    if (descriptor < 0)
        return false;
    bool is_whole = read_all(descriptor, 0, found, HEADER_SIZE) &&
                    has_text(descriptor, HEADER_SIZE, key.name) &&
                    has_text(descriptor, HEADER_SIZE + strlen(key.name), key.version) &&
                    read_all(descriptor, start_of(key), bytes, size);
    slc_file_close(descriptor);
    if (is_whole)
        make_header(expected, key, bytes, size);
    if (!is_whole || memcmp(found, expected, HEADER_SIZE) != 0) {
        slc_path_remove(path);
        return false;
    }
    slc_path_touch(path);
    atomic_fetch_add(&cache->hits, 1);
    return true;
}

/* Finds the kind of a folder entry. False: the name does not belong to the cache. */
static bool find_kind(struct slc_cache_entry *entry)
{
    const char *name = entry->name;
    if (strspn(name, "0123456789abcdef") != DIGITS || strncmp(name + DIGITS, SUFFIX, 6) != 0)
        return false;
    name += DIGITS + 6;
    size_t length = strlen(name);
    bool is_part = length > 5 && strcmp(name + length - 5, PART_SUFFIX) == 0;
    entry->kind = is_part ? SLC_CACHE_TEMPORARY : SLC_CACHE_COMPLETE;
    return is_part || length == 0;
}

/* Counts the folder's bytes. Above the limit, frees a tenth more than necessary, to run rarely. */
static void trim(struct slc_http_cache *cache)
{
    uint64_t size;
    const struct slc_cache_rules rules = {.max_size = cache->max_size,
                                          .remaining_size = cache->max_size - cache->max_size / 10,
                                          .find_kind = find_kind};
    if (slc_cache_folder_trim(cache->folder, &rules, &cache->allocator, &size))
        atomic_store(&cache->size, size);
}

SluiceResult slc_http_cache_init(struct slc_http_cache *cache, const char *folder,
                                 uint64_t max_size, const SluiceAllocationCallbacks *cb,
                                 const SluiceLogCallback *log)
{
    cache->allocator = *cb;
    cache->log = *log;
    cache->max_size = max_size;
    slc_mutex_init(&cache->trimming);
    cache->folder = slc_strdup(cb, folder);
    if (!cache->folder)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = slc_cache_folder_make(folder, log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slc_folder_is_open_to_all(folder)) {
        slc_log(log, SLUICE_LOG_ERROR,
                "%s: everybody may write in this folder, and so choose the texels", folder);
        return SLUICE_ERROR_IO;
    }
    trim(cache);
    return SLUICE_SUCCESS;
}

void slc_http_cache_finish(struct slc_http_cache *cache)
{
    if (!cache->folder)
        return;
    slc_free(&cache->allocator, cache->folder, strlen(cache->folder) + 1, 1);
    cache->folder = NULL;
    slc_mutex_finish(&cache->trimming);
}

static bool write_part(const char *path, const uint8_t header[HEADER_SIZE], struct slc_http_key key,
                       const void *bytes, size_t size)
{
    int descriptor = slc_file_create(path, 0600);
    if (descriptor < 0)
        return false;
    bool is_written =
        write_all(descriptor, 0, header, HEADER_SIZE) &&
        write_all(descriptor, HEADER_SIZE, key.name, strlen(key.name)) &&
        write_all(descriptor, HEADER_SIZE + strlen(key.name), key.version, strlen(key.version)) &&
        write_all(descriptor, start_of(key), bytes, size);
    int error = errno;
    slc_file_close(descriptor);
    if (!is_written)
        slc_path_remove(path);
    errno = error;
    return is_written;
}

static void fail_write(struct slc_http_cache *cache)
{
    if (!atomic_exchange(&cache->has_failed, true))
        slc_log(&cache->log, SLUICE_LOG_WARNING,
                "%s: cannot keep what was read: %s; reading goes on without, as long as this lasts",
                cache->folder, strerror(errno));
}

void slc_http_cache_write(struct slc_http_cache *cache, struct slc_http_key key, const void *bytes,
                          size_t size)
{
    char path[4096], part[4096 + 64];
    uint8_t header[HEADER_SIZE];
    uint64_t whole = start_of(key) + size;
    if (whole > cache->max_size || !make_path(cache, key, path, sizeof path))
        return;
    snprintf(part, sizeof part, "%s-%llx-%llx-%llx" PART_SUFFIX, path,
             (unsigned long long)slc_get_process_id(), (unsigned long long)(uintptr_t)cache,
             (unsigned long long)atomic_fetch_add(&cache->turn, 1));
    make_header(header, key, bytes, size);
    if (!write_part(part, header, key, bytes, size)) {
        fail_write(cache);
        return;
    }
    if (!slc_path_replace(part, path)) {
        fail_write(cache);
        slc_path_remove(part);
        return;
    }
    atomic_store(&cache->has_failed, false);
    if (atomic_fetch_add(&cache->size, whole) + whole <= cache->max_size)
        return;
    slc_mutex_lock(&cache->trimming);
    if (atomic_load(&cache->size) > cache->max_size) /* no other thread has trimmed meanwhile */
        trim(cache);
    slc_mutex_unlock(&cache->trimming);
}
