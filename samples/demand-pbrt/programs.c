#include "programs.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define MOST_OPS 128u

static struct PbrtOp *push_op(struct program *p, uint32_t kind)
{
    const uint32_t index = p->surfaces->ops.count;
    if (p->failed || p->count == MOST_OPS || !table_grow(p->gpu, &p->surfaces->ops, index + 1)) {
        p->failed = true;
        return NULL;
    }
    p->count++;
    struct PbrtOp *op = table_at(&p->surfaces->ops, index);
    *op = (struct PbrtOp){.op = kind, .texture = PBRT_NONE};
    return op;
}

/** Pushes an op that leaves one more value on the stack. */
static struct PbrtOp *push_value_op(struct program *p, uint32_t kind)
{
    p->failed = p->failed || p->depth == PBRT_STACK;
    struct PbrtOp *op = push_op(p, kind);
    p->depth++;
    return op;
}

static void push_constant(struct program *p, const float value[3], bool is_float)
{
    struct PbrtOp *op = push_value_op(p, PBRT_OP_CONSTANT);
    if (!op)
        return;
    for (int i = 0; i < 3; i++)
        op->value[i] = value[is_float ? 0 : i];
    op->value[3] = 1.0f;
}

static void set_mapping(const SluicePbrtTexture *t, struct PbrtOp *op)
{
    op->flags |= (uint32_t)t->mapping << PBRT_OP_MAPPING_SHIFT;
    memcpy(op->scale, t->scale, sizeof op->scale);
    memcpy(op->delta, t->delta, sizeof op->delta);
    memcpy(op->axes, t->axes, sizeof op->axes);
    memcpy(op->worldToTexture, t->worldToTexture, sizeof op->worldToTexture);
}

/** Notes a picture for surfaces_finish_pictures. */
static void note_picture(struct program *p, const struct picture_use *use,
                         const SluicePbrtTexture *t)
{
    struct surfaces *s = p->surfaces;
    const float scale = fmaxf(fabsf(t->scale[0]), fabsf(t->scale[1]));
    const bool has_uv = t->mapping == SLUICE_PBRT_MAPPING_UV;
    p->failed = p->failed || s->picture_count == s->picture_room;
    if (!p->failed)
        s->pictures[s->picture_count++] =
            (struct wanted_picture){use, s->ops.count - 1, t->encoding,
                                    has_uv && scale > 0.0f ? p->wanted / scale : 0.0f, 0};
}

static void push_image(struct program *p, const SluicePbrtTexture *t)
{
    const struct picture_use *use = t->pImagePath ? textures_find(p->textures, t) : NULL;
    if (!use) {
        push_constant(p, t->value, t->isFloat);
        return;
    }
    struct PbrtOp *op = push_value_op(p, PBRT_OP_IMAGE);
    if (!op)
        return;
    op->texture = (uint32_t)use->id;
    op->factor = t->imageScale;
    op->gamma = t->encoding == SLUICE_PBRT_ENCODING_GAMMA ? t->gamma : 0.0f;
    op->flags = (t->invert ? PBRT_OP_INVERT : 0) | (t->isFloat ? PBRT_OP_FLOAT : 0) |
                (textures_has_alpha(t->pImagePath) ? PBRT_OP_HAS_ALPHA : 0);
    set_mapping(t, op);
    note_picture(p, use, t);
}

static void push_value(struct program *p, const SluicePbrtValue *value);

static void push_checker(struct program *p, const SluicePbrtTexture *t)
{
    const uint32_t checker = p->surfaces->ops.count, depth = p->depth;
    struct PbrtOp *op = push_op(p, PBRT_OP_CHECKER);
    if (!op)
        return;
    set_mapping(t, op);
    push_value(p, &t->inputs[0]);
    const uint32_t jump = p->surfaces->ops.count;
    if (!push_op(p, PBRT_OP_JUMP))
        return;
    p->depth = depth; /* only one of the two branches runs */
    ((struct PbrtOp *)table_at(&p->surfaces->ops, checker))->target = p->surfaces->ops.count;
    push_value(p, &t->inputs[1]);
    ((struct PbrtOp *)table_at(&p->surfaces->ops, jump))->target = p->surfaces->ops.count;
}

static void push_mix(struct program *p, const SluicePbrtValue *amount)
{
    push_value(p, amount);
    push_op(p, PBRT_OP_MIX);
    p->depth -= 2;
}

static void push_texture(struct program *p, uint32_t index)
{
    const SluicePbrtTexture t = scene_texture(p->scene, index);
    switch (t.kind) {
    case SLUICE_PBRT_TEXTURE_IMAGE: push_image(p, &t); return;
    case SLUICE_PBRT_TEXTURE_CHECKERBOARD: push_checker(p, &t); return;
    case SLUICE_PBRT_TEXTURE_SCALE:
        push_value(p, &t.inputs[0]);
        push_value(p, &t.inputs[1]);
        push_op(p, PBRT_OP_SCALE);
        p->depth--;
        return;
    case SLUICE_PBRT_TEXTURE_MIX:
        push_value(p, &t.inputs[0]);
        push_value(p, &t.inputs[1]);
        push_mix(p, &t.amount);
        return;
    case SLUICE_PBRT_TEXTURE_CONSTANT: break;
    }
    push_constant(p, t.value, t.isFloat);
}

/* Every level of a tree adds ops, so MOST_OPS also limits the recursion. */
static void push_value(struct program *p, const SluicePbrtValue *value)
{
    if (p->failed)
        return;
    if (value->texture == SLUICE_PBRT_NONE)
        push_constant(p, value->value, false);
    else
        push_texture(p, value->texture);
}

static void push_material(struct program *p, uint32_t index, size_t member)
{
    const SluicePbrtMaterial m = scene_material(p->scene, index);
    if (p->failed)
        return;
    if (m.kind != SLUICE_PBRT_MATERIAL_MIX) {
        SluicePbrtValue value;
        memcpy(&value, (const char *)&m + member, sizeof value);
        push_value(p, &value);
        return;
    }
    push_material(p, m.materials[0], member);
    push_material(p, m.materials[1], member);
    push_mix(p, &m.amount);
}

static uint32_t end_program(struct program *p, const float mean[3])
{
    push_op(p, PBRT_OP_END);
    if (p->failed) { /* too large */
        p->surfaces->ops.count = p->first;
        p->failed = false;
        p->count = p->depth = 0;
        push_constant(p, mean, false);
        push_op(p, PBRT_OP_END);
    }
    return p->failed ? PBRT_NONE : p->first;
}

uint32_t program_of_value(const struct program *setting, const SluicePbrtValue *value)
{
    struct program p = *setting;
    p.first = p.surfaces->ops.count;
    push_value(&p, value);
    return end_program(&p, value->value);
}

uint32_t program_of_material(const struct program *setting, uint32_t material, size_t member)
{
    static const float gray[3] = {0.5f, 0.5f, 0.5f};
    struct program p = *setting;
    p.first = p.surfaces->ops.count;
    push_material(&p, material, member);
    return end_program(&p, gray);
}
