/* Ways to write feedback: as levels, as level bits, in turns. Equal requests must give equal
 * decisions. */
#include "device/pattern.h"
#include "device/writer.h"

#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/test.h"

#include <sluice/replay.h>
#include <sluice/shared/texture_table.h>

#include <math.h>
#include <string.h>

enum { TEXTURES = 6, SIZE = 1024, REGIONS = 64 }; /* tiles of 128 x 128 */

struct stage {
    struct harness *h;
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *sources[TEXTURES];
    SluiceVulkanTexture textures[TEXTURES];
    struct writer writer;
    SluiceRecorder *recorder;
    uint8_t recording[1 << 20];
    size_t recording_size;
};

static SluiceResult write_bytes(void *user, const void *data, size_t size)
{
    struct stage *stage = user;
    assert_true(stage->recording_size + size <= sizeof stage->recording);
    memcpy(stage->recording + stage->recording_size, data, size);
    stage->recording_size += size;
    return SLUICE_SUCCESS;
}

static void stage_init(struct stage *stage, struct harness *h, SluiceVulkanStreamerCreateInfo info,
                       enum writer_kind kind)
{
    *stage = (struct stage){.h = h};
    info.feedbackTimeoutTicks = 1000;
    harness_fill(h, &info);
    h->time = 0;
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &stage->streamer));
    SluiceRecordWriter writer = {stage, write_bytes};
    CHECK_OK(sluiceBeginRecording(manager_of(stage->streamer), &writer, NULL, &stage->recorder));
    for (uint32_t i = 0; i < TEXTURES; i++) {
        stage->sources[i] = pattern_source(PATTERN_LEVEL, SIZE, SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM);
        SluiceVulkanTextureCreateInfo texture = {.structSize = sizeof texture,
                                                 .source = stage->sources[i]};
        CHECK_OK(sluiceAddVulkanTexture(stage->streamer, &texture, &stage->textures[i]));
    }
    writer_init(&stage->writer, h, stage->streamer, kind);
}

static void stage_finish(struct stage *stage)
{
    writer_finish(&stage->writer);
    CHECK_OK(sluiceEndRecording(stage->recorder));
    harness_destroy(stage->h, stage->streamer);
    for (uint32_t i = 0; i < TEXTURES; i++)
        sluiceDestroyImageSource(stage->sources[i]);
    harness_check_silence(stage->h);
}

static float draw(void)
{
    return (float)roll() / (float)ROLL_MAX;
}

static void random_samples(struct stage *stage, uint32_t count, float max_lod)
{
    stage->writer.count = count;
    for (uint32_t i = 0; i < count; i++) {
        float scale = exp2f(draw() * max_lod) / (float)SIZE;
        writer_inputs(&stage->writer)[i] =
            (struct WriterInput){.uv = {draw(), draw()},
                                 .dx = {scale, 0},
                                 .dy = {0, scale * (1 + draw())},
                                 .maxAnisotropy = roll() % 2 ? 1.0f : 4.0f,
                                 .tableIndex = stage->textures[roll() % TEXTURES].tableIndex};
    }
}

static void min_mips(struct stage *stage, uint8_t maps[TEXTURES][REGIONS])
{
    for (uint32_t i = 0; i < TEXTURES; i++)
        CHECK_OK(sluiceWriteMinMipData(manager_of(stage->streamer), stage->textures[i].textureId, 8,
                                       REGIONS, maps[i]));
}

static void level_bits_lead_to_the_same_recording_as_levels(void **state)
{
    static struct stage levels, masks;
    for (int kind = 0; kind < 2; kind++) {
        struct stage *stage = kind ? &masks : &levels;
        stage_init(stage, *state,
                   (SluiceVulkanStreamerCreateInfo){
                       .structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                       .texturesPerFrame = 4,
                       .feedbackEncoding =
                           kind ? SLUICE_FEEDBACK_ENCODING_MASKS : SLUICE_FEEDBACK_ENCODING_LEVELS},
                   kind ? WRITER_MASKS : WRITER_LEVELS);
        roll_seed(71);
        for (uint32_t frame = 0; frame < 40; frame++) {
            random_samples(stage, (uint32_t)roll() % 200, 9);
            harness_settle(stage->h, stage->streamer, 1, writer_record, &stage->writer);
        }
        SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
        sluiceGetVulkanStreamerStatistics(stage->streamer, &stats);
        assert_true(stats.tilesMapped > 100 && stats.feedbackWords > 100);
        stage_finish(stage);
    }
    assert_int_equal(levels.recording_size, masks.recording_size);
    assert_memory_equal(levels.recording, masks.recording, masks.recording_size);
}

/* Counts words of the feedback buffer that a resolve has not reset. */
static uint32_t marked_words(struct stage *stage)
{
    const uint32_t *words = writer_words(&stage->writer, 0, TEXTURES * REGIONS);
    uint32_t count = 0;
    for (uint32_t i = 0; i < TEXTURES * REGIONS; i++)
        count += words[i] != SLUICE_MIP_UNTOUCHED;
    return count;
}

static void only_those_whose_turn_it_is_write(void **state)
{
    for (int in_turns = 0; in_turns < 2; in_turns++) {
        static struct stage stage;
        stage_init(
            &stage, *state,
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .texturesPerFrame = 2,
                                             .feedbackInTurns = in_turns},
            WRITER_IN_TURNS);
        roll_seed(72);
        for (uint32_t frame = 1; frame <= 12; frame++) {
            random_samples(&stage, 1000, 5);
            harness_frame(stage.h, stage.streamer, true, writer_record, &stage.writer);
            /* written maps are resolved at once; without turns the other four wait */
            uint32_t marked = marked_words(&stage);
            assert_true(in_turns ? marked == 0 : marked > 4 * REGIONS / 2);
        }
        SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
        sluiceGetVulkanStreamerStatistics(stage.streamer, &stats);
        assert_int_equal(stats.feedbackMaps, 22); /* maps of 11 frames; the last frame is pending */
        stage_finish(&stage);
    }
}

static void turns_delay_but_settle_to_the_same(void **state)
{
    static uint8_t maps[2][TEXTURES][REGIONS];
    for (int in_turns = 0; in_turns < 2; in_turns++) {
        static struct stage stage;
        stage_init(
            &stage, *state,
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .texturesPerFrame = 1,
                                             .feedbackInTurns = in_turns},
            WRITER_IN_TURNS);
        roll_seed(73);
        random_samples(&stage, 50, 3);
        harness_settle(stage.h, stage.streamer, 6 * TEXTURES, writer_record, &stage.writer);
        min_mips(&stage, maps[in_turns]);
        stage_finish(&stage);
    }
    assert_memory_equal(maps[0], maps[1], sizeof maps[0]);
    uint32_t fine = 0;
    for (uint32_t i = 0; i < TEXTURES * REGIONS; i++)
        fine += maps[0][i / REGIONS][i % REGIONS] < 2;
    assert_true(fine > 20);
}

/* Runs between Begin and End, after the turns of the frame were published. */
static void record_and_replace(void *user, VkCommandBuffer commands)
{
    struct stage *stage = user;
    writer_record(&stage->writer, commands);
    uint32_t i = (uint32_t)roll() % TEXTURES;
    CHECK_OK(sluiceRemoveVulkanTexture(stage->streamer, stage->textures[i].textureId));
    SluiceVulkanTextureCreateInfo texture = {.structSize = sizeof texture,
                                             .source = stage->sources[i]};
    CHECK_OK(sluiceAddVulkanTexture(stage->streamer, &texture, &stage->textures[i]));
}

static void textures_that_come_and_go_inside_a_frame_keep_the_turns(void **state)
{
    static uint8_t maps[2][TEXTURES][REGIONS];
    for (int replaced = 0; replaced < 2; replaced++) {
        static struct stage stage;
        stage_init(
            &stage, *state,
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .texturesPerFrame = 2,
                                             .feedbackInTurns = true},
            WRITER_IN_TURNS);
        roll_seed(74);
        for (uint32_t frame = 0; frame < 30 && replaced; frame++) {
            random_samples(&stage, 300, 4);
            harness_settle(stage.h, stage.streamer, 1, record_and_replace, &stage);
        }
        roll_seed(75);
        random_samples(&stage, 50, 3);
        harness_settle(stage.h, stage.streamer, 6 * TEXTURES, writer_record, &stage.writer);
        min_mips(&stage, maps[replaced]);
        stage_finish(&stage);
    }
    /* all wanted tiles are resident, and some formerly wanted ones */
    for (uint32_t i = 0; i < TEXTURES * REGIONS; i++)
        assert_true(maps[1][i / REGIONS][i % REGIONS] <= maps[0][i / REGIONS][i % REGIONS]);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(level_bits_lead_to_the_same_recording_as_levels),
        cmocka_unit_test(only_those_whose_turn_it_is_write),
        cmocka_unit_test(turns_delay_but_settle_to_the_same),
        cmocka_unit_test(textures_that_come_and_go_inside_a_frame_keep_the_turns),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    /* reads arrive in the same order every time */
    CHECK_OK(harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.loaderThreadCount = 1}));
    return harness_finish(&h, RUN_TESTS(tests));
}
