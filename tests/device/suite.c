#include "device/suite.h"

#include "support/test.h"

#include <math.h>

const uint32_t suite_modes[SUITE_MODES] = {
    SLUICE_ADDRESS_MODE_REPEAT, SLUICE_ADDRESS_MODE_MIRRORED_REPEAT,
    SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE, SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER,
    SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE};
static struct suite suite;
static struct {
    uint64_t needed, excess, samples;
} total;

struct suite *suite_begin(struct harness *h)
{
    conform_init(&suite.c, h);
    suite.count = 0;
    suite.needed = suite.excess = suite.marks = 0;
    suite.filter = (struct oracle_filter){.subtexel = (double)suite.c.subtexel};
    return &suite;
}

struct ConformInput suite_level_input(const struct SluiceTextureEntry *e, double lod)
{
    double texels = exp2(lod);
    return (struct ConformInput){.dx = {(float)(texels / e->width), 0},
                                 .dy = {0, (float)(texels / e->height)},
                                 .maxAnisotropy = 1};
}

void suite_add(struct suite *s, struct SluiceTextureEntry entry, struct ConformInput in, double u,
               double v)
{
    assert_true(s->count < SUITE_MAX_SAMPLES);
    in.uv[0] = (float)u;
    in.uv[1] = (float)v;
    s->samples[s->count++] = (struct conform_sample){entry, in};
}

void suite_describe(const struct conform_sample *sample, const char *what, uint32_t level,
                    uint32_t x, uint32_t y)
{
    const struct SluiceTextureEntry *e = &sample->entry;
    const struct ConformInput *in = &sample->in;
    struct oracle_lod lod = oracle_lod(e, in);
    fail_msg("%s: level %u (%u, %u) of %ux%u in regions of %ux%u, mode %u; uv %.9g %.9g dx %g %g "
             "dy %g %g bias %g anisotropy %g lod %g as %u; %g by lengths, %g to %g",
             what, level, x, y, e->width, e->height, e->regionWidth, e->regionHeight,
             e->addressModeU, (double)in->uv[0], (double)in->uv[1], (double)in->dx[0],
             (double)in->dx[1], (double)in->dy[0], (double)in->dy[1], (double)in->lodBias,
             (double)in->maxAnisotropy, (double)in->lod, in->mode, lod.lengths, lod.finest,
             lod.coarsest);
}

static void check_allowed(struct suite *s, const struct conform_sample *sample, const uint32_t *map)
{
    const struct SluiceTextureEntry *e = &sample->entry;
    oracle_allow(&s->allowed, e, &sample->in);
    for (uint32_t y = 0; y < e->regionCountY; y++)
        for (uint32_t x = 0; x < e->regionCountX; x++) {
            uint32_t mark = map[y * e->regionCountX + x];
            if (mark == SLUICE_MIP_UNTOUCHED)
                continue;
            s->marks++;
            if (mark < s->allowed.level || mark >= e->mipLevelCount)
                suite_describe(sample, "a level is marked that is not allowed", mark, x, y);
            if (!oracle_allows(&s->allowed, mark, x, y))
                suite_describe(sample, "a region is marked that is not allowed", mark, x, y);
        }
}

static void check_sample(void *user, const struct conform_sample *sample, const uint32_t *map)
{
    struct suite *s = user;
    oracle_tiles_init(&s->required, &sample->entry);
    oracle_tiles_init(&s->asked, &sample->entry);
    oracle_require(&s->required, &sample->in, s->filter);
    oracle_decode(&s->asked, map);
    for (uint32_t l = 0; l < sample->entry.mipLevelCount; l++)
        for (uint32_t y = 0; y < s->required.height[l]; y++)
            for (uint32_t x = 0; x < s->required.width[l]; x++)
                if (*oracle_tile(&s->required, l, x, y) && !*oracle_tile(&s->asked, l, x, y))
                    suite_describe(sample, "a tile is required and not asked for", l, x, y);
    check_allowed(s, sample, map);
    oracle_close(&s->required);
    for (uint32_t i = 0; i < s->required.count; i++) {
        s->needed += s->required.has[i];
        s->excess += s->asked.has[i] && !s->required.has[i];
    }
}

static void run(struct suite *s, enum conform_stage stage)
{
    for (uint32_t at = 0; at < s->count;)
        at += conform_run(&s->c, stage, s->samples + at, s->count - at, check_sample, s);
}

static void replace_mode(struct suite *s, uint32_t from, uint32_t to)
{
    for (uint32_t i = 0; i < s->count; i++)
        s->samples[i].in.mode = s->samples[i].in.mode == from ? to : s->samples[i].in.mode;
}

/* Together the pixels of a quad, and a pixel in four frames, mark what one sample does. */
static void run_corners(struct suite *s, uint32_t mode, uint64_t needed, uint64_t marks)
{
    s->needed = s->excess = s->marks = 0;
    replace_mode(s, CONFORM_GRAD, mode);
    run(s, CONFORM_STAGE_COMPUTE);
    replace_mode(s, mode, CONFORM_GRAD);
    assert_int_equal(s->needed, needed);
    assert_int_equal(s->marks, marks);
}

void suite_end(struct suite *s, const char *name)
{
    run(s, CONFORM_STAGE_COMPUTE);
    uint64_t needed = s->needed, excess = s->excess, marks = s->marks;
    s->needed = s->excess = s->marks = 0;
    run(s, CONFORM_STAGE_FRAGMENT);
    assert_int_equal(s->needed, needed);
    uint64_t fragment_marks = s->marks;
    assert_true(fragment_marks > 0);
    run_corners(s, CONFORM_QUAD, needed, marks);
    run_corners(s, CONFORM_TURNS, needed, marks);
    print_message("# samples.%s %u samples\n# needed.%s %llu tiles\n# overmarked.%s %llu tiles\n",
                  name, s->count, name, (unsigned long long)needed, name,
                  (unsigned long long)excess);
    assert_true(marks > 0);
    total.samples += s->count;
    total.needed += needed;
    total.excess += excess;
    conform_finish(&s->c);
}

void suite_print_total(void)
{
    print_message(
        "# samples.total %llu samples\n# needed.total %llu tiles\n# overmarked.total %llu "
        "tiles\n",
        (unsigned long long)total.samples, (unsigned long long)total.needed,
        (unsigned long long)total.excess);
}
