#include "pbrt/parser.h"

#include "base/alloc.h"

#include <string.h>

#define MAX_MIXTURE_DEPTH 32u

/* Fills new_index: the replacement of material i. Placeholders become their named material. */
static bool resolve(struct slc_pbrt_parser *parser, uint32_t *new_index)
{
    SluicePbrtScene *scene = parser->scene;
    uint32_t count = 0;
    for (size_t i = 0; i < scene->material_count; i++)
        if (scene->materials[i].material.structSize)
            new_index[i] = count++;
    for (size_t i = 0; i < parser->forward_count; i++) {
        const struct slc_pbrt_forward *forward = &parser->forwards[i];
        uint32_t found;
        if (!slc_pbrt_look_up(parser, forward->name, SLC_PBRT_NAMED_MATERIAL, &found))
            return false;
        if (found == SLUICE_PBRT_NONE)
            slc_pbrt_say(scene, SLUICE_LOG_WARNING, &forward->place,
                         "no material has the name \"%s\": the one before stays",
                         slc_pbrt_name(&scene->names, forward->name));
        new_index[forward->material] =
            new_index[found == SLUICE_PBRT_NONE ? forward->instead : found];
    }
    return true;
}

static void renumber(SluicePbrtScene *scene, const uint32_t *new_index)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->material_count; i++) {
        struct slc_pbrt_material_entry *entry = &scene->materials[count];
        if (scene->materials[i].material.structSize == 0)
            continue;
        memmove(entry, &scene->materials[i], sizeof *entry);
        for (int j = 0; j < 2; j++)
            if (entry->material.materials[j] != SLUICE_PBRT_NONE)
                entry->material.materials[j] = new_index[entry->material.materials[j]];
        count++;
    }
    scene->material_count = count;
    for (size_t i = 0; i < scene->shape_count; i++)
        scene->shapes[i].material = new_index[scene->shapes[i].material];
}

/* Raises depth[i] above those of its parts. Returns whether something changed. */
static bool deepen(const SluicePbrtScene *scene, uint32_t *depth)
{
    bool changed = false;
    for (size_t i = 0; i < scene->material_count; i++) {
        const SluicePbrtMaterial *material = &scene->materials[i].material;
        for (int j = 0; j < 2 && material->kind == SLUICE_PBRT_MATERIAL_MIX; j++) {
            uint32_t below = depth[material->materials[j]] + 1;
            if (below > depth[i] && depth[i] <= MAX_MIXTURE_DEPTH) {
                depth[i] = below;
                changed = true;
            }
        }
    }
    return changed;
}

/* Replaces mixtures that contain themselves or nest too deep by gray. */
static void cut_mixtures(struct slc_pbrt_parser *parser, uint32_t *depth)
{
    SluicePbrtScene *scene = parser->scene;
    const struct slc_pbrt_material_entry *gray = &scene->materials[parser->default_material];
    struct slc_pbrt_place nowhere = {0, 1, 1};
    memset(depth, 0, scene->material_count * sizeof *depth);
    for (uint32_t round = 0; round <= MAX_MIXTURE_DEPTH + 1 && deepen(scene, depth); round++)
        ;
    for (size_t i = 0; i < scene->material_count; i++) {
        if (depth[i] <= MAX_MIXTURE_DEPTH)
            continue;
        slc_pbrt_say(scene, SLUICE_LOG_ERROR, &nowhere,
                     "a mixture contains itself, or mixtures nest more than %u deep: it becomes "
                     "gray",
                     MAX_MIXTURE_DEPTH);
        uint32_t type = scene->materials[i].type;
        memcpy(&scene->materials[i], gray, sizeof *gray);
        scene->materials[i].type = type;
    }
}

bool slc_pbrt_finish_materials(struct slc_pbrt_parser *parser)
{
    SluicePbrtScene *scene = parser->scene;
    size_t count = scene->material_count;
    uint32_t *scratch = slc_calloc(&scene->allocator, count, sizeof *scratch);
    if (!scratch)
        return slc_pbrt_out_of_memory(parser);
    bool ok = resolve(parser, scratch);
    if (ok) {
        if (parser->forward_count)
            renumber(scene, scratch);
        cut_mixtures(parser, scratch);
    }
    slc_free(&scene->allocator, scratch, count, sizeof *scratch);
    return ok;
}
