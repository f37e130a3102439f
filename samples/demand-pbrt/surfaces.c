#include "surfaces.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/text.h"
#include "programs.h"

#define PICTURE_ROOM 4096u /* most pictures of the surfaces that one launch requests */

bool surfaces_create(const struct gpu *gpu, const struct scene *scene, struct surfaces *s)
{
    const uint32_t count = scene->info.materialCount + scene->info.textureCount;
    *s = (struct surfaces){.table.element = sizeof(struct PbrtSurface),
                           .ops.element = sizeof(struct PbrtOp),
                           .wanted.element = sizeof(uint32_t),
                           .material_count = scene->info.materialCount,
                           .picture_room = PICTURE_ROOM};
    s->pictures = calloc(s->picture_room, sizeof *s->pictures);
    s->made = calloc(count + 1u, sizeof *s->made);
    if (!s->pictures || !s->made)
        fprintf(stderr, "out of memory\n");
    return s->pictures && s->made && table_grow(gpu, &s->table, count + 1) &&
           table_grow(gpu, &s->ops, 1) && table_grow(gpu, &s->wanted, count + 1);
}

void surfaces_finish(const struct gpu *gpu, struct surfaces *s)
{
    if (gpu->device) {
        table_finish(gpu, &s->table);
        table_finish(gpu, &s->ops);
        table_finish(gpu, &s->wanted);
    }
    free(s->pictures);
    free(s->made);
    *s = (struct surfaces){0};
}

uint32_t surfaces_alpha(const struct surfaces *s, uint32_t texture)
{
    return s->material_count + texture;
}

void surfaces_begin(struct surfaces *s)
{
    s->picture_count = 0;
}

/** Follows a mixture to its first material that is no mixture. */
static SluicePbrtMaterial leading_material(const struct scene *scene, uint32_t index)
{
    SluicePbrtMaterial m = scene_material(scene, index);
    while (m.kind == SLUICE_PBRT_MATERIAL_MIX)
        m = scene_material(scene, m.materials[0]);
    return m;
}

static struct PbrtSurface make_material(const struct program *program, uint32_t index)
{
    const SluicePbrtMaterial m = leading_material(program->scene, index);
    struct PbrtSurface surface = {.kind = m.kind, .roughness = m.roughness.value[0], .eta = m.eta};
    surface.diffuse = program_of_material(program, index, offsetof(SluicePbrtMaterial, diffuse));
    surface.specular = program_of_material(program, index, offsetof(SluicePbrtMaterial, specular));
    surface.transmission =
        program_of_material(program, index, offsetof(SluicePbrtMaterial, transmission));
    return surface;
}

static struct PbrtSurface make_alpha(const struct program *program, uint32_t texture)
{
    const SluicePbrtTexture t = scene_texture(program->scene, texture);
    const SluicePbrtValue value = {{t.value[0], t.value[1], t.value[2]}, texture};
    struct PbrtSurface surface = {
        .kind = PBRT_SURFACE_ALPHA, .specular = PBRT_NONE, .transmission = PBRT_NONE};
    surface.diffuse = program_of_value(program, &value);
    return surface;
}

static void tell(const struct scene *scene, const struct surfaces *s, uint32_t index)
{
    if (index < s->material_count)
        text_say("material %u: %s", index, scene_material(scene, index).pType);
    else
        text_say("alpha texture \"%s\"", scene_texture(scene, index - s->material_count).pName);
}

bool surfaces_realize(const struct gpu *gpu, const struct scene *scene, struct textures *textures,
                      struct surfaces *s, uint32_t index, uint32_t launch)
{
    const uint32_t first = s->ops.count;
    const uint32_t wanted = *(const uint32_t *)table_at(&s->wanted, index);
    if (((const struct PbrtSurface *)table_at(&s->table, index))->realized)
        return true;
    const struct program program = {.gpu = gpu,
                                    .scene = scene,
                                    .textures = textures,
                                    .surfaces = s,
                                    .wanted = wanted ? exp2f((float)wanted - 1.0f) : 0.0f};
    struct PbrtSurface surface = index < s->material_count
                                     ? make_material(&program, index)
                                     : make_alpha(&program, index - s->material_count);
    if (surface.diffuse == PBRT_NONE ||
        (index < s->material_count &&
         (surface.specular == PBRT_NONE || surface.transmission == PBRT_NONE)))
        return false;
    surface.realized = 1;
    *(struct PbrtSurface *)table_at(&s->table, index) = surface;
    s->made[s->made_count++] =
        (struct made_surface){index, first, s->ops.count - first, launch, launch, false};
    *(index < s->material_count ? &s->material_realized_count : &s->alpha_realized_count) += 1;
    if (s->says_what_it_makes)
        tell(scene, s, index);
    return true;
}

uint64_t surfaces_size(const struct surfaces *s)
{
    return (uint64_t)s->ops.count * s->ops.element;
}

/** Moves the ops of a surface toward the beginning. Op targets and programs are indices of the
 * table. */
static void move_down(struct surfaces *s, const struct made_surface *made, uint32_t to)
{
    const uint32_t by = made->first_op - to;
    memmove(table_at(&s->ops, to), table_at(&s->ops, made->first_op),
            (size_t)made->op_count * s->ops.element);
    for (uint32_t i = to; i < to + made->op_count; i++) {
        struct PbrtOp *op = table_at(&s->ops, i);
        op->target -= op->op == PBRT_OP_CHECKER || op->op == PBRT_OP_JUMP ? by : 0;
    }
    struct PbrtSurface *surface = table_at(&s->table, made->index);
    uint32_t *const programs[] = {&surface->diffuse, &surface->specular, &surface->transmission};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        *programs[i] -= *programs[i] == PBRT_NONE ? 0 : by;
}

/** Updates the pictures' op indices. Pictures are listed in the order of their ops. */
static void move_pictures(struct surfaces *s, const struct made_surface *made, uint32_t to,
                          uint32_t *next)
{
    for (; *next < s->picture_count; *next += 1) {
        uint32_t *op = &s->pictures[*next].op;
        if (*op == PBRT_NONE)
            continue;
        if (*op >= made->first_op + made->op_count)
            return;
        *op = made->leaves ? PBRT_NONE : *op - (made->first_op - to);
    }
}

void surfaces_evict(struct surfaces *s)
{
    uint32_t kept = 0, at = 0, picture = 0;
    for (uint32_t i = 0; i < s->made_count; i++) {
        struct made_surface made = s->made[i];
        move_pictures(s, &made, at, &picture);
        if (made.leaves) {
            *(struct PbrtSurface *)table_at(&s->table, made.index) = (struct PbrtSurface){0};
            s->evicted_count++;
            continue;
        }
        move_down(s, &made, at);
        made.first_op = at;
        at += made.op_count;
        s->made[kept++] = made;
    }
    s->made_count = kept;
    s->ops.count = at;
}

static uint32_t encoding_flags(const struct picture_image *image, SluicePbrtEncoding encoding)
{
    const SluiceFormat format = image->info.format;
    const bool is_srgb =
        encoding == SLUICE_PBRT_ENCODING_DEFAULT || encoding == SLUICE_PBRT_ENCODING_SRGB;
    if (image->kind != SLUICE_IMAGE_FILE_KIND_PICTURE || image->info.width == 0)
        return 0;
    switch (format) { /* formats as stored by the baker: docs/baking.md */
    case SLUICE_FORMAT_R8_UNORM:
    case SLUICE_FORMAT_R8G8_UNORM:
    case SLUICE_FORMAT_R16_UNORM:
    case SLUICE_FORMAT_R16G16_UNORM: return is_srgb ? PBRT_OP_DECODE : 0;
    case SLUICE_FORMAT_R8G8B8A8_SRGB:
    case SLUICE_FORMAT_R16G16B16A16_UNORM: return is_srgb ? 0 : PBRT_OP_ENCODE;
    default: return 0;
    }
}

void surfaces_finish_pictures(struct surfaces *s)
{
    for (uint32_t i = 0; i < s->picture_count; i++) {
        const struct wanted_picture *picture = &s->pictures[i];
        if (picture->op == PBRT_NONE)
            continue;
        struct PbrtOp *op = table_at(&s->ops, picture->op);
        if (op->op == PBRT_OP_IMAGE && op->texture == (uint32_t)picture->use->id)
            op->flags |= encoding_flags(picture->use->image, picture->encoding);
    }
}
