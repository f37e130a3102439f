#include "pbrt/parser.h"

#include "pbrt/growth.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool slc_pbrt_intern(struct slc_pbrt_parser *parser, const char *string, uint32_t *name)
{
    SluicePbrtScene *scene = parser->scene;
    return slc_pbrt_names_add(&scene->names, &scene->allocator, string, strlen(string), name) ||
           slc_pbrt_out_of_memory(parser);
}

bool slc_pbrt_intern_path(struct slc_pbrt_parser *parser, const char *path, uint32_t *name)
{
    SluicePbrtScene *scene = parser->scene;
    const char *folder = path[0] == '/' ? "" : slc_pbrt_name(&scene->names, scene->folder);
    size_t folder_length = strlen(folder), length = strlen(path);
    char *whole = slc_alloc(&scene->allocator, folder_length + length + 1, 1);
    if (!whole)
        return slc_pbrt_out_of_memory(parser);
    memcpy(whole, folder, folder_length);
    memcpy(whole + folder_length, path, length + 1);
    bool ok = slc_pbrt_intern(parser, whole, name);
    slc_free(&scene->allocator, whole, folder_length + length + 1, 1);
    return ok;
}

struct slc_pbrt_meanings *slc_pbrt_meanings_of(struct slc_pbrt_parser *parser, uint32_t name)
{
    SluicePbrtScene *scene = parser->scene;
    if (!slc_pbrt_grow(&scene->allocator, &parser->meanings, &parser->meaning_capacity,
                       scene->names.count, sizeof *parser->meanings)) {
        slc_pbrt_out_of_memory(parser);
        return NULL;
    }
    for (; parser->meaning_count < scene->names.count; parser->meaning_count++)
        for (int i = 0; i < SLC_PBRT_MEANING_COUNT; i++) {
            parser->meanings[parser->meaning_count].here[i] = SLUICE_PBRT_NONE;
            parser->meanings[parser->meaning_count].last[i] = SLUICE_PBRT_NONE;
        }
    return &parser->meanings[name];
}

bool slc_pbrt_define(struct slc_pbrt_parser *parser, uint32_t name, enum slc_pbrt_meaning meaning,
                     uint32_t index)
{
    struct slc_pbrt_meanings *meanings = slc_pbrt_meanings_of(parser, name);
    if (!meanings)
        return false;
    if (parser->block_count > 0) {
        if (!slc_pbrt_grow(&parser->scene->allocator, &parser->undos, &parser->undo_capacity,
                           parser->undo_count + 1, sizeof *parser->undos))
            return slc_pbrt_out_of_memory(parser);
        parser->undos[parser->undo_count++] =
            (struct slc_pbrt_undo){name, meaning, meanings->here[meaning]};
    }
    meanings->here[meaning] = meanings->last[meaning] = index;
    return true;
}

bool slc_pbrt_look_up(struct slc_pbrt_parser *parser, uint32_t name, enum slc_pbrt_meaning meaning,
                      uint32_t *index)
{
    const struct slc_pbrt_meanings *meanings = slc_pbrt_meanings_of(parser, name);
    if (!meanings)
        return false;
    *index = meanings->here[meaning] != SLUICE_PBRT_NONE ? meanings->here[meaning]
                                                         : meanings->last[meaning];
    return true;
}

bool slc_pbrt_warn_once(struct slc_pbrt_parser *parser, const char *key,
                        const struct slc_pbrt_place *place, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    uint32_t name;
    if (!slc_pbrt_intern(parser, key, &name))
        return false;
    struct slc_pbrt_meanings *meanings = slc_pbrt_meanings_of(parser, name);
    if (!meanings)
        return false;
    if (meanings->last[SLC_PBRT_SAID] == SLUICE_PBRT_NONE)
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place, "%s", text);
    meanings->last[SLC_PBRT_SAID] = 1;
    return true;
}
