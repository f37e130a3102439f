#include "pbrt/bounds_file.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/part_file.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define MAGIC "sluice-pbrt-1"

/* Record before each path, in the machine's byte order: the cache is for this machine only. */
struct record {
    uint64_t size, path_hash;
    int64_t seconds, nanoseconds;
    float bounds[6];
    uint32_t path_length, check;
};

static uint32_t check_of(const struct record *record, const char *path)
{
    struct record bare = *record;
    bare.check = 0;
    return (uint32_t)(slc_pbrt_hash(&bare, sizeof bare) ^ slc_pbrt_hash(path, record->path_length));
}

static uint32_t order_of(const char *path)
{
    return (uint32_t)slc_pbrt_hash(path, strlen(path));
}

/* Makes a hash table of paths: [size] numbers of PLY files or NONE. */
static uint32_t *make_table(const SluicePbrtScene *scene, size_t *size)
{
    for (*size = 16; *size < 2 * scene->ply_count;)
        *size *= 2;
    uint32_t *table = slc_alloc(&scene->allocator, *size, sizeof *table);
    if (!table)
        return NULL;
    memset(table, 0xFF, *size * sizeof *table);
    for (size_t i = 0; i < scene->ply_count; i++) {
        size_t place = order_of(slc_pbrt_name(&scene->names, scene->plys[i].path)) & (*size - 1);
        while (table[place] != SLUICE_PBRT_NONE)
            place = (place + 1) & (*size - 1);
        table[place] = (uint32_t)i;
    }
    return table;
}

static void take(SluicePbrtScene *scene, const uint32_t *table, size_t size,
                 const struct record *record, const char *path)
{
    size_t place = order_of(path) & (size - 1);
    for (; table[place] != SLUICE_PBRT_NONE; place = (place + 1) & (size - 1)) {
        struct slc_pbrt_ply_entry *ply = &scene->plys[table[place]];
        struct slc_pbrt_stamp stamp;
        if (strcmp(slc_pbrt_name(&scene->names, ply->path), path) != 0)
            continue;
        if (slc_pbrt_stamp_of(path, &stamp) && stamp.size == record->size &&
            stamp.seconds == record->seconds && stamp.nanoseconds == record->nanoseconds) {
            ply->state = SLC_PBRT_PLY_KNOWN;
            ply->stamp = stamp;
            memcpy(ply->bounds.least, record->bounds, 3 * sizeof(float));
            memcpy(ply->bounds.most, record->bounds + 3, 3 * sizeof(float));
        }
        return;
    }
}

static bool is_sound(const struct record *record, const char *path)
{
    for (int i = 0; i < 3; i++)
        if (!(fabsf(record->bounds[i]) <= FLT_MAX) || !(fabsf(record->bounds[3 + i]) <= FLT_MAX) ||
            record->bounds[i] > record->bounds[3 + i])
            return false;
    return record->check == check_of(record, path);
}

SluiceResult slc_pbrt_read_bounds_file(SluicePbrtScene *scene, const char *path)
{
    struct slc_pbrt_window window;
    struct record record;
    char magic[sizeof MAGIC], name[4096];
    size_t size;
    SluiceResult result = slc_pbrt_window_open(&window, path, &scene->allocator);
    if (result != SLUICE_SUCCESS)
        return result == SLUICE_ERROR_OUT_OF_HOST_MEMORY ? result : SLUICE_SUCCESS;
    uint32_t *table = make_table(scene, &size);
    bool ok = table && slc_pbrt_window_take(&window, magic, sizeof magic) &&
              memcmp(magic, MAGIC, sizeof magic) == 0;
    while (ok && slc_pbrt_window_take(&window, &record, sizeof record)) {
        ok = record.path_length < sizeof name &&
             slc_pbrt_window_take(&window, name, record.path_length);
        name[ok ? record.path_length : 0] = 0;
        ok = ok && is_sound(&record, name);
        if (ok)
            take(scene, table, size, &record, name);
    }
    slc_free(&scene->allocator, table, size, sizeof *table);
    slc_pbrt_window_finish(&window);
    return table ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static SluiceResult write_record(const SluicePbrtScene *scene, struct slc_part_file *part,
                                 const struct slc_pbrt_ply_entry *ply)
{
    const char *path = slc_pbrt_name(&scene->names, ply->path);
    struct record record;
    memset(&record, 0, sizeof record);
    record.size = ply->stamp.size;
    record.path_hash = slc_pbrt_hash(path, strlen(path));
    record.seconds = ply->stamp.seconds;
    record.nanoseconds = ply->stamp.nanoseconds;
    memcpy(record.bounds, ply->bounds.least, 3 * sizeof(float));
    memcpy(record.bounds + 3, ply->bounds.most, 3 * sizeof(float));
    record.path_length = (uint32_t)strlen(path);
    record.check = check_of(&record, path);
    SluiceResult result = slc_part_file_append(part, &record, sizeof record);
    return result == SLUICE_SUCCESS ? slc_part_file_append(part, path, record.path_length) : result;
}

SluiceResult sluiceWritePbrtBounds(SluicePbrtScene *scene, const char *pPath)
{
    struct slc_part_file part = {0};
    if (!scene || !pPath)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_part_file_open(&part, pPath, SLC_PART_FILE_UNSYNCED,
                                             &scene->allocator, &scene->limits.log);
    if (result == SLUICE_SUCCESS)
        result = slc_part_file_append(&part, MAGIC, sizeof MAGIC);
    for (size_t i = 0; result == SLUICE_SUCCESS && i < scene->ply_count; i++)
        if (scene->plys[i].state == SLC_PBRT_PLY_KNOWN)
            result = write_record(scene, &part, &scene->plys[i]);
    if (result != SLUICE_SUCCESS) {
        slc_part_file_finish(&part, false);
        return result;
    }
    return slc_part_file_finish(&part, true);
}
