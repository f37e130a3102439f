#include "device/demand_samples.h"

#include "support/roll.h"

#include <math.h>

double demand_random(void)
{
    return roll() / (ROLL_MAX + 1.0);
}

struct demand_texture demand_random_texture(uint32_t width, uint32_t height)
{
    struct demand_texture t = {.width = width,
                               .height = height,
                               .mode_u = (uint32_t)roll() % 5,
                               .mode_v = (uint32_t)roll() % 5,
                               .nearest = roll() % 8 == 0,
                               .nearest_level = roll() % 8 == 0,
                               .anisotropy = 1,
                               .base_color = {0.25f, 0.5f, 0.75f, 1},
                               .border_color = {1, 1, 1, 1}};
    if (roll() % 2)
        t.anisotropy = roll() % 4 ? 1 + (float)(63 * demand_random()) : 64;
    if (roll() % 4 == 0)
        t.bias = (float)(8 * demand_random() - 4);
    return t;
}

void demand_randomize_filter(struct demand_texture *t)
{
    int kind = roll() % 3;
    t->cubic = kind == 1;
    t->smart = kind == 2;
    t->nearest = t->nearest && kind == 0;
}

float demand_random_coordinate(uint32_t size, bool wild)
{
    static const float ends[] = {0,  1,    0x1.fffffep-1f, -0x1p-24f,   -0.0f, 2,
                                 -1, 1e6f, -1e6f,          123456.789f, 0.5f};
    static const float beyond[] = {NAN, INFINITY, -INFINITY, 1e33f, -3e38f, 1e30f};
    switch (roll() % (wild ? 6 : 5)) {
    case 0: return ends[(size_t)roll() % (sizeof ends / sizeof ends[0])];
    case 1:
        return (float)(roll() % 64 * 128 + roll() % 5 - 2) / (float)size; /* about a tile's edge */
    case 2: return (float)(5 * demand_random() - 2);
    case 5: return beyond[(size_t)roll() % (sizeof beyond / sizeof beyond[0])];
    default: return (float)demand_random();
    }
}

/* A footprint `length` texels long, and up to 1000 times narrower. */
static void set_derivatives(struct DemandInput *in, const struct demand_texture *t, double length,
                            bool wild)
{
    double angle = 6.2832 * demand_random(), ratio = roll() % 4 ? exp2(-10 * demand_random()) : 1;
    double lean = roll() % 2 ? 1.5708 : 3.1416 * demand_random();
    double size[2] = {t->width, t->height};
    for (int i = 0; i < 2; i++) {
        double direction = angle - i * 1.5708, other = angle + lean - i * 1.5708;
        in->dx[i] = (float)(length * cos(direction) / size[i]);
        in->dy[i] = (float)(length * ratio * cos(other) / size[i]);
    }
    for (int i = 0; i < 2 && roll() % 2; i++) {
        float swap = in->dx[i];
        in->dx[i] = in->dy[i];
        in->dy[i] = swap;
    }
    static const float odd[] = {NAN, INFINITY, 0, -INFINITY, 3e38f, 1e-40f};
    if (wild && roll() % 8 == 0)
        in->dy[roll() % 2] = odd[(size_t)roll() % (sizeof odd / sizeof odd[0])];
}

struct DemandInput demand_random_input(uint32_t index, const struct demand_texture *t, bool wild)
{
    struct DemandInput in = {.index = index};
    in.uv[0] = demand_random_coordinate(t->width, wild && roll() % 4 == 0);
    in.uv[1] = demand_random_coordinate(t->height, wild && roll() % 4 == 0);
    int kind = roll() % 8;
    in.kind = kind < 2 ? DEMAND_LOD : kind < 3 ? DEMAND_CUBIC : DEMAND_GRAD;
    /* mostly where there are levels */
    double lod = roll() % 4 ? 14 * demand_random() - 3 : 50 * demand_random() - 10;
    in.lod = (float)(roll() % 4 ? lod : round(lod * 2) / 2);
    set_derivatives(&in, t, exp2(lod), wild);
    return in;
}
