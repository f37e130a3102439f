#define _POSIX_C_SOURCE 200809L

#include "gltf_file.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define MAX_FILE ((uint64_t)4 << 30)
#define MAX_JSON ((uint64_t)256 << 20)
#define GLB_MAGIC 0x46546C67u
#define GLB_JSON 0x4E4F534Au
#define GLB_BINARY 0x004E4942u

static const char *const kind_names[GLTF_KIND_COUNT] = {
    "buffers",  "bufferViews", "accessors", "meshes",  "nodes", "scenes",    "materials",
    "textures", "images",      "samplers",  "cameras", "skins", "animations"};

const char *gltf_kind_name(enum gltf_kind kind)
{
    return kind_names[kind];
}

bool gltf_fail(struct gltf_file *file, const char *format, ...)
{
    if (file->error[0])
        return false;
    va_list arguments;
    const int length = snprintf(file->error, sizeof file->error, "%.300s: ", file->path);
    va_start(arguments, format);
    vsnprintf(file->error + length, sizeof file->error - (size_t)length, format, arguments);
    va_end(arguments);
    return false;
}

static bool has_suffix(const char *path, const char *suffix)
{
    const size_t length = strlen(path), wanted = strlen(suffix);
    return length > wanted && strcasecmp(path + length - wanted, suffix) == 0;
}

bool gltf_is_name(const char *path)
{
    return has_suffix(path, ".gltf") || has_suffix(path, ".glb");
}

bool gltf_get_whole(struct gltf_file *file, const cJSON *object, const char *where,
                    const char *member, uint64_t least, uint64_t most, uint64_t *value)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, member);
    if (!item)
        return true;
    const double number = cJSON_GetNumberValue(item);
    if (!cJSON_IsNumber(item) || !(number >= 0) || number != floor(number))
        return gltf_fail(file, "%s.%s is no whole number", where, member);
    if (number < (double)least || number > (double)most)
        return gltf_fail(file, "%s.%s is %.0f; %llu to %llu can be", where, member, number,
                         (unsigned long long)least, (unsigned long long)most);
    *value = (uint64_t)number;
    return true;
}

bool gltf_get_index(struct gltf_file *file, const cJSON *object, const char *where,
                    const char *member, enum gltf_kind kind, uint32_t *index)
{
    uint64_t value = GLTF_NONE;
    *index = GLTF_NONE;
    if (!gltf_get_whole(file, object, where, member, 0, GLTF_NONE - 1, &value))
        return false;
    if (value != GLTF_NONE && value >= file->lists[kind].count)
        return gltf_fail(file, "%s.%s is %llu, but there are %u %s", where, member,
                         (unsigned long long)value, file->lists[kind].count, kind_names[kind]);
    *index = (uint32_t)value;
    return true;
}

static bool finite_number(const cJSON *item, float *value)
{
    const double number = cJSON_GetNumberValue(item);
    if (!cJSON_IsNumber(item) || !(fabs(number) <= 1e30))
        return false;
    *value = (float)number;
    return true;
}

bool gltf_get_floats(struct gltf_file *file, const cJSON *object, const char *where,
                     const char *member, uint32_t count, float *values)
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(object, member), *item = NULL;
    uint32_t i = 0;
    if (!array)
        return true;
    for (item = cJSON_IsArray(array) ? array->child : NULL; item && i < count; item = item->next)
        if (!finite_number(item, &values[i++]))
            return gltf_fail(file, "%s.%s[%u] is no number that can be used", where, member, i - 1);
    return (i == count && !item) ||
           gltf_fail(file, "%s.%s is no array of %u numbers", where, member, count);
}

bool gltf_get_float(struct gltf_file *file, const cJSON *object, const char *where,
                    const char *member, float *value)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, member);
    return !item || finite_number(item, value) ||
           gltf_fail(file, "%s.%s is no number that can be used", where, member);
}

static int hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

bool gltf_path(const struct gltf_file *file, const char *uri, char *path, size_t size)
{
    const char *slash = strrchr(file->path, '/');
    size_t length = 0;
    if (strstr(uri, "://") || strncmp(uri, "data:", 5) == 0 || !uri[0])
        return false;
    if (uri[0] != '/' && slash)
        length = (size_t)(slash - file->path) + 1;
    if (length >= size)
        return false;
    memcpy(path, file->path, length);
    while (*uri && length + 1 < size) {
        const int high = uri[0] == '%' ? hex_digit(uri[1]) : -1;
        const int low = high >= 0 ? hex_digit(uri[2]) : -1;
        if (low >= 0 && high * 16 + low == 0)
            return false;
        path[length++] = low >= 0 ? (char)(high * 16 + low) : *uri;
        uri += low >= 0 ? 3 : 1;
    }
    path[length] = '\0';
    return *uri == '\0';
}

static int base64_digit(char c)
{
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : c >= '0' && c <= '9' ? c - '0' + 52
           : c == '+' || c == '-' ? 62
           : c == '/' || c == '_' ? 63
                                  : -1;
}

uint8_t *gltf_decode_data_uri(const char *uri, size_t *size)
{
    const char *comma = strncmp(uri, "data:", 5) == 0 ? strchr(uri, ',') : NULL;
    if (!comma || comma - uri < 12 || strncmp(comma - 7, ";base64", 7) != 0)
        return NULL;
    const char *text = comma + 1;
    size_t length = strlen(text), done = 0;
    while (length > 0 && text[length - 1] == '=')
        length--;
    uint8_t *bytes = length % 4 == 1 ? NULL : malloc(length / 4 * 3 + 3);
    uint32_t bits = 0;
    for (size_t i = 0; bytes && i < length; i++) {
        const int digit = base64_digit(text[i]);
        if (digit < 0) {
            free(bytes);
            return NULL;
        }
        bits = bits << 6 | (uint32_t)digit;
        if (i % 4 != 0)
            bytes[done++] = (uint8_t)(bits >> (6 - 2 * (i % 4)));
    }
    *size = done;
    return bytes;
}

/* Writes `words`, and the reason of the system unless `error` is 0. Returns false. */
static bool refuse(char cause[GLTF_CAUSE_SIZE], const char *words, int error)
{
    snprintf(cause, GLTF_CAUSE_SIZE, "%s%s%s", words, error ? ": " : "",
             error ? strerror(error) : "");
    return false;
}

bool gltf_read_file(const char *path, struct gltf_bytes *bytes, char cause[GLTF_CAUSE_SIZE])
{
    struct stat about;
    *bytes = (struct gltf_bytes){0};
    if (stat(path, &about) != 0)
        return refuse(cause, "cannot be opened", errno);
    if (!S_ISREG(about.st_mode))
        return refuse(cause, "is no regular file", 0);
    if ((uint64_t)about.st_size > MAX_FILE)
        return refuse(cause, "is larger than 4 GiB", 0);
    FILE *from = fopen(path, "rb");
    if (!from)
        return refuse(cause, "cannot be opened", errno);
    errno = 0;
    bytes->owned = malloc((size_t)about.st_size + 1);
    if (bytes->owned)
        bytes->size = fread(bytes->owned, 1, (size_t)about.st_size, from);
    const int error = errno;
    fclose(from);
    bytes->bytes = bytes->owned;
    return (bytes->owned && bytes->size == (uint64_t)about.st_size) ||
           refuse(cause, "cannot be read", error);
}

static uint32_t word(const uint8_t *at)
{
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

/* Header of 12 bytes, then chunks of length, type and bytes: JSON first. */
static bool split(struct gltf_file *file, struct gltf_bytes *json)
{
    const uint8_t *bytes = file->whole.bytes;
    const uint64_t size = file->whole.size;
    *json = file->whole;
    if (size < 4 || word(bytes) != GLB_MAGIC)
        return true;
    if (size < 20 || word(bytes + 4) != 2 || word(bytes + 16) != GLB_JSON)
        return gltf_fail(file, "is no .glb of version 2");
    if (word(bytes + 8) > size || word(bytes + 12) > size - 20)
        return gltf_fail(file, "ends after %llu bytes; its header says %u",
                         (unsigned long long)size, word(bytes + 8));
    *json = (struct gltf_bytes){bytes + 20, word(bytes + 12), NULL};
    const uint64_t next = 20 + (((uint64_t)word(bytes + 12) + 3) & ~(uint64_t)3);
    if (next + 8 > size || word(bytes + next + 4) != GLB_BINARY)
        return true;
    if (word(bytes + next) > size - next - 8)
        return gltf_fail(file, "ends within its binary chunk");
    file->chunk = (struct gltf_bytes){bytes + next + 8, word(bytes + next), NULL};
    return true;
}

/* Lists the items of a kind, since cJSON links them and indices need numbers. */
static bool list(struct gltf_file *file, enum gltf_kind kind)
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(file->json, kind_names[kind]);
    struct gltf_list *to = &file->lists[kind];
    if (!array)
        return true;
    if (!cJSON_IsArray(array))
        return gltf_fail(file, "%s is no array", kind_names[kind]);
    const int count = cJSON_GetArraySize(array);
    if (count < 0 || (uint32_t)count > GLTF_MAX_ITEMS)
        return gltf_fail(file, "has %d %s; %u can be", count, kind_names[kind], GLTF_MAX_ITEMS);
    to->items = calloc((size_t)count + 1, sizeof(cJSON *));
    for (cJSON *item = to->items ? array->child : NULL; item; item = item->next) {
        if (!cJSON_IsObject(item))
            return gltf_fail(file, "%s[%u] is no object", kind_names[kind], to->count);
        to->items[to->count++] = item;
    }
    return to->items || gltf_fail(file, "out of memory");
}

static bool open_whole(struct gltf_file *file)
{
    struct gltf_bytes json;
    if (!split(file, &json))
        return false;
    if (json.size == 0 || json.size > MAX_JSON)
        return gltf_fail(file, "has %llu bytes of JSON; 1 to %llu can be",
                         (unsigned long long)json.size, (unsigned long long)MAX_JSON);
    file->json = cJSON_ParseWithLength((const char *)json.bytes, (size_t)json.size);
    if (!cJSON_IsObject(file->json))
        return gltf_fail(file, "is not valid JSON");
    for (int kind = 0; kind < GLTF_KIND_COUNT; kind++)
        if (!list(file, (enum gltf_kind)kind))
            return false;
    file->buffers = calloc(file->lists[GLTF_BUFFERS].count + 1u, sizeof *file->buffers);
    return file->buffers ? gltf_check(file) : gltf_fail(file, "out of memory");
}

bool gltf_open(const char *path, struct gltf_file *file)
{
    char cause[GLTF_CAUSE_SIZE];
    *file = (struct gltf_file){.path = path};
    return gltf_read_file(path, &file->whole, cause) ? open_whole(file)
                                                     : gltf_fail(file, "%s", cause);
}

bool gltf_open_bytes(const char *path, const void *bytes, size_t size, struct gltf_file *file)
{
    *file = (struct gltf_file){.path = path};
    file->whole.bytes = file->whole.owned = malloc(size + 1);
    if (!file->whole.owned)
        return gltf_fail(file, "out of memory");
    if (size)
        memcpy(file->whole.owned, bytes, size);
    file->whole.size = size;
    return open_whole(file);
}

void gltf_finish(struct gltf_file *file)
{
    for (uint32_t i = 0; file->buffers && i < file->lists[GLTF_BUFFERS].count; i++)
        free(file->buffers[i].owned);
    for (int kind = 0; kind < GLTF_KIND_COUNT; kind++)
        free(file->lists[kind].items);
    free(file->buffers);
    free(file->whole.owned);
    cJSON_Delete(file->json);
    *file = (struct gltf_file){.path = file->path};
}
