#include "pbrt/parser.h"

#include "pbrt/growth.h"

#include <string.h>

/* Limit to bound memory; enough for all known scenes. */
#define MAX_ATTRIBUTE_PARAMETERS 256u
#define MAX_ATTRIBUTE_CELLS 4096u

static const char *const BEGINNINGS[] = {"AttributeBegin", "TransformBegin", "ObjectBegin",
                                         "Import"};
static const char *const ENDINGS[] = {"AttributeEnd", "TransformEnd", "ObjectEnd", "its end"};

bool slc_pbrt_push_block(struct slc_pbrt_parser *parser, enum slc_pbrt_block_kind kind,
                         const struct slc_pbrt_place *place)
{
    SluicePbrtScene *scene = parser->scene;
    if (parser->block_count >= scene->limits.maxBlockDepth)
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, place,
                             "%u blocks lie in one another: maxBlockDepth",
                             (unsigned)parser->block_count);
    if (!slc_pbrt_grow(&scene->allocator, &parser->blocks, &parser->block_capacity,
                       parser->block_count + 1, sizeof *parser->blocks))
        return slc_pbrt_out_of_memory(parser);
    parser->blocks[parser->block_count++] = (struct slc_pbrt_block){
        kind, *place, parser->state, parser->undo_count, parser->attribute_count};
    return true;
}

static void pop_block(struct slc_pbrt_parser *parser)
{
    const struct slc_pbrt_block *block = &parser->blocks[--parser->block_count];
    if (parser->object != SLUICE_PBRT_NONE && parser->object_block == parser->block_count) {
        struct slc_pbrt_object_entry *object = &parser->scene->objects[parser->object];
        object->shape_count = (uint32_t)parser->scene->shape_count - object->first_shape;
        parser->object = SLUICE_PBRT_NONE;
    }
    if (block->kind == SLC_PBRT_TRANSFORM_BLOCK) {
        parser->state.transform = block->state.transform;
        return;
    }
    parser->state = block->state;
    while (parser->undo_count > block->undo_count) {
        const struct slc_pbrt_undo *undo = &parser->undos[--parser->undo_count];
        parser->meanings[undo->name].here[undo->meaning] = undo->index;
    }
    while (parser->attribute_count > block->attribute_count)
        slc_pbrt_parameters_finish(&parser->attributes[--parser->attribute_count].parameters);
}

void slc_pbrt_close_blocks(struct slc_pbrt_parser *parser, size_t count)
{
    while (parser->block_count > count) {
        const struct slc_pbrt_block *block = &parser->blocks[parser->block_count - 1];
        if (block->kind != SLC_PBRT_IMPORT_BLOCK)
            slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, &block->place,
                         "%s without %s is ended here", BEGINNINGS[block->kind],
                         ENDINGS[block->kind]);
        pop_block(parser);
    }
}

/* Returns the number of blocks that the file may not end: of importing files, and its own. */
static size_t lowest_block(const struct slc_pbrt_parser *parser)
{
    for (size_t i = parser->frame_count; i-- > 0;)
        if (parser->frames[i].is_import)
            return parser->frames[i].block_count + 1;
    return 0;
}

static bool end_block(struct slc_pbrt_parser *parser, enum slc_pbrt_block_kind kind,
                      const struct slc_pbrt_place *place)
{
    enum slc_pbrt_block_kind top = parser->block_count > lowest_block(parser)
                                       ? parser->blocks[parser->block_count - 1].kind
                                       : SLC_PBRT_IMPORT_BLOCK;
    if (top == SLC_PBRT_IMPORT_BLOCK || (top == SLC_PBRT_OBJECT_BLOCK && kind != top)) {
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place, "%s without %s is ignored",
                     ENDINGS[kind], BEGINNINGS[kind]);
        return true;
    }
    if (top != kind)
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place, "%s ends the %s of line %u",
                     ENDINGS[kind], BEGINNINGS[top],
                     parser->blocks[parser->block_count - 1].place.line);
    pop_block(parser);
    return true;
}

bool slc_pbrt_attribute_begin(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    return slc_pbrt_push_block(parser, SLC_PBRT_ATTRIBUTE_BLOCK, place);
}

bool slc_pbrt_attribute_end(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    return end_block(parser, SLC_PBRT_ATTRIBUTE_BLOCK, place);
}

bool slc_pbrt_transform_begin(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    return slc_pbrt_push_block(parser, SLC_PBRT_TRANSFORM_BLOCK, place);
}

bool slc_pbrt_transform_end(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    return end_block(parser, SLC_PBRT_TRANSFORM_BLOCK, place);
}

bool slc_pbrt_object_begin(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    SluicePbrtScene *scene = parser->scene;
    uint32_t name;
    bool found;
    if (!slc_pbrt_read_name(parser, "name of the object", &name, &found) ||
        !slc_pbrt_push_block(parser, SLC_PBRT_OBJECT_BLOCK, place))
        return false;
    if (!found)
        return true;
    if (parser->object != SLUICE_PBRT_NONE) {
        slc_pbrt_say(scene, SLUICE_LOG_ERROR, place,
                     "an object in an object: its shapes become part of the outer one");
        return true;
    }
    if (!slc_pbrt_grow(&scene->allocator, &scene->objects, &scene->object_capacity,
                       scene->object_count + 1, sizeof *scene->objects))
        return slc_pbrt_out_of_memory(parser);
    struct slc_pbrt_meanings *meanings = slc_pbrt_meanings_of(parser, name);
    if (!meanings)
        return false;
    parser->object = meanings->last[SLC_PBRT_OBJECT] = (uint32_t)scene->object_count;
    parser->object_block = parser->block_count - 1;
    scene->objects[scene->object_count++] =
        (struct slc_pbrt_object_entry){name, (uint32_t)scene->shape_count, 0};
    return true;
}

bool slc_pbrt_object_end(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    size_t lowest = lowest_block(parser), i = parser->block_count;
    while (i > lowest && parser->blocks[i - 1].kind != SLC_PBRT_OBJECT_BLOCK)
        i--;
    if (i > lowest)
        slc_pbrt_close_blocks(parser, i);
    return end_block(parser, SLC_PBRT_OBJECT_BLOCK, place);
}

bool slc_pbrt_object_instance(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    SluicePbrtScene *scene = parser->scene;
    uint32_t name, object;
    bool found;
    if (!slc_pbrt_read_name(parser, "name of the object", &name, &found) || !found)
        return parser->result == SLUICE_SUCCESS;
    if (!slc_pbrt_look_up(parser, name, SLC_PBRT_OBJECT, &object))
        return false;
    const char *trouble = NULL;
    if (parser->object != SLUICE_PBRT_NONE)
        trouble = "instances inside of objects are no part of the format";
    else if (object == SLUICE_PBRT_NONE)
        trouble = "no object has this name";
    if (trouble) {
        slc_pbrt_say(scene, SLUICE_LOG_ERROR, place, "\"%s\": %s; left out",
                     slc_pbrt_name(&scene->names, name), trouble);
        return true;
    }
    if (scene->instance_count >= scene->limits.maxInstanceCount)
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, place,
                             "%zu instances: maxInstanceCount", scene->instance_count);
    if (!slc_pbrt_grow(&scene->allocator, &scene->instances, &scene->instance_capacity,
                       scene->instance_count + 1, sizeof *scene->instances))
        return slc_pbrt_out_of_memory(parser);
    SluicePbrtInstance *instance = &scene->instances[scene->instance_count++];
    instance->object = object;
    slc_pbrt_to_floats(&parser->state.transform, instance->transform);
    return true;
}

bool slc_pbrt_reverse_orientation(struct slc_pbrt_parser *parser,
                                  const struct slc_pbrt_place *place)
{
    (void)place;
    parser->state.reverse_orientation = !parser->state.reverse_orientation;
    return true;
}

/* Makes this block's own parameters, once: a copy of the outer block's parameters. */
static bool own_attribute(struct slc_pbrt_parser *parser, uint32_t *of_state)
{
    size_t first =
        parser->block_count ? parser->blocks[parser->block_count - 1].attribute_count : 0;
    if (*of_state != SLUICE_PBRT_NONE && *of_state >= first)
        return true;
    if (!slc_pbrt_grow(&parser->scene->allocator, &parser->attributes, &parser->attribute_capacity,
                       parser->attribute_count + 1, sizeof *parser->attributes))
        return slc_pbrt_out_of_memory(parser);
    struct slc_pbrt_parameters *own = &parser->attributes[parser->attribute_count++].parameters;
    *own = (struct slc_pbrt_parameters){.allocator = parser->scene->allocator};
    if (*of_state != SLUICE_PBRT_NONE &&
        !slc_pbrt_prepend(own, &parser->attributes[*of_state].parameters))
        return slc_pbrt_out_of_memory(parser);
    *of_state = (uint32_t)parser->attribute_count - 1;
    return true;
}

bool slc_pbrt_attribute_directive(struct slc_pbrt_parser *parser,
                                  const struct slc_pbrt_place *place)
{
    static const char *const TARGETS[] = {"shape", "light", "material", "texture"};
    uint32_t name;
    bool found;
    if (!slc_pbrt_read_name(parser, "kind of directive", &name, &found) ||
        !slc_pbrt_read_parameters(parser))
        return false;
    for (int i = 0; found && i < SLC_PBRT_TARGET_COUNT; i++) {
        if (strcmp(slc_pbrt_name(&parser->scene->names, name), TARGETS[i]) != 0)
            continue;
        if (!own_attribute(parser, &parser->state.attributes[i]))
            return false;
        /* Later parameters have precedence, so new ones are appended. */
        struct slc_pbrt_parameters *own =
            &parser->attributes[parser->state.attributes[i]].parameters;
        if (own->count + parser->parameters.count > MAX_ATTRIBUTE_PARAMETERS ||
            own->cell_count + parser->parameters.cell_count > MAX_ATTRIBUTE_CELLS) {
            slc_pbrt_say(parser->scene, SLUICE_LOG_ERROR, place,
                         "too many parameters for Attribute: they are ignored");
            return true;
        }
        struct slc_pbrt_parameters old = *own;
        *own = parser->parameters;
        bool ok = slc_pbrt_prepend(own, &old);
        parser->parameters = old;
        return ok || slc_pbrt_out_of_memory(parser);
    }
    return true;
}
