/*
 * Reads of this device's sampler at level borders, for extreme footprints, and in long, thin or
 * uneven textures. Every read level must be marked, and marks must not be coarser. The read levels
 * show the sampler's deviation from the formula of the marks.
 */
#include "device/suite.h"
#include "device/truth.h"
#include "extremes/extremes.h"

#include "support/test.h"

#include <math.h>
#include <string.h>

#define SAMPLES 2048u

struct shape {
    uint32_t width, height, region_width, region_height;
};

/* 32 to 127 tiles each, as many as truth can distinguish. */
static const struct shape shapes[] = {
    {16383, 1, 512, 8}, {1, 16383, 8, 512}, {16384, 2, 512, 8}, {12289, 3, 256, 8},   {1, 1, 8, 8},
    {511, 511, 64, 64}, {2047, 17, 64, 32}, {3, 4097, 8, 128},  {1024, 512, 128, 128}};

struct comparison {
    struct truth truth;
    struct conform conform;
    struct conform_sample samples[SAMPLES];
    struct oracle_tiles touched, asked;
    struct extremes_row unmarked, finer, coarser;
};

static struct comparison comparison;

static double draw(uint64_t number)
{
    return (double)extremes_random(number) / 4294967296.0;
}

/* Returns a whole level, or one within 2^-1 to 2^-24 of it on either side. */
static double near_whole_level(uint64_t i, uint32_t count)
{
    double away = exp2(-(double)(1 + extremes_random(i) % 24));
    double level = extremes_random(i + 1) % (count + 2) - 1.0;
    return i % 5 ? level + (i % 2 ? away : -away) : level;
}

static float coordinate(uint64_t i, uint32_t size, uint32_t region)
{
    uint32_t regions = (size + region - 1) / region;
    double border = (double)(extremes_random(i) % (regions + 1)) * region / size;
    return (float)(i % 3 ? border + (draw(i + 1) - 0.5) * exp2(draw(i + 2) * 6) / size
                         : draw(i + 3) * 3 - 1);
}

static void make_sample(struct conform_sample *sample, struct SluiceTextureEntry e, uint64_t i,
                        float anisotropy)
{
    double length = exp2(near_whole_level(7 * i, e.mipLevelCount)), angle = draw(7 * i + 3) * 6.3;
    double ratio = i % 2 ? 1 : exp2(draw(7 * i + 4) * 5);
    if (i % 4 == 0) /* huge and small lengths */
        length = exp2(draw(7 * i + 5) * 60 - 40);
    if (i % 3 == 0)
        angle = 0;
    sample->entry = e;
    sample->in = (struct ConformInput){
        .uv = {coordinate(5 * i, e.width, e.regionWidth),
               coordinate(5 * i + 1, e.height, e.regionHeight)},
        .dx = {(float)(cos(angle) * length / e.width), (float)(sin(angle) * length / e.height)},
        .dy = {(float)(-sin(angle) * length * ratio / e.width),
               (float)(cos(angle) * length * ratio / e.height)},
        .maxAnisotropy = anisotropy};
}

/* Finds the finest and the coarsest level with a tile. Returns false if there is none. */
static bool levels_touched(const struct oracle_tiles *t, uint32_t *fine, uint32_t *coarse)
{
    bool any = false;
    for (uint32_t l = 0; l < t->entry.mipLevelCount; l++)
        for (uint32_t i = 0; i < t->width[l] * t->height[l]; i++)
            if (t->has[t->first[l] + i]) {
                *fine = any ? *fine : l;
                *coarse = l;
                any = true;
            }
    return any;
}

/* Adds how much finer or coarser than the formula's the sampler's level must be to read these
 * levels. */
static void add_levels(struct comparison *c, const struct conform_sample *sample)
{
    uint32_t fine, coarse;
    struct oracle_lod lods = oracle_lod(&sample->entry, &sample->in);
    if (isnan(lods.finest) || !levels_touched(&c->touched, &fine, &coarse))
        return;
    double last = sample->entry.mipLevelCount - 1;
    double below = fmin(lods.finest, last) - (fine + 1.0);
    double above = (coarse - 1.0) - fmax(lods.coarsest, 0);
    if (sample->in.maxAnisotropy > 1) /* docs/feedback.md: up to the level without anisotropy */
        above = (coarse - 1.0) - fmax(lods.isotropic, 0);
    const struct SluiceTextureEntry *e = &sample->entry;
    extremes_add(&c->finer, below, "level %u of %ux%u, LOD %g, %g to 1", fine, e->width, e->height,
                 lods.finest, (double)sample->in.maxAnisotropy);
    extremes_add(&c->coarser, above, "level %u of %ux%u, LOD %g, %g to 1", coarse, e->width,
                 e->height, lods.coarsest, (double)sample->in.maxAnisotropy);
}

static void check_sample(void *user, const struct conform_sample *sample, const uint32_t *map)
{
    struct comparison *c = user;
    const struct SluiceTextureEntry *e = &sample->entry;
    oracle_tiles_init(&c->touched, e);
    oracle_tiles_init(&c->asked, e);
    truth_add(&c->truth, (uint32_t)(sample - c->samples), &c->touched);
    oracle_decode(&c->asked, map);
    double unmarked = 0;
    for (uint32_t i = 0; i < c->touched.count; i++)
        unmarked += c->touched.has[i] && !c->asked.has[i];
    extremes_add(&c->unmarked, unmarked, "%ux%u, uv %.9g %.9g, dx %g %g dy %g %g, %g to 1",
                 e->width, e->height, (double)sample->in.uv[0], (double)sample->in.uv[1],
                 (double)sample->in.dx[0], (double)sample->in.dx[1], (double)sample->in.dy[0],
                 (double)sample->in.dy[1], (double)sample->in.maxAnisotropy);
    add_levels(c, sample);
}

static void compare(struct comparison *c, struct SluiceTextureEntry e, uint64_t turn,
                    float anisotropy)
{
    truth_set_sampler(&c->truth, &e, false, false, anisotropy);
    for (uint32_t i = 0; i < SAMPLES; i++)
        make_sample(&c->samples[i], e, turn * SAMPLES + i, anisotropy);
    truth_run(&c->truth, CONFORM_STAGE_COMPUTE, c->samples, SAMPLES);
    for (uint32_t done = 0; done < SAMPLES;) /* fewer if no more maps fit */
        done += conform_run(&c->conform, CONFORM_STAGE_COMPUTE, c->samples + done, SAMPLES - done,
                            check_sample, c);
}

static void compare_shapes(struct harness *h, struct comparison *c, const float *anisotropies,
                           uint32_t count)
{
    uint64_t turns = extremes_count(1, 16);
    conform_init(&c->conform, h);
    for (uint32_t s = 0; s < sizeof shapes / sizeof shapes[0]; s++) {
        struct SluiceTextureEntry e =
            conform_entry(shapes[s].width, shapes[s].height, shapes[s].region_width,
                          shapes[s].region_height, suite_modes[s % 3]);
        truth_init(&c->truth, h, &e);
        for (uint64_t turn = 0; turn < turns; turn++)
            for (uint32_t a = 0; a < count; a++)
                compare(c, e, turn * 8 + a, anisotropies[a]);
        truth_finish(&c->truth);
    }
    conform_finish(&c->conform);
}

/* Marks allow for samplers 1/8 of a level finer or coarser than the formula. */
static void isotropic_samplers_read_no_level_that_is_not_marked(void **state)
{
    struct comparison *c = &comparison;
    const float anisotropies[] = {1};
    c->unmarked = (struct extremes_row){.name = "device.sampler.unmarked", .unit = "tiles"};
    c->finer =
        (struct extremes_row){.name = "device.sampler.finer", .unit = "levels", .bound = 0.125};
    c->coarser =
        (struct extremes_row){.name = "device.sampler.coarser", .unit = "levels", .bound = 0.125};
    compare_shapes(*state, c, anisotropies, 1);
    extremes_end(&c->unmarked);
    extremes_end(&c->finer);
    extremes_end(&c->coarser);
}

static void anisotropic_samplers_read_no_level_that_is_not_marked(void **state)
{
    struct comparison *c = &comparison;
    struct harness *h = *state;
    const float anisotropies[] = {2, 4, 16};
    if (!h->anisotropy)
        SKIP_TEST("no anisotropic filter");
    c->unmarked =
        (struct extremes_row){.name = "device.anisotropic_sampler.unmarked", .unit = "tiles"};
    c->finer = (struct extremes_row){
        .name = "device.anisotropic_sampler.finer", .unit = "levels", .bound = 0.1875};
    c->coarser = (struct extremes_row){
        .name = "device.anisotropic_sampler.coarser", .unit = "levels", .bound = 0.125};
    compare_shapes(h, c, anisotropies, 3);
    extremes_end(&c->unmarked);
    extremes_end(&c->finer);
    extremes_end(&c->coarser);
}

int main(int argc, char **argv)
{
    struct harness h;
    if (!extremes_begin(argc, argv))
        return 2;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(isotropic_samplers_read_no_level_that_is_not_marked),
        cmocka_unit_test(anisotropic_samplers_read_no_level_that_is_not_marked),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
