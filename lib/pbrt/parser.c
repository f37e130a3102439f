#include "pbrt/parser.h"

#include "pbrt/growth.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool slc_pbrt_stop(struct slc_pbrt_parser *parser, SluiceResult result,
                   const struct slc_pbrt_place *place, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    parser->scene->info.errorCount++;
    parser->result = slc_pbrt_fail(parser->scene, result, place, "%s", text);
    return false;
}

bool slc_pbrt_out_of_memory(struct slc_pbrt_parser *parser)
{
    parser->result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    return false;
}

static bool cancel(struct slc_pbrt_parser *parser)
{
    parser->result = SLUICE_ERROR_CANCELED;
    return false;
}

struct slc_pbrt_place slc_pbrt_token_place(const struct slc_pbrt_token *token)
{
    return (struct slc_pbrt_place){token->file, token->line, token->column};
}

struct slc_pbrt_lexer *slc_pbrt_top_lexer(struct slc_pbrt_parser *parser)
{
    return &parser->frames[parser->frame_count - 1].lexer;
}

/* Files */

static bool check_end_of_file(struct slc_pbrt_parser *parser, struct slc_pbrt_frame *frame)
{
    const struct slc_pbrt_window *window = &frame->lexer.window;
    struct slc_pbrt_place place = {frame->file, frame->lexer.line, 1};
    SluicePbrtSceneInfo *info = &parser->scene->info;
    info->textSize += slc_pbrt_window_offset(window);
    if (window->failure == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return slc_pbrt_out_of_memory(parser);
    if (window->failure == SLUICE_ERROR_CANCELED)
        return cancel(parser);
    if (window->failure != SLUICE_SUCCESS)
        return slc_pbrt_stop(parser, window->failure, &place, "%s",
                             slc_pbrt_failure_text(window->failure));
    if (info->textSize > parser->scene->limits.maxTextSize)
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, &place,
                             "more text than maxTextSize allows");
    return true;
}

bool slc_pbrt_leave_file(struct slc_pbrt_parser *parser)
{
    struct slc_pbrt_frame *frame = &parser->frames[parser->frame_count - 1];
    if (!check_end_of_file(parser, frame))
        return false;
    if (frame->is_import)
        slc_pbrt_close_blocks(parser, frame->block_count);
    slc_pbrt_lexer_finish(&frame->lexer);
    parser->frame_count--;
    return true;
}

bool slc_pbrt_take_token(struct slc_pbrt_parser *parser)
{
    struct slc_pbrt_token *token = &parser->token;
    if (parser->has_token) {
        parser->has_token = false;
        return true;
    }
    for (;;) {
        struct slc_pbrt_frame *frame = &parser->frames[parser->frame_count - 1];
        slc_pbrt_next_token(&frame->lexer, token);
        token->file = frame->file;
        struct slc_pbrt_place place = slc_pbrt_token_place(token);
        if (frame->lexer.window.failure != SLUICE_SUCCESS) /* the token may be incomplete */
            return check_end_of_file(parser, frame);
        if (token->kind == SLC_PBRT_TOKEN_OPEN_STRING)
            return slc_pbrt_stop(parser, SLUICE_ERROR_CORRUPT_DATA, &place,
                                 "this string does not end on its line");
        if (token->kind == SLC_PBRT_TOKEN_TOO_LONG)
            return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, &place,
                                 "a word or string of more than 65536 bytes");
        if (token->kind != SLC_PBRT_TOKEN_END)
            return true;
        if (frame->is_import) {
            token->kind = SLC_PBRT_TOKEN_FILE_END;
            return true;
        }
        if (parser->frame_count == 1)
            return check_end_of_file(parser, frame);
        if (!slc_pbrt_leave_file(parser))
            return false;
    }
}

static bool is_open_already(const struct slc_pbrt_parser *parser,
                            const struct slc_pbrt_stamp *stamp)
{
    for (size_t i = 0; i < parser->frame_count; i++) {
        const struct slc_pbrt_stamp *other = &parser->frames[i].lexer.window.stamp;
        if (other->device == stamp->device && other->inode == stamp->inode)
            return true;
    }
    return false;
}

/* Adds a file to the scene. `path`: number in names. */
static bool add_file(struct slc_pbrt_parser *parser, uint32_t path,
                     const struct slc_pbrt_stamp *stamp, uint32_t *file)
{
    SluicePbrtScene *scene = parser->scene;
    if (!slc_pbrt_grow(&scene->allocator, &scene->files, &scene->file_capacity,
                       scene->file_count + 1, sizeof *scene->files))
        return slc_pbrt_out_of_memory(parser);
    scene->files[scene->file_count] = (struct slc_pbrt_file){path, *stamp};
    *file = (uint32_t)scene->file_count++;
    return true;
}

static bool push_frame(struct slc_pbrt_parser *parser, uint32_t path, bool is_import,
                       SluiceResult *opened)
{
    SluicePbrtScene *scene = parser->scene;
    if (!slc_pbrt_grow(&scene->allocator, &parser->frames, &parser->frame_capacity,
                       parser->frame_count + 1, sizeof *parser->frames))
        return slc_pbrt_out_of_memory(parser);
    struct slc_pbrt_frame *frame = &parser->frames[parser->frame_count];
    *opened = slc_pbrt_lexer_open(&frame->lexer, slc_pbrt_name(&scene->names, path), &parser->watch,
                                  &scene->allocator);
    if (*opened == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return slc_pbrt_out_of_memory(parser);
    if (*opened == SLUICE_ERROR_CANCELED)
        return cancel(parser);
    if (*opened != SLUICE_SUCCESS)
        return true;
    slc_pbrt_window_limit(&frame->lexer.window, scene->limits.maxTextSize - scene->info.textSize);
    frame->is_import = is_import;
    frame->block_count = parser->block_count;
    if (add_file(parser, path, &frame->lexer.window.stamp, &frame->file)) {
        parser->frame_count++;
        return true;
    }
    slc_pbrt_lexer_finish(&frame->lexer);
    return false;
}

bool slc_pbrt_enter_file(struct slc_pbrt_parser *parser, const char *name, bool is_import,
                         const struct slc_pbrt_place *place)
{
    SluicePbrtScene *scene = parser->scene;
    struct slc_pbrt_stamp stamp;
    uint32_t path;
    SluiceResult opened;
    if (!slc_pbrt_intern_path(parser, name, &path))
        return false;
    const char *text = slc_pbrt_name(&scene->names, path);
    if (slc_pbrt_stamp_of(text, &stamp) && is_open_already(parser, &stamp)) {
        slc_pbrt_say(scene, SLUICE_LOG_ERROR, place, "%s includes itself: left out", text);
        return true;
    }
    if (parser->frame_count >= scene->limits.maxIncludeDepth)
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, place,
                             "%u files include one another: maxIncludeDepth",
                             (unsigned)parser->frame_count);
    if (++parser->include_count > scene->limits.maxIncludeCount)
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, place,
                             "%u files are included: maxIncludeCount", parser->include_count);
    if (!push_frame(parser, path, is_import, &opened))
        return false;
    if (opened == SLUICE_SUCCESS)
        return !is_import || slc_pbrt_push_block(parser, SLC_PBRT_IMPORT_BLOCK, place);
    slc_pbrt_say(scene, SLUICE_LOG_ERROR, place, "%s: %s; left out",
                 slc_pbrt_name(&scene->names, path), slc_pbrt_failure_text(opened));
    return true;
}

/* The whole scene */

static bool read_directives(struct slc_pbrt_parser *parser)
{
    while (slc_pbrt_take_token(parser)) {
        struct slc_pbrt_place place = slc_pbrt_token_place(&parser->token);
        switch (parser->token.kind) {
        case SLC_PBRT_TOKEN_END: return true;
        case SLC_PBRT_TOKEN_FILE_END:
            if (!slc_pbrt_leave_file(parser))
                return false;
            break;
        case SLC_PBRT_TOKEN_WORD:
            if (parser->after_world) {
                slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, &place,
                             "text after WorldEnd is ignored");
                return true;
            }
            if (!slc_pbrt_read_directive(parser, &place))
                return false;
            break;
        default:
            slc_pbrt_say(parser->scene, SLUICE_LOG_ERROR, &place,
                         "a directive is expected here: left out up to the next one");
            if (parser->token.kind == SLC_PBRT_TOKEN_STRING) {
                parser->has_token = true;
                if (!slc_pbrt_read_parameters(parser))
                    return false;
            }
        }
    }
    return false;
}

static bool finish_scene(struct slc_pbrt_parser *parser)
{
    struct slc_pbrt_place nowhere = {0, 1, 1};
    if (!parser->in_world && !parser->after_world)
        return slc_pbrt_stop(parser, SLUICE_ERROR_CORRUPT_DATA, &nowhere,
                             "no WorldBegin: this is no scene");
    slc_pbrt_close_blocks(parser, 0);
    slc_pbrt_finish_camera(parser);
    parser->scene->info.version = parser->has_world_end ? 3 : 4;
    return slc_pbrt_finish_materials(parser);
}

/* Keeps the folder of the first file, with its slash. */
static bool open_first(struct slc_pbrt_parser *parser, const char *path)
{
    SluicePbrtScene *scene = parser->scene;
    const char *slash = strrchr(path, '/');
    uint32_t name;
    SluiceResult opened;
    if (!slc_pbrt_names_add(&scene->names, &scene->allocator, path,
                            slash ? (size_t)(slash - path) + 1 : 0, &scene->folder) ||
        !slc_pbrt_names_add(&scene->names, &scene->allocator, path, strlen(path), &name))
        return slc_pbrt_out_of_memory(parser);
    if (!push_frame(parser, name, false, &opened))
        return false;
    if (opened == SLUICE_SUCCESS)
        return true;
    parser->result = opened;
    slc_pbrt_say(scene, SLUICE_LOG_ERROR, &(struct slc_pbrt_place){SLUICE_PBRT_NONE, 0, 0},
                 "%s: %s", path, slc_pbrt_failure_text(opened));
    return false;
}

static void finish_parser(struct slc_pbrt_parser *parser)
{
    const SluiceAllocationCallbacks *cb = &parser->scene->allocator;
    for (size_t i = 0; i < parser->frame_count; i++)
        slc_pbrt_lexer_finish(&parser->frames[i].lexer);
    for (size_t i = 0; i < parser->attribute_count; i++)
        slc_pbrt_parameters_finish(&parser->attributes[i].parameters);
    slc_pbrt_parameters_finish(&parser->parameters);
    slc_pbrt_parameters_finish(&parser->camera);
    slc_free(cb, parser->frames, parser->frame_capacity, sizeof *parser->frames);
    slc_free(cb, parser->blocks, parser->block_capacity, sizeof *parser->blocks);
    slc_free(cb, parser->meanings, parser->meaning_capacity, sizeof *parser->meanings);
    slc_free(cb, parser->undos, parser->undo_capacity, sizeof *parser->undos);
    slc_free(cb, parser->forwards, parser->forward_capacity, sizeof *parser->forwards);
    slc_free(cb, parser->coordinates, parser->coordinate_capacity, sizeof *parser->coordinates);
    slc_free(cb, parser->attributes, parser->attribute_capacity, sizeof *parser->attributes);
    slc_free(cb, parser->material_table, parser->material_table_size,
             sizeof *parser->material_table);
}

SluiceResult slc_pbrt_parse(SluicePbrtScene *scene, const char *path)
{
    struct slc_pbrt_parser parser = {
        .scene = scene,
        .object = SLUICE_PBRT_NONE,
        .watch = {.user = scene->limits.pUserData, .goes_on = scene->limits.pfnProgress}};
    parser.parameters.allocator = parser.camera.allocator = scene->allocator;
    parser.state.transform = parser.camera_to_world = slc_pbrt_identity();
    parser.state.area_light = SLUICE_PBRT_NONE;
    for (int i = 0; i < SLC_PBRT_TARGET_COUNT; i++)
        parser.state.attributes[i] = SLUICE_PBRT_NONE;
    if (open_first(&parser, path) && slc_pbrt_add_default_material(&parser) &&
        read_directives(&parser))
        finish_scene(&parser);
    finish_parser(&parser);
    return parser.result;
}
