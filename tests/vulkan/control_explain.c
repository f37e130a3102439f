/* Reasons why a texture is coarse: causes each, and checks the answer. */
#include "vulkan/control_stage.h"

#include <sluice/vulkan_explain.h>

#include <string.h>

static SluiceVulkanExplanation explain(const struct stage *s, uint32_t texture,
                                       SluiceTextureRect rect)
{
    SluiceVulkanExplanation why = {.structSize = sizeof why};
    CHECK_OK(sluiceExplainVulkanTexture(s->streamer, s->textures[texture].textureId, &rect, &why));
    assert_true(strncmp(why.sentence, "gray: ", 6) == 0);
    assert_int_equal(why.sentence[strlen(why.sentence) - 1], '.');
    return why;
}

/* Checks the reason, and that the sentence contains `words`. */
#define CHECK_WHY(s, texture, rect, expected, words)                                               \
    do {                                                                                           \
        SluiceVulkanExplanation why_ = explain(s, texture, rect);                                  \
        if (why_.reason != SLUICE_COARSE_##expected || !strstr(why_.sentence, words))              \
            fail_msg("%d: reason %d: %s", __LINE__, (int)why_.reason, why_.sentence);              \
    } while (0)

static const SluiceTextureRect all = {0}, tile_3_2 = {3 * 128, 2 * 128, 128, 128};

void each_step_of_a_load_is_told(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 1000, .tilesPerFrame = 2, .maxLoadsInFlight = 64});
    CHECK_WHY(s, 0, all, QUEUED, "level 3");
    frames(s, 6);
    assert_int_equal(explain(s, 0, all).residentLevel, TAIL);
    memset(s->seen[0], 0, sizeof s->seen[0]);
    frames(s, 2); /* marks; the map, and the first two reads */
    CHECK_WHY(s, 0, tile_3_2, READING, "level 2 is being read");
    CHECK_WHY(s, 0, ((SluiceTextureRect){600, 600, 1, 1}), QUEUED, "82 tiles are requested");
    frames(s, 1);
    CHECK_WHY(s, 0, tile_3_2, UPLOADING, "level 2 was read");
    frames(s, 1);
    SluiceVulkanExplanation why = explain(s, 0, tile_3_2);
    assert_true(why.residentLevel == 2 && why.missingLevel == 1 && why.requestedLevel == 0);
    assert_memory_equal(&why.rect, &tile_3_2, sizeof tile_3_2);
    frames(s, 60);
    CHECK_WHY(s, 0, all, FINEST, "level 0 is shown");
    stage_finish(s);
    s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 1000, .tilesPerFrame = 8, .maxLoadsInFlight = 2});
    frames(s, 12);
    memset(s->seen[0], 0, sizeof s->seen[0]);
    frames(s, 2);
    CHECK_WHY(s, 0, ((SluiceTextureRect){600, 600, 1, 1}), BANDWIDTH, "one of 2 loads");
    stage_finish(s);
}

void what_the_application_decides_is_told(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 1000});
    memset(s->seen, 0, sizeof s->seen);
    set_control(s, 0, (SluiceVulkanTextureControl){.finestLevel = 2});
    set_control(s, 1, (SluiceVulkanTextureControl){.mipBias = 1});
    set_control(s, 2, (SluiceVulkanTextureControl){.hidden = true});
    frames(s, 12);
    CHECK_WHY(s, 0, all, LIMIT, "no finer level than 2");
    CHECK_WHY(s, 1, all, MIP_BIAS, "1 levels coarser");
    CHECK_WHY(s, 2, all, HIDDEN, "hidden");
    assert_int_equal(explain(s, 1, all).missingLevel, SLUICE_MIP_UNTOUCHED);
    set_control(s, 0, (SluiceVulkanTextureControl){0});
    CHECK_WHY(s, 0, all, QUEUED, "from the next frame on");
    /* A limit that does not apply is not the reason. */
    s = (stage_finish(s), stage_init(&(SluiceVulkanStreamerCreateInfo){0}));
    memset(s->seen[0], 2, sizeof s->seen[0]);
    set_control(s, 0, (SluiceVulkanTextureControl){.finestLevel = 1});
    frames(s, 8);
    CHECK_WHY(s, 0, all, ENOUGH, "level 2 is shown");
    stage_finish(s);
}

void what_nobody_sees_is_told(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 2, .texturesPerFrame = 2});
    s->seen[1][0] = 0;
    frames(s, 10);
    CHECK_WHY(s, 0, all, NOT_SEEN, "turn every 2 frames");
    CHECK_WHY(s, 1, tile_3_2, NOT_SEEN, "last requested");
    memset(s->seen[1], SLUICE_MIP_UNTOUCHED, sizeof s->seen[1]);
    frames(s, 30);
    CHECK_WHY(s, 1, all, NOT_SEEN, "last requested the texture at ");
    stage_finish(s);
}

void memory_that_is_short_is_told(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 1000, .heapTileCapacity = 32, .maxHeapCount = 1});
    memset(s->seen[0], 0, sizeof s->seen[0]);
    frames(s, 20);
    CHECK_WHY(s, 0, all, BUDGET, "waits for memory");
    stage_finish(s);
    s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 1000, .heapTileCapacity = 8, .maxHeapCount = 1});
    memset(s->seen, 1, sizeof s->seen);
    frames(s, 200);
    uint32_t biased = 0;
    for (uint32_t i = 0; i < TEXTURES; i++)
        for (uint32_t x = 0; x < SIZE; x += 128) {
            SluiceVulkanExplanation why = explain(s, i, (SluiceTextureRect){x, 0, 1, 1});
            assert_int_equal(why.reason, SLUICE_COARSE_BUDGET);
            biased += strstr(why.sentence, "levels coarser") != NULL;
        }
    assert_true(biased > 0);
    stage_finish(s);
    s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 1000, .maxTouchedTiles = 30, .retryDelayTicks = 1000});
    memset(s->seen[0], 0, sizeof s->seen[0]);
    frames(s, 20);
    CHECK_WHY(s, 0, all, BUDGET, "30 distinct tiles");
    stage_finish(s);
}

void failed_loads_are_told(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 10000, .retryDelayTicks = 4, .givenUpRetryDelayTicks = 5000});
    frames(s, 6);
    s->faults.failure = SLUICE_ERROR_IO;
    s->faults.fail_at = 1;
    s->faults.fails_on = true;
    s->seen[0][0] = 2;
    frames(s, 4);
    CHECK_WHY(s, 0, ((SluiceTextureRect){0, 0, 1, 1}), FAILED, "retryDelayTicks");
    frames(s, 200);
    CHECK_WHY(s, 0, all, FAILED, "givenUpRetryDelayTicks");
    s->faults.fails_on = false;
    CHECK_OK(sluiceRetryVulkanSource(s->streamer, NULL));
    frames(s, 6);
    CHECK_WHY(s, 0, ((SluiceTextureRect){0, 0, 1, 1}), ENOUGH, "level 2");
    stage_finish(s);
}

void fades_are_told(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 1000, .residencyFadeTicks = 50});
    memset(s->seen[0], 0, sizeof s->seen[0]);
    frames(s, 20);
    CHECK_WHY(s, 0, all, FADING, "level 0 is resident, and fades in");
    frames(s, 200);
    CHECK_WHY(s, 0, all, FINEST, "");
    stage_finish(s);
}

void followers_are_explained_by_their_primary(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 1000});
    const SluiceTextureId primary = s->textures[1].textureId;
    CHECK_OK(sluiceSetVulkanPrimaryTexture(s->streamer, s->textures[0].textureId, primary));
    memset(s->seen[1], 0, sizeof s->seen[1]);
    set_control(s, 1, (SluiceVulkanTextureControl){.finestLevel = 1});
    frames(s, 12);
    CHECK_WHY(s, 0, all, LIMIT, "no finer level than 1");
    set_control(s, 1, (SluiceVulkanTextureControl){.hidden = true});
    frames(s, 3);
    assert_int_equal(explain(s, 0, all).residentLevel, TAIL);
    CHECK_WHY(s, 0, all, HIDDEN, "");
    set_control(s, 1, (SluiceVulkanTextureControl){0});
    s->seen[1][1] = 2; /* where its neighbors show level 1 */
    frames(s, 12);
    CHECK_WHY(s, 0, all, ENOUGH, "level 1 is shown");
    stage_finish(s);
}

static void check_stage(const SluiceLoadStageCounts *stage, uint64_t count, uint64_t frames_each)
{
    assert_int_equal(stage->count, count);
    assert_int_equal(stage->frameMax, frames_each);
    assert_true(stage->frameSum == count * frames_each && stage->buckets[frames_each] == count);
}

void stages_of_loads_are_counted_in_frames(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 1000, .tilesPerFrame = 2});
    const uint32_t regular = 64 + 16 + 4;
    const uint32_t loads = regular + 2 * TEXTURES; /* level 3 fills a staging slot */
    frames(s, 8);
    memset(s->seen[0], 0, sizeof s->seen[0]);
    frames(s, 60);
    SluiceVulkanLoadStages out = {.structSize = sizeof out};
    CHECK_OK(sluiceGetVulkanLoadStages(s->streamer, &out));
    /* reads, binds and copies of frames() complete before the next frame */
    check_stage(&out.stages[SLUICE_LOAD_STAGE_READ], loads, 1);
    check_stage(&out.stages[SLUICE_LOAD_STAGE_COPY], loads, 1);
    /* Two loads are copied per frame. Two mip tails, of two loads each, arrive in one frame, and
     * two in the next: they wait 1, 1, 2, 2, and 2, 2, 3, 3 frames. */
    const SluiceLoadStageCounts *bind = &out.stages[SLUICE_LOAD_STAGE_BIND];
    assert_true(bind->count == loads && bind->frameSum == regular + 16 && bind->frameMax == 3);
    assert_true(bind->buckets[1] == regular + 2 && bind->buckets[2] == 6);
    /* Four mip tails are requested before the first frame, then two tiles per frame. */
    uint64_t sum = 0, tail_sum = 0, buckets[SLUICE_STAGE_BUCKET_COUNT] = {0};
    for (uint32_t i = 0; i < regular + TEXTURES; i++) {
        uint32_t waits = (i < TEXTURES ? i : i - TEXTURES) / 2;
        sum += waits;
        tail_sum += i < TEXTURES ? waits : 0;
        buckets[waits == 0   ? 0
                : waits < 2  ? 1
                : waits < 4  ? 2
                : waits < 8  ? 3
                : waits < 16 ? 4
                : waits < 32 ? 5
                             : 6]++;
    }
    const SluiceLoadStageCounts *queue = &out.stages[SLUICE_LOAD_STAGE_QUEUE];
    assert_true(queue->count == regular + TEXTURES && queue->frameMax == regular / 2 - 1);
    assert_int_equal(queue->frameSum, sum);
    assert_memory_equal(queue->buckets, buckets, sizeof buckets);
    const SluiceLoadStageCounts *feedback = &out.stages[SLUICE_LOAD_STAGE_FEEDBACK];
    check_stage(feedback, statistics(s).feedbackMaps, 1);
    /* All stages follow feedback. A mip tail is two loads, each with one wait in the queue. */
    assert_int_equal(out.whole.count, loads);
    assert_int_equal(out.whole.frameSum, sum + tail_sum + loads + bind->frameSum + loads);
    assert_int_equal(out.whole.frameMax, queue->frameMax + 3);
    stage_finish(s);
}

/* Explanations must agree with the other queries in every frame of random scenes. */
void explanations_agree_with_the_state_of_each_tile(void **state)
{
    (void)state;
    uint32_t seed = 3, told[16] = {0};
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 6, .heapTileCapacity = 60, .maxHeapCount = 1, .tilesPerFrame = 5});
    for (uint32_t frame = 0; frame < 120; frame++) {
        seed = seed * 1664525u + 1013904223u;
        s->seen[seed >> 30][seed >> 20 & 63] = (uint8_t)(seed >> 8 & 3);
        if (frame % 40 == 39)
            memset(s->seen, SLUICE_MIP_UNTOUCHED, sizeof s->seen);
        frames(s, 1);
        for (uint32_t i = 0; i < TEXTURES * TILES * TILES; i += 3) {
            const SluiceTextureId id = s->textures[i % TEXTURES].textureId;
            const uint32_t x = i / TEXTURES % TILES, y = i / TEXTURES / TILES;
            const SluiceTextureRect rect = {x * 128, y * 128, 128, 128};
            SluiceVulkanExplanation why = explain(s, i % TEXTURES, rect);
            SluiceVulkanTextureState shown = {.structSize = sizeof shown};
            uint8_t requested[TILES * TILES];
            SluiceStreamedTextureManager *manager;
            CHECK_OK(sluiceGetVulkanTextureState(s->streamer, id, &rect, &shown));
            CHECK_OK(sluiceGetVulkanStreamerManager(s->streamer, &manager));
            CHECK_OK(sluiceWriteRequestedLevels(manager, id, TILES, sizeof requested, requested));
            const uint32_t held = requested[y * TILES + x];
            told[why.reason]++;
            assert_memory_equal(&why.rect, &rect, sizeof rect);
            assert_int_equal(why.residentLevel, shown.residentLevel);
            if (shown.drawable)
                assert_int_equal(why.missingLevel == SLUICE_MIP_UNTOUCHED,
                                 held >= shown.residentLevel);
            assert_int_equal(why.reason == SLUICE_COARSE_FINEST, shown.residentLevel == 0);
            if (why.reason == SLUICE_COARSE_ENOUGH)
                assert_true(held >= why.residentLevel && held != SLUICE_MIP_UNTOUCHED);
            if (why.reason == SLUICE_COARSE_NOT_SEEN)
                assert_int_equal(held, SLUICE_MIP_UNTOUCHED);
        }
    }
    const SluiceCoarseReason often[] = {SLUICE_COARSE_FINEST, SLUICE_COARSE_ENOUGH,
                                        SLUICE_COARSE_NOT_SEEN, SLUICE_COARSE_READING,
                                        SLUICE_COARSE_UPLOADING};
    for (uint32_t i = 0; i < sizeof often / sizeof often[0]; i++)
        assert_true(told[often[i]] > 0);
    stage_finish(s);
}

static void check_feedback(const struct stage *s, uint32_t texture, const uint8_t *seen)
{
    uint8_t rows[TILES][TILES + 3];
    const SluiceTextureId id = s->textures[texture].textureId;
    const size_t pitch = sizeof rows[0], size = (TILES - 1) * pitch + TILES;
    memset(rows, 77, sizeof rows);
    CHECK_OK(sluiceWriteVulkanFeedback(s->streamer, id, pitch, size, rows[0]));
    for (uint32_t y = 0; y < TILES; y++) {
        assert_memory_equal(rows[y], seen + y * TILES, TILES);
        assert_int_equal(rows[y][TILES], 77); /* between rows nothing is written */
    }
    CHECK_RESULT(sluiceWriteVulkanFeedback(s->streamer, id, pitch, size - 1, rows[0]),
                 SLUICE_ERROR_SIZE_MISMATCH);
    CHECK_RESULT(sluiceWriteVulkanFeedback(s->streamer, id, TILES - 1, sizeof rows, rows[0]),
                 SLUICE_ERROR_SIZE_MISMATCH);
    CHECK_RESULT(sluiceWriteVulkanFeedback(s->streamer, id, SIZE_MAX, SIZE_MAX, rows[0]),
                 SLUICE_ERROR_SIZE_MISMATCH);
}

/* Controls and requests change what is loaded, and not what was marked. */
void feedback_is_written_as_shaders_marked_it(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 2});
    uint8_t nothing[TILES * TILES];
    memset(nothing, SLUICE_MIP_UNTOUCHED, sizeof nothing);
    check_feedback(s, 0, nothing);
    set_control(s, 0, (SluiceVulkanTextureControl){.finestLevel = 2});
    set_control(s, 1, (SluiceVulkanTextureControl){.mipBias = 1});
    set_control(s, 2, (SluiceVulkanTextureControl){.hidden = true});
    for (uint32_t turn = 0; turn < 5; turn++) {
        for (uint32_t i = 0; i < sizeof s->seen; i++)
            s->seen[i / sizeof s->seen[0]][i % sizeof s->seen[0]] =
                (i * 7 + turn) % 5 == 4 ? SLUICE_MIP_UNTOUCHED : (uint8_t)((i * 7 + turn) % 5);
        frames(s, 4); /* each of four textures has its turn, and is read back */
        for (uint32_t i = 0; i < TEXTURES; i++)
            check_feedback(s, i, i == 2 ? nothing : s->seen[i]); /* hidden: no turn */
    }
    memset(s->seen, SLUICE_MIP_UNTOUCHED, sizeof s->seen);
    frames(s, 8); /* the manager forgets in 2 ticks */
    check_feedback(s, 3, nothing);
    stage_finish(s);
}
