#include "app.h"

#include <math.h>

#define DISTANCE 0.06f /* part of the scene's diagonal */

/* Finds the UVs of a tile's center. */
static bool middle_of(const struct view_app *app, const struct stage_texture *texture,
                      const SluiceTile *tile, float middle[2])
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    if (sluiceGetTextureLayout(stage_manager(app->stage), texture->id, &layout) != SLUICE_SUCCESS)
        return false;
    middle[0] = middle[1] = 0.5f;
    if (tile->mipLevel >= layout.desc.regularMipCount)
        return true;
    const double sizes[2] = {layout.desc.tileWidth, layout.desc.tileHeight};
    const double whole[2] = {texture->width, texture->height};
    const double at[2] = {tile->x, tile->y};
    for (int k = 0; k < 2; k++) {
        const double level = fmax(1, floor(ldexp(whole[k], -(int)tile->mipLevel)));
        const double end = fmin((at[k] + 1) * sizes[k], level);
        middle[k] = (float)((at[k] * sizes[k] + end) / 2 / level);
    }
    return true;
}

void app_look_at_tile(struct view_app *app, uint32_t texture, const SluiceTile *tile)
{
    struct vec3 position, normal, bounds[2];
    float middle[2];
    app->selected = texture;
    if (!middle_of(app, stage_texture(app->stage, texture), tile, middle) ||
        !stage_find_texel(app->stage, texture, middle[0], middle[1], &position, &normal)) {
        app_say(app, "No surface has this tile");
        return;
    }
    stage_bounds(app->stage, bounds);
    const struct vec3 box = vec3_sub(bounds[1], bounds[0]);
    const float distance = DISTANCE * sqrtf(vec3_dot(box, box));
    app->follow = FOLLOW_NOTHING;
    app->touched = true;
    app->center = position;
    app->camera =
        view_camera_at(vec3_add(position, vec3_scale(normal, distance)), position, app->camera.fov);
}
