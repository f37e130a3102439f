#include "scene_data.h"

#include <vulkan/vulkan_core.h>

#include <math.h>
#include <string.h>

/* Finds the scale and offset from a primary's UVs to its follower's UVs. False if the UVs rotate,
 * or if a scale is not 1/4096 to 4096, or an offset exceeds 4096. */
static bool find_transform(const struct scene_slot *primary, const struct scene_slot *follower,
                           SluiceUvTransform *to)
{
    const float *p = primary->m, *f = follower->m;
    const float determinant = p[0] * p[3] - p[1] * p[2];
    if (primary->uv_set != follower->uv_set || !(fabsf(determinant) > 1e-6f))
        return false;
    const float inverse[4] = {p[3] / determinant, -p[1] / determinant, -p[2] / determinant,
                              p[0] / determinant};
    const float m[4] = {
        f[0] * inverse[0] + f[1] * inverse[2], f[0] * inverse[1] + f[1] * inverse[3],
        f[2] * inverse[0] + f[3] * inverse[2], f[2] * inverse[1] + f[3] * inverse[3]};
    to->scaleU = m[0];
    to->scaleV = m[3];
    to->offsetU = f[4] - m[0] * p[4] - m[1] * p[5];
    to->offsetV = f[5] - m[2] * p[4] - m[3] * p[5];
    return fabsf(m[1]) < 1e-5f && fabsf(m[2]) < 1e-5f && fabsf(m[0]) >= 1.0f / 4096 &&
           fabsf(m[0]) <= 4096 && fabsf(m[3]) >= 1.0f / 4096 && fabsf(m[3]) <= 4096 &&
           fabsf(to->offsetU) <= 4096 && fabsf(to->offsetV) <= 4096;
}

static bool is_whole(float x)
{
    return fabsf(x - roundf(x)) < 1e-4f && fabsf(x) >= 0.5f;
}

static bool is_same(const SluiceUvTransform *t)
{
    return fabsf(t->scaleU - 1) < 1e-6f && fabsf(t->scaleV - 1) < 1e-6f &&
           fabsf(t->offsetU) < 1e-6f && fabsf(t->offsetV) < 1e-6f;
}

/* Returns true if the wrap modes allow following. The primary's map covers UVs 0 to 1 only, so a
 * follower must repeat a whole number of times (decision 117). */
static bool can_follow(const struct scene_image *primary, const struct scene_image *follower,
                       SluiceUvTransform *t)
{
    t->wrapU = (SluiceUvWrap)follower->wrap_u;
    t->wrapV = (SluiceUvWrap)follower->wrap_v;
    if (is_same(t))
        return primary->wrap_u == follower->wrap_u && primary->wrap_v == follower->wrap_v;
    const int repeat = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    return primary->wrap_u == repeat && primary->wrap_v == repeat && follower->wrap_u == repeat &&
           follower->wrap_v == repeat && is_whole(t->scaleU) && is_whole(t->scaleV);
}

/* Returns true if all materials use an image with the same color image and the same transform. */
static bool follows_one(const struct scene_data *scene, uint32_t image, uint32_t *primary,
                        SluiceUvTransform *transform)
{
    *primary = SCENE_NO_IMAGE;
    for (uint32_t i = 0; i < scene->material_count; i++)
        for (int k = 0; k < SLOT_COUNT; k++) {
            const struct scene_slot *slots = scene->materials[i].slots;
            SluiceUvTransform here = {0};
            if (slots[k].image != image)
                continue;
            if (k == SLOT_COLOR || slots[SLOT_COLOR].image == SCENE_NO_IMAGE ||
                !find_transform(&slots[SLOT_COLOR], &slots[k], &here) ||
                !can_follow(&scene->images[slots[SLOT_COLOR].image], &scene->images[image], &here))
                return false;
            if (*primary != SCENE_NO_IMAGE &&
                (*primary != slots[SLOT_COLOR].image || memcmp(&here, transform, sizeof here) != 0))
                return false;
            *primary = slots[SLOT_COLOR].image;
            *transform = here;
        }
    return *primary != SCENE_NO_IMAGE;
}

void scene_data_find_sets(struct scene_data *scene)
{
    for (uint32_t i = 0; i < scene->image_count; i++) {
        struct scene_image *image = &scene->images[i];
        if (!follows_one(scene, i, &image->primary, &image->transform))
            image->primary = SCENE_NO_IMAGE;
        image->transformed = image->primary != SCENE_NO_IMAGE && !is_same(&image->transform);
    }
}
