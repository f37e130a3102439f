/** A checked glTF file: JSON and buffers. Every index is valid, every accessor lies within its
 *  buffer, and nodes form trees. Files are not trusted. */
#ifndef SLUICE_VIEW_GLTF_FILE_H
#define SLUICE_VIEW_GLTF_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cjson/cJSON.h>

#define GLTF_NONE UINT32_MAX
#define GLTF_MAX_ITEMS (1u << 20)
#define GLTF_MAX_DEPTH 256u

enum gltf_kind {
    GLTF_BUFFERS,
    GLTF_BUFFER_VIEWS,
    GLTF_ACCESSORS,
    GLTF_MESHES,
    GLTF_NODES,
    GLTF_SCENES,
    GLTF_MATERIALS,
    GLTF_TEXTURES,
    GLTF_IMAGES,
    GLTF_SAMPLERS,
    GLTF_CAMERAS,
    GLTF_SKINS,
    GLTF_ANIMATIONS,
    GLTF_KIND_COUNT
};

struct gltf_bytes {
    const uint8_t *bytes;
    uint64_t size;
    uint8_t *owned; ///< NULL: the bytes belong to the .glb
};

struct gltf_file {
    const char *path; ///< borrowed
    cJSON *json;
    struct gltf_list {
        cJSON **items;
        uint32_t count;
    } lists[GLTF_KIND_COUNT];
    struct gltf_bytes *buffers; ///< one per item of GLTF_BUFFERS
    struct gltf_bytes whole;    ///< the file
    struct gltf_bytes chunk;    ///< binary chunk of a .glb; no bytes: none
    uint64_t animated_count;    ///< numbers of animations that were checked
    char error[512];            ///< file and cause, after a failure
};

/** Returns true if the name ends in .gltf or .glb. */
bool gltf_is_name(const char *path);
/** Reads and checks the file and its buffers. On failure `error` has the cause. Always call
 *  gltf_finish. */
bool gltf_open(const char *path, struct gltf_file *file);
/** Opens a copy of `bytes` as the contents of the file at `path`. */
bool gltf_open_bytes(const char *path, const void *bytes, size_t size, struct gltf_file *file);
void gltf_finish(struct gltf_file *file);

/** Writes `error`, unless it has a text already. Returns false. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
bool
gltf_fail(struct gltf_file *file, const char *format, ...);
const char *gltf_kind_name(enum gltf_kind kind);

/** Reads a member that is a whole number from `least` to `most`. Absent: `*value` stays. */
bool gltf_get_whole(struct gltf_file *file, const cJSON *object, const char *where,
                    const char *member, uint64_t least, uint64_t most, uint64_t *value);
/** Reads a member that is the index of an item. Absent: GLTF_NONE. */
bool gltf_get_index(struct gltf_file *file, const cJSON *object, const char *where,
                    const char *member, enum gltf_kind kind, uint32_t *index);
/** Reads an array member of exactly `count` finite numbers. Absent: `values` stay. */
bool gltf_get_floats(struct gltf_file *file, const cJSON *object, const char *where,
                     const char *member, uint32_t count, float *values);
/** Reads a member that is a finite number. Absent: `*value` stays. */
bool gltf_get_float(struct gltf_file *file, const cJSON *object, const char *where,
                    const char *member, float *value);

/** Writes the path of a URI relative to the file, with %-escapes decoded. False if the URI is not a
 *  path or too long. */
bool gltf_path(const struct gltf_file *file, const char *uri, char *path, size_t size);
/** Decodes "data:...;base64,...". NULL for other or damaged URIs, and without memory. */
uint8_t *gltf_decode_data_uri(const char *uri, size_t *size);
#define GLTF_CAUSE_SIZE 160
/** Reads a regular file of at most 4 GiB. On failure `cause` has the cause. */
bool gltf_read_file(const char *path, struct gltf_bytes *bytes, char cause[GLTF_CAUSE_SIZE]);
/** Checks all items, as part of gltf_open. */
bool gltf_check(struct gltf_file *file);
/** Returns the bytes of a checked buffer view. */
struct gltf_bytes gltf_view_bytes(const struct gltf_file *file, uint32_t view);

#endif /* SLUICE_VIEW_GLTF_FILE_H */
