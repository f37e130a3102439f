/** Parsed scene in memory, and its messages. */
#ifndef SLC_PBRT_PARSED_SCENE_H
#define SLC_PBRT_PARSED_SCENE_H

#include <sluice/pbrt.h>

#include "pbrt/affine.h"
#include "pbrt/byte_window.h"
#include "pbrt/names.h"

#define SLC_PBRT_MAX_MESSAGES 1000u

struct slc_pbrt_place {
    uint32_t file, line, column; ///< file: in slc_pbrt_files
};

struct slc_pbrt_file {
    uint32_t path; ///< in names
    struct slc_pbrt_stamp stamp;
};

/** Material. Equal materials share an entry. */
struct slc_pbrt_material_entry {
    SluicePbrtMaterial material; ///< pType is NULL
    uint32_t type;               ///< in names
    uint32_t next;               ///< next with the same hash, or SLUICE_PBRT_NONE
};

struct slc_pbrt_texture_entry {
    SluicePbrtTexture texture; ///< strings are NULL
    uint32_t name, image;      ///< in names; image may be SLUICE_PBRT_NONE
    uint32_t depth;            ///< nesting of input textures; 0: no inputs
    struct slc_pbrt_place place;
};

struct slc_pbrt_light_entry {
    SluicePbrtLight light; ///< strings are NULL
    uint32_t image;        ///< in names, or SLUICE_PBRT_NONE
    struct slc_pbrt_place place;
};

/** Position in a file of a shape's numbers. */
struct slc_pbrt_span {
    uint64_t offset;
    uint32_t file;
    uint32_t count; ///< numbers; 0: none
};

enum slc_pbrt_span_kind {
    SLC_PBRT_SPAN_POSITIONS,
    SLC_PBRT_SPAN_INDICES,
    SLC_PBRT_SPAN_NORMALS,
    SLC_PBRT_SPAN_UVS,
    SLC_PBRT_SPAN_COUNT
};

struct slc_pbrt_shape_entry {
    SluicePbrtShapeKind kind;
    bool reverse_orientation;
    struct slc_pbrt_place place;
    uint32_t object, material, area_light;
    SluicePbrtValue alpha;
    float transform[12];
    union {
        struct {
            uint32_t ply; ///< in plys
        } file;
        struct {
            float radius, inner_radius, z_min, z_max, phi_max;
        } quadric;
        struct {
            uint32_t spans; ///< first of SLC_PBRT_SPAN_COUNT in `spans`
            uint32_t levels;
            SluicePbrtBounds bounds; ///< after the transform
        } mesh;
    } data;
};

enum slc_pbrt_ply_state { SLC_PBRT_PLY_UNREAD, SLC_PBRT_PLY_KNOWN, SLC_PBRT_PLY_FAILED };

struct slc_pbrt_ply_entry {
    uint32_t path; ///< in names
    enum slc_pbrt_ply_state state;
    SluiceResult failure;
    struct slc_pbrt_stamp stamp; ///< KNOWN
    SluicePbrtBounds bounds;     ///< KNOWN
};

struct slc_pbrt_object_entry {
    uint32_t name, first_shape, shape_count;
};

struct SluicePbrtScene {
    SluiceAllocationCallbacks allocator;
    SluicePbrtSceneCreateInfo limits; ///< pointers are NULL; defaults filled in
    SluicePbrtSceneInfo info;
    uint32_t message_count;
    struct slc_pbrt_names names;
    uint32_t folder; ///< in names: folder of the first file, with the slash; may be ""
    /* All owned. */
    struct slc_pbrt_file *files;
    struct slc_pbrt_material_entry *materials;
    struct slc_pbrt_texture_entry *textures;
    struct slc_pbrt_light_entry *lights;
    struct slc_pbrt_shape_entry *shapes;
    struct slc_pbrt_span *spans;
    struct slc_pbrt_ply_entry *plys;
    struct slc_pbrt_object_entry *objects;
    SluicePbrtInstance *instances;
    size_t file_count, material_count, texture_count, light_count, shape_count, span_count,
        ply_count, object_count, instance_count;
    size_t file_capacity, material_capacity, texture_capacity, light_capacity, shape_capacity,
        span_capacity, ply_capacity, object_capacity, instance_capacity;
};

/** Logs "FILE:LINE:COLUMN: TEXT" and counts it. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
void slc_pbrt_say(SluicePbrtScene *scene, SluiceLogSeverity severity,
                  const struct slc_pbrt_place *place, const char *format, ...);

/** Logs a warning in calls that take a const scene: counts nothing. */
void slc_pbrt_warn(const SluicePbrtScene *scene, const struct slc_pbrt_place *place,
                   const char *text);

/** Logs an error in calls that take a const scene: counts nothing. Returns `result`. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
SluiceResult
slc_pbrt_fail(const SluicePbrtScene *scene, SluiceResult result, const struct slc_pbrt_place *place,
              const char *format, ...);

/** Returns the words that messages use for a file that could not be read. */
const char *slc_pbrt_failure_text(SluiceResult result);

/** Reads the text of the first file into the scene. */
SluiceResult slc_pbrt_parse(SluicePbrtScene *scene, const char *path);

#endif /* SLC_PBRT_PARSED_SCENE_H */
