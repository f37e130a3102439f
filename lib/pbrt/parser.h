/**
 * Parser: reads the text of a scene, one directive at a time. Blocks and included files have their
 * own stacks, so the input cannot cause deep recursion.
 */
#ifndef SLC_PBRT_PARSER_H
#define SLC_PBRT_PARSER_H

#include "pbrt/lexer.h"
#include "pbrt/parameters.h"

enum slc_pbrt_target {
    SLC_PBRT_TARGET_SHAPE,
    SLC_PBRT_TARGET_LIGHT,
    SLC_PBRT_TARGET_MATERIAL,
    SLC_PBRT_TARGET_TEXTURE,
    SLC_PBRT_TARGET_COUNT
};

/** State that AttributeBegin saves and AttributeEnd restores. */
struct slc_pbrt_state {
    struct slc_pbrt_affine transform;
    uint32_t material;
    uint32_t area_light;
    bool reverse_orientation;
    uint32_t attributes[SLC_PBRT_TARGET_COUNT]; ///< in slc_pbrt_parser::attributes, or NONE
};

/** Parameters that an Attribute gives to all directives of a kind. */
struct slc_pbrt_attribute {
    struct slc_pbrt_parameters parameters; ///< includes parameters of outer blocks
};

enum slc_pbrt_block_kind {
    SLC_PBRT_ATTRIBUTE_BLOCK,
    SLC_PBRT_TRANSFORM_BLOCK,
    SLC_PBRT_OBJECT_BLOCK,
    SLC_PBRT_IMPORT_BLOCK
};

struct slc_pbrt_block {
    enum slc_pbrt_block_kind kind;
    struct slc_pbrt_place place;
    struct slc_pbrt_state state;
    size_t undo_count, attribute_count;
};

/** File in reading. */
struct slc_pbrt_frame {
    struct slc_pbrt_lexer lexer;
    uint32_t file;
    bool is_import;
    size_t block_count; ///< open blocks before the file; an import has its own block
};

/** Kind of a named object. */
enum slc_pbrt_meaning {
    SLC_PBRT_FLOAT_TEXTURE,
    SLC_PBRT_COLOR_TEXTURE,
    SLC_PBRT_NAMED_MATERIAL,
    SLC_PBRT_OBJECT,
    SLC_PBRT_COORDINATES,
    SLC_PBRT_PLY_PATH,
    SLC_PBRT_SAID,
    SLC_PBRT_MEANING_COUNT
};

struct slc_pbrt_meanings {
    uint32_t here[SLC_PBRT_MEANING_COUNT]; ///< meaning in this block and outer blocks
    uint32_t last[SLC_PBRT_MEANING_COUNT]; ///< last meaning in the file
};

struct slc_pbrt_undo {
    uint32_t name;
    enum slc_pbrt_meaning meaning;
    uint32_t index; ///< before
};

/** Forward reference to a named material. */
struct slc_pbrt_forward {
    uint32_t material; ///< placeholder
    uint32_t instead;  ///< replacement if the material is never defined
    uint32_t name;
    struct slc_pbrt_place place;
};

struct slc_pbrt_parser {
    SluicePbrtScene *scene;
    SluiceResult result; ///< reason why the parser stops
    struct slc_pbrt_watch watch;
    bool in_world, after_world, has_world_end;
    bool has_token; ///< `token` must be read again
    bool ignores_transforms;
    bool said_comma, said_mirror;
    uint32_t object;     ///< object in definition, or NONE
    size_t object_block; ///< block of `object`
    uint32_t include_count;
    uint32_t default_material;
    struct slc_pbrt_token token;
    struct slc_pbrt_state state;
    struct slc_pbrt_parameters parameters; ///< parameters of the directive
    struct slc_pbrt_parameters camera;     ///< parameters of the Camera
    struct slc_pbrt_place camera_place;
    struct slc_pbrt_affine camera_to_world;
    /* Owned. */
    struct slc_pbrt_frame *frames;
    struct slc_pbrt_block *blocks;
    struct slc_pbrt_meanings *meanings; ///< [names]
    struct slc_pbrt_undo *undos;
    struct slc_pbrt_forward *forwards;
    struct slc_pbrt_affine *coordinates;
    struct slc_pbrt_attribute *attributes;
    uint32_t *material_table; ///< first material of each hash, or NONE
    size_t frame_count, block_count, meaning_count, undo_count, forward_count, coordinate_count,
        attribute_count, material_table_size;
    size_t frame_capacity, block_capacity, meaning_capacity, undo_capacity, forward_capacity,
        coordinate_capacity, attribute_capacity;
};

/* Parser functions. False stops the parser, and `result` is the reason. */

/** Stops the parser with an error. Returns false. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
bool slc_pbrt_stop(struct slc_pbrt_parser *parser, SluiceResult result,
                   const struct slc_pbrt_place *place, const char *format, ...);
bool slc_pbrt_out_of_memory(struct slc_pbrt_parser *parser);

/** Reads the next token, across ends of included files. */
bool slc_pbrt_take_token(struct slc_pbrt_parser *parser);
struct slc_pbrt_place slc_pbrt_token_place(const struct slc_pbrt_token *token);
struct slc_pbrt_lexer *slc_pbrt_top_lexer(struct slc_pbrt_parser *parser);
/** Closes ended included files. False: an import or the scene has ended. */
bool slc_pbrt_leave_file(struct slc_pbrt_parser *parser);
/** Continues in another file. Logs and continues if the file cannot be read. */
bool slc_pbrt_enter_file(struct slc_pbrt_parser *parser, const char *name, bool is_import,
                         const struct slc_pbrt_place *place);

bool slc_pbrt_read_parameters(struct slc_pbrt_parser *parser);
/** Reads the parameters of a directive, and puts parameters of Attribute before them. */
bool slc_pbrt_read_parameters_for(struct slc_pbrt_parser *parser, enum slc_pbrt_target target);
/** Reads `count` numbers, with or without brackets. */
bool slc_read_numbers(struct slc_pbrt_parser *parser, double *numbers, int count,
                      const struct slc_pbrt_place *place);
/** Reads a quoted string, if present: *found. */
bool slc_pbrt_read_name(struct slc_pbrt_parser *parser, const char *what, uint32_t *name,
                        bool *found);

/* Names. */

bool slc_pbrt_intern(struct slc_pbrt_parser *parser, const char *string, uint32_t *name);
/** Returns the meanings of a name, valid until the next call. NULL: out of memory. */
struct slc_pbrt_meanings *slc_pbrt_meanings_of(struct slc_pbrt_parser *parser, uint32_t name);
/** Gives a name a meaning until the block ends, and in the file if no block gives it one. */
bool slc_pbrt_define(struct slc_pbrt_parser *parser, uint32_t name, enum slc_pbrt_meaning meaning,
                     uint32_t index);
/** Finds the index of a name, or NONE. */
bool slc_pbrt_look_up(struct slc_pbrt_parser *parser, uint32_t name, enum slc_pbrt_meaning meaning,
                      uint32_t *index);
/** Adds a path to names, relative to the folder of the first file. */
bool slc_pbrt_intern_path(struct slc_pbrt_parser *parser, const char *path, uint32_t *name);
/** Warns, once for each key. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
bool slc_pbrt_warn_once(struct slc_pbrt_parser *parser, const char *key,
                        const struct slc_pbrt_place *place, const char *format, ...);

/* Directives, by file. */

typedef bool slc_pbrt_directive(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place);
bool slc_pbrt_read_directive(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place);

slc_pbrt_directive slc_pbrt_identity_directive, slc_pbrt_translate, slc_pbrt_scale, slc_pbrt_rotate,
    slc_pbrt_look_at_directive, slc_pbrt_transform, slc_pbrt_concat_transform,
    slc_pbrt_coordinate_system, slc_pbrt_coord_sys_transform, slc_pbrt_active_transform,
    slc_pbrt_transform_times;
slc_pbrt_directive slc_pbrt_attribute_begin, slc_pbrt_attribute_end, slc_pbrt_transform_begin,
    slc_pbrt_transform_end, slc_pbrt_object_begin, slc_pbrt_object_end, slc_pbrt_object_instance,
    slc_pbrt_reverse_orientation, slc_pbrt_attribute_directive;
slc_pbrt_directive slc_pbrt_camera, slc_pbrt_film, slc_pbrt_texture, slc_pbrt_material,
    slc_pbrt_make_named_material, slc_pbrt_named_material, slc_pbrt_light_source,
    slc_pbrt_area_light_source, slc_pbrt_shape;

bool slc_pbrt_push_block(struct slc_pbrt_parser *parser, enum slc_pbrt_block_kind kind,
                         const struct slc_pbrt_place *place);
/** Ends blocks that are open, with a warning for each, down to `count`. */
void slc_pbrt_close_blocks(struct slc_pbrt_parser *parser, size_t count);
/** Computes the camera once the film is known. */
void slc_pbrt_finish_camera(struct slc_pbrt_parser *parser);
/** Resolves forward references to named materials. */
bool slc_pbrt_finish_materials(struct slc_pbrt_parser *parser);
/** Adds the material "matte" with defaults. */
bool slc_pbrt_add_default_material(struct slc_pbrt_parser *parser);
/** Overrides parameters of `base` by the shape's. Without such parameters, *material is `base`. */
bool slc_pbrt_override_material(struct slc_pbrt_parser *parser, uint32_t base, uint32_t *material);

/**
 * Reads a float or color parameter, constant or texture. If missing, *found is false and `value`
 * unchanged. An unknown texture logs a warning and counts as missing.
 */
bool slc_pbrt_read_value(struct slc_pbrt_parser *parser, const char *name, bool is_float,
                         SluicePbrtValue *value, bool *found);
/** Reads a color as RGB. False: missing. Spectra may log warnings. */
bool slc_pbrt_read_color(struct slc_pbrt_parser *parser, const char *name, float rgb[3],
                         bool is_light);

#endif /* SLC_PBRT_PARSER_H */
