#include "device/demand_maker.h"

#include "base/checked.h"
#include "device/pattern.h"
#include "support/test.h"

#include <math.h>

void demand_maker_init(struct demand_maker *m, struct runner *r, uint32_t width, uint32_t height)
{
    *m = (struct demand_maker){.r = r,
                               .info = {.structSize = sizeof m->info,
                                        .width = width,
                                        .height = height,
                                        .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                        .pName = "made texture"},
                               .answer_level = UINT32_MAX};
    maker_init(&m->maker, r->h, NULL);
}

void demand_maker_finish(struct demand_maker *m)
{
    maker_finish(&m->maker);
}

static SluiceResult record_tiles(void *user, const SluiceTileBatch *batch, SluiceResult *answers)
{
    struct demand_maker *m = user;
    assert_int_equal(batch->textureId, m->id);
    for (uint32_t i = 0; i < batch->tileCount; i++) {
        assert_int_equal(answers[i], SLUICE_SUCCESS);
        const SluiceTileTarget *t = &batch->pTiles[i];
        assert_in_range(t->x + t->region.width, 1, batch->levelWidth);
        assert_in_range(t->y + t->region.height, 1, batch->levelHeight);
        if (batch->pTiles[i].region.mipLevel == m->answer_level)
            answers[i] = m->answer;
        m->asked_count++;
        m->made_count += answers[i] == SLUICE_SUCCESS;
    }
    if (m->removes)
        CHECK_OK(sluiceRemoveDemandTexture(m->r->loader, m->id));
    const SluiceTileProducer producer = maker_producer(&m->maker, &m->info);
    return producer.pfnRecordTiles(&m->maker, batch, answers);
}

void demand_maker_add(struct demand_maker *m)
{
    const SluiceTileProducer producer = {.structSize = sizeof producer,
                                         .pImage = &m->info,
                                         .pUserData = m,
                                         .pfnRecordTiles = record_tiles,
                                         .timeoutFrames = m->timeout};
    SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                          .pSampler = &runner_nearest,
                                          .failureColor = {1, 0, 1, 1},
                                          .pProducer = &producer};
    uint32_t last = slc_mip_count(slc_max_u32(m->info.width, m->info.height)) - 1;
    pattern_texel(PATTERN_HASH, last + m->maker.version * MAKER_VERSION, 0, 0, info.lastLevelColor);
    CHECK_OK(sluiceAddDemandTexture(m->r->loader, &info, &m->id));
}

void demand_maker_add_texel(struct demand_maker *m, uint32_t level, uint32_t x, uint32_t y)
{
    runner_add_texel(m->r, m->id, m->info.width, m->info.height, level, x, y);
}

typedef void visit_fn(struct demand_maker *m, uint32_t sample, uint32_t level, uint32_t x,
                      uint32_t y);

static void visit(struct demand_maker *m, uint32_t step, visit_fn *each)
{
    uint32_t sample = 0, levels = slc_mip_count(slc_max_u32(m->info.width, m->info.height));
    for (uint32_t level = 0; level < levels; level++)
        for (uint32_t y = 0; y < slc_mip_size(m->info.height, level); y += step)
            for (uint32_t x = 0; x < slc_mip_size(m->info.width, level); x += step)
                each(m, sample++, level, x, y);
}

static void add_one(struct demand_maker *m, uint32_t sample, uint32_t level, uint32_t x, uint32_t y)
{
    (void)sample;
    demand_maker_add_texel(m, level, x, y);
}

void demand_maker_sample(struct demand_maker *m, uint32_t step)
{
    visit(m, step, add_one);
}

bool demand_maker_shows(const struct demand_maker *m, uint32_t sample, uint32_t version,
                        uint32_t level, uint32_t x, uint32_t y)
{
    struct RunnerOutput out = runner_output(m->r, sample);
    float expected[4];
    pattern_texel(PATTERN_HASH, level + version * MAKER_VERSION, x, y, expected);
    for (uint32_t c = 0; c < 4; c++)
        if (lrintf(out.color[c] * 255) != lrintf(expected[c] * 255))
            return false;
    return out.resident;
}

static void check_one(struct demand_maker *m, uint32_t sample, uint32_t level, uint32_t x,
                      uint32_t y)
{
    if (!demand_maker_shows(m, sample, m->maker.version, level, x, y))
        fail_msg("level %u (%u, %u) is %s", level, x, y,
                 runner_output(m->r, sample).resident ? "wrong" : "missing");
}

void demand_maker_check(const struct demand_maker *m, uint32_t step)
{
    visit((struct demand_maker *)m, step, check_one);
}
