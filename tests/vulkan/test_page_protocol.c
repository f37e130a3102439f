/*
 * Promises of paged residency, with frames that finish at any time:
 * - everything a MinMip map shows has a page in the table, and the page holds its texels,
 * - changed texels are up to date once no tile of the texture waits to be read again,
 * - no page belongs to two visible tiles,
 * - no image of pages is destroyed while an incomplete frame may have it bound,
 * - a frame's descriptor set shows all images, and is not written until the frame is complete.
 *
 * Commands run in the order of recording, as on one queue behind barriers. Copies on the upload
 * queue run first, to pages that no incomplete frame may read.
 */
#include "vulkan/fake_vulkan.h"
#include "vulkan/streamer.h"

#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/test.h"

#include <sluice/shared/bindings.h>
#include <sluice/shared/texture_table.h>
#include <sluice/vulkan_control.h>

#include <stdatomic.h>
#include <string.h>

enum { TEXTURES = 6, CHUNKS = 8, LAYERS = 256, HISTORY = 64, FRAMES_IN_FLIGHT = 6 };

/** By number, level and tile: count of texel changes, modulo 16. Read by any thread. */
static atomic_uchar versions[256][12][16][16];

static bool uses_upload_queue;

struct texture {
    bool settled;    ///< true: no tile waits to be read again
    uint32_t number; ///< 0: unused; also encoded in its texels
    SluiceVulkanTexture texture;
    SluiceImageSource *source;
    SluiceStreamedTextureLayout layout;
    uint32_t first_word;
};

struct model {
    struct fake_vulkan fake;
    SluiceVulkanStreamer *streamer;
    struct texture textures[TEXTURES];
    SluiceImageSource *old_sources[256];
    uint32_t numbers[256], old_count; ///< numbers: values that sources paint
    uint32_t next_number;
    uint64_t frame;
    uint32_t abandon_one_in, abandoned_in_all; ///< one frame in this many; 0: none
    uint64_t submitted;                        ///< last submitted frame
    bool abandoned[HISTORY];
    uint32_t window;
    uint32_t reload_one_in; ///< one frame in this many changes a texture's texels; 0: none
    uint32_t shrink_one_in; ///< one frame in this many changes the budget; 0: none
    uint32_t moved;         ///< tiles moved from page to page
    bool seen[HISTORY][CHUNKS][LAYERS]; ///< pages, by frame
    VkImage shown[HISTORY][CHUNKS];     ///< by frame
    struct {
        const struct fake_set *set;
        uint64_t write_count;
    } sets[HISTORY]; ///< by frame
    struct {
        VkImage image;
        uint32_t texels[LAYERS];
    } chunks[CHUNKS];
};

/* Returns a value for a tile's texels: texture, level, version and tile. Copies can be identified
 * by it. */
static uint32_t name_of(uint32_t number, uint32_t level, uint32_t x, uint32_t y)
{
    uint32_t version = versions[number][level][y][x] & 15;
    return number | level << 8 | version << 12 | x << 16 | y << 24;
}

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)width, (void)height;
    uint32_t name = name_of(*(const uint32_t *)user, level, x / FAKE_TILE, y / FAKE_TILE);
    for (int i = 0; i < 4; i++)
        rgba[i] = (float)(name >> 8 * i & 255) / 255.0f;
}

static uint8_t want(void *user, uint32_t region)
{
    const struct model *m = user;
    uint32_t h = (region / 6 + m->window) * 0x9E3779B1u;
    h ^= h >> 15;
    return h % 4 == 0 ? (uint8_t)(h >> 8 & 3) : SLUICE_MIP_UNTOUCHED;
}

/* Finds a texture's first tile from its entry and the words per level. */
static uint32_t find_first_word(const struct model *m, const struct texture *t)
{
    struct SluiceTextureEntry entry;
    memcpy(&entry, (const uint8_t *)m->fake.watches[1].words + t->texture.tableIndex * sizeof entry,
           sizeof entry);
    assert_int_equal(entry.tileShift, 7 | 7 << 8);
    uint32_t first = entry.pageTableOffset + t->layout.desc.regularMipCount;
    for (uint32_t l = 0; l < t->layout.desc.regularMipCount; l++)
        assert_int_equal(m->fake.watches[0].words[entry.pageTableOffset + l],
                         first + t->layout.levelFirstTile[l]);
    return first;
}

static void model_add(struct model *m)
{
    const uint32_t sizes[][2] = {{1024, 1024}, {1500, 700}, {2048, 256}, {512, 1000}};
    struct texture *t = m->textures;
    while (t < m->textures + TEXTURES && t->number)
        t++;
    if (t == m->textures + TEXTURES || m->next_number == 255)
        return;
    const uint32_t *size = sizes[roll() % 4];
    *t = (struct texture){.number = ++m->next_number, .first_word = UINT32_MAX};
    m->numbers[t->number] = t->number;
    SluiceProceduralImage image = {&m->numbers[t->number], texel};
    SluiceImageInfo info = {.structSize = sizeof info,
                            .width = size[0],
                            .height = size[1],
                            .format = SLUICE_FORMAT_R8G8B8A8_UNORM};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &t->source));
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = t->source};
    SluiceResult result = sluiceAddVulkanTexture(m->streamer, &create, &t->texture);
    if (result == SLUICE_ERROR_OUT_OF_DEVICE_MEMORY && m->shrink_one_in) {
        sluiceDestroyImageSource(t->source); /* its packed levels exceed the budget */
        *t = (struct texture){0};
        return;
    }
    CHECK_OK(result);
    t->layout.structSize = sizeof t->layout;
    CHECK_OK(sluiceGetTextureLayout(manager_of(m->streamer), t->texture.textureId, &t->layout));
}

static void model_remove(struct model *m, struct texture *t)
{
    if (!t->number)
        return;
    CHECK_OK(sluiceRemoveVulkanTexture(m->streamer, t->texture.textureId));
    m->old_sources[m->old_count++] = t->source;
    *t = (struct texture){0};
}

static void take_destroyed(struct model *m)
{
    for (uint32_t d = 0; d < m->fake.destroyed_count; d++)
        for (uint64_t f = m->fake.frame_value + 1; f < m->frame; f++)
            for (uint32_t c = 0; c < CHUNKS; c++)
                assert_ptr_not_equal(m->fake.destroyed_images[d], m->shown[f % HISTORY][c]);
}

static void take_views(struct model *m, const SluiceStreamingFrame *frame)
{
    const struct fake_set *set = (const struct fake_set *)frame->descriptorSet;
    m->sets[m->frame % HISTORY].set = set;
    m->sets[m->frame % HISTORY].write_count = set->write_count;
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetVulkanPages(m->streamer, &pages);
    assert_int_equal(pages.viewCount, CHUNKS);
    for (uint32_t c = 0; c < CHUNKS; c++) {
        assert_ptr_equal(set->images[0][c].imageView, pages.pViews[c]);
        assert_ptr_equal(set->images[0][c].sampler, pages.sampler);
        VkImage image = fake_vulkan_image_of(pages.pViews[c]);
        if (m->chunks[c].image != image) {
            m->chunks[c].image = image;
            memset(m->chunks[c].texels, 0, sizeof m->chunks[c].texels);
        }
        m->shown[m->frame % HISTORY][c] = image;
    }
}

static void check_sets(const struct model *m)
{
    for (uint64_t f = m->fake.frame_value + 1; f < m->frame; f++)
        if (!m->abandoned[f % HISTORY])
            assert_int_equal(m->sets[f % HISTORY].set->write_count,
                             m->sets[f % HISTORY].write_count);
}

/* Returns a texel on a page of a bound image. */
static uint32_t texel_of(const struct model *m, VkImage image, uint32_t layer)
{
    for (uint32_t c = 0; c < CHUNKS; c++)
        if (m->chunks[c].image == image)
            return m->chunks[c].texels[layer];
    return 0;
}

static void check_unseen(const struct model *m, uint32_t chunk, uint32_t layer)
{
    for (uint64_t f = m->fake.frame_value + 1; f < m->frame; f++)
        assert_false(m->seen[f % HISTORY][chunk][layer]);
}

/* `early`: copies on the upload queue; otherwise copies of the frame. */
static void take_copies(struct model *m, bool early)
{
    for (uint32_t i = 0; i < m->fake.copy_count; i++) {
        const struct fake_copy *copy = &m->fake.copies[i];
        for (uint32_t c = 0; c < CHUNKS; c++)
            if (m->chunks[c].image == copy->image && copy->early == early) {
                if (early)
                    check_unseen(m, c, copy->layer);
                assert_true(copy->level == 0 && copy->layer < LAYERS);
                m->moved += copy->from != VK_NULL_HANDLE;
                m->chunks[c].texels[copy->layer] =
                    copy->from ? texel_of(m, copy->from, copy->from_layer) : copy->texel;
            }
    }
}

/* Checks that the page of a tile holds the tile's value. */
static void check_tile(struct model *m, const struct texture *t, uint32_t tile)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    uint32_t level = 0;
    while (level + 1 < l->desc.regularMipCount && tile >= l->levelFirstTile[level + 1])
        level++;
    uint32_t at = tile - l->levelFirstTile[level], width = l->levelWidthInTiles[level];
    uint32_t page = m->fake.watches[0].words[t->first_word + tile];
    assert_true(page != SLUICE_PAGE_NONE);
    assert_true(page >> 16 < CHUNKS && (page & 0xFFFF) < LAYERS);
    m->seen[m->frame % HISTORY][page >> 16][page & 0xFFFF] = true;
    uint32_t known = t->settled ? UINT32_MAX : ~0xF000u;
    assert_int_equal(m->chunks[page >> 16].texels[page & 0xFFFF] & known,
                     name_of(t->number, level, at % width, at / width) & known);
}

static uint32_t check_shown(struct model *m)
{
    uint32_t count = 0;
    const SluiceStreamedTextureManager *manager = manager_of(m->streamer);
    for (uint32_t i = 0; i < TEXTURES; i++) {
        struct texture *t = &m->textures[i];
        if (t->number && t->first_word == UINT32_MAX)
            t->first_word = find_first_word(m, t);
        SluiceVulkanTextureState now = {.structSize = sizeof now};
        if (t->number)
            CHECK_OK(sluiceGetVulkanTextureState(m->streamer, t->texture.textureId, NULL, &now));
        t->settled = now.reloadingTileCount == 0;
        for (uint32_t j = 0; t->number && j < t->layout.regularTileCount; j++) {
            SluiceTileState state;
            CHECK_OK(sluiceGetTileState(manager, t->texture.textureId, j, &state, NULL));
            if (state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY) {
                check_tile(m, t, j);
                count++;
            } else {
                assert_int_equal(m->fake.watches[0].words[t->first_word + j], SLUICE_PAGE_NONE);
            }
        }
    }
    return count;
}

/* Changes one tile or all. */
static void change_texels(struct model *m, const struct texture *t)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    uint32_t level = (uint32_t)roll() % l->desc.regularMipCount;
    uint32_t x = (uint32_t)roll() % l->levelWidthInTiles[level];
    uint32_t y = (uint32_t)roll() % l->levelHeightInTiles[level];
    const SluiceImageRegion texel = {level, x * FAKE_TILE, y * FAKE_TILE, 1, 1, 0};
    bool all = roll() % 4 == 0;
    for (uint32_t i = 0; all && i < sizeof versions[0]; i++)
        (&versions[t->number][0][0][0])[i]++;
    if (!all)
        versions[t->number][level][y][x]++;
    CHECK_OK(sluiceInvalidateVulkanTexture(m->streamer, t->texture.textureId, all ? NULL : &texel,
                                           all ? UINT32_MAX : 1));
}

/* Sets another source of equal size. All its texels differ. */
static void replace_source(struct model *m, struct texture *t)
{
    SluiceProceduralImage image = {&m->numbers[t->number], texel};
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetImageInfo(t->source, &info));
    m->old_sources[m->old_count++] = t->source;
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &t->source));
    for (uint32_t i = 0; i < sizeof versions[0]; i++)
        (&versions[t->number][0][0][0])[i]++;
    CHECK_OK(sluiceReplaceVulkanSource(m->streamer, t->texture.textureId, t->source));
}

static void model_reload(struct model *m)
{
    struct texture *t = &m->textures[roll() % TEXTURES];
    if (t->number && roll() % 8 == 0 && m->old_count < 200)
        replace_source(m, t);
    else if (t->number && t->layout.desc.regularMipCount)
        change_texels(m, t);
}

/* The timeline never stops at an abandoned frame. */
static uint64_t advance(const struct model *m)
{
    uint64_t now = m->fake.frame_value, end = m->frame < m->submitted ? m->frame : m->submitted;
    uint64_t value = now + (uint64_t)roll() % (end - now + 1);
    while (value > now && m->abandoned[value % HISTORY])
        value--;
    return value;
}

static SluiceResult begin(struct model *m, uint64_t time, SluiceStreamingFrame *frame)
{
    struct fake_vulkan *fake = &m->fake;
    fake->copy_count = fake->destroyed_count = 0;
    fake->published = false;
    fake->frame_value = advance(m);
    fake->now_frame = m->frame + 1;
    if (uses_upload_queue)
        fake->upload_value +=
            (uint64_t)roll() % (fake->submitted_upload_value - fake->upload_value + 1);
    if (roll() % 2)
        CHECK_OK(sluiceWaitVulkanStreamerIdle(m->streamer)); /* waits for reads */
    SluiceResult result =
        sluiceBeginStreamingFrame(m->streamer, fake_vulkan_commands(fake), time, frame);
    if (result == SLUICE_NOT_READY)
        return result;
    CHECK_OK(result);
    fake->frame_semaphore = frame->semaphore;
    m->frame = frame->frameIndex;
    m->abandoned[m->frame % HISTORY] = false;
    take_destroyed(m);
    take_views(m, frame);
    check_sets(m);
    memset(m->seen[m->frame % HISTORY], 0, sizeof m->seen[0]);
    take_copies(m, true);
    return result;
}

/* Begins one to three frames, ends most of them, and abandons them together. */
static void abandoned_frames(struct model *m, uint64_t time)
{
    SluiceStreamingFrame first = {.structSize = sizeof first}, frame = {.structSize = sizeof frame};
    fake_vulkan_mark(&m->fake);
    m->submitted = m->frame;
    if (begin(m, time, &first) != SLUICE_SUCCESS) {
        m->submitted = UINT64_MAX;
        return;
    }
    for (uint32_t more = (uint32_t)roll() % 3; roll() % 4; more--) {
        CHECK_OK(sluiceEndStreamingFrame(m->streamer, fake_vulkan_commands(&m->fake)));
        if (more == 0 || begin(m, time, &frame) != SLUICE_SUCCESS)
            break;
    }
    fake_vulkan_undo(&m->fake);
    m->submitted = UINT64_MAX;
    CHECK_OK(sluiceAbandonStreamingFrame(m->streamer, &first));
    for (uint64_t f = first.frameIndex; f <= m->frame; f++) {
        m->abandoned[f % HISTORY] = true;
        memset(m->shown[f % HISTORY], 0, sizeof m->shown[f % HISTORY]); /* no frame binds them */
        m->abandoned_in_all++;
    }
}

static uint32_t model_frame(struct model *m, uint64_t time)
{
    struct fake_vulkan *fake = &m->fake;
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    while (m->abandon_one_in && m->frame + 4 - fake->frame_value < HISTORY &&
           roll() % m->abandon_one_in == 0)
        abandoned_frames(m, time);
    if (begin(m, time, &frame) != SLUICE_SUCCESS)
        return 0;
    take_copies(m, false);
    uint32_t shown = check_shown(m);
    CHECK_OK(sluiceEndStreamingFrame(m->streamer, fake_vulkan_commands(fake)));
    return shown;
}

/* Removes all textures now and then, so that images of pages are destroyed. */
static void model_step(struct model *m, uint64_t step)
{
    if (step % 3 == 0)
        m->window = (uint32_t)roll() % (step % 500 < 250 ? 2 : 40);
    if (step % 40 == 0)
        model_remove(m, &m->textures[roll() % TEXTURES]);
    if (step % 600 == 0)
        for (uint32_t i = 0; i < TEXTURES; i++)
            model_remove(m, &m->textures[i]);
    if (step % 600 > 100 && step % 20 == 0)
        model_add(m);
}

static void check_buffers(const struct fake_vulkan *fake, const SluiceVulkanBuffers *buffers)
{
    assert_int_equal(fake->set_count, FRAMES_IN_FLIGHT);
    for (uint32_t i = 0; i < fake->set_count; i++) {
        const VkBuffer *set = fake->sets[i].buffers;
        assert_ptr_equal(set[SLUICE_BINDING_TEXTURE_TABLE], buffers->textureTable);
        assert_ptr_equal(set[SLUICE_BINDING_MIN_MIP], buffers->minMip);
        assert_ptr_equal(set[SLUICE_BINDING_FEEDBACK], buffers->feedback);
        assert_ptr_equal(set[SLUICE_BINDING_FEEDBACK_TURNS], buffers->feedbackTurns);
        assert_ptr_equal(set[SLUICE_BINDING_PAGE_TABLE], buffers->pageTable);
    }
}

/* Sets a random memory budget in MiB; 0: no limit. */
static void change_memory(struct model *m)
{
    static const uint64_t budgets[] = {0, 4, 5, 6, 8, 10, 12, 16};
    uint64_t budget = budgets[roll() % 8] << 20;
    CHECK_OK(sluiceSetVulkanMemoryBudget(m->streamer->context, budget));
}

static void run_plan(uint32_t heap_capacity, uint32_t heaps, unsigned seed, uint32_t abandon_one_in,
                     uint32_t shrink_one_in, uint32_t reload_one_in)
{
    static struct model model; /* large */
    struct model *m = &model;
    *m = (struct model){.fake = {.want = want, .user = m, .layer_size = 65536},
                        .submitted = UINT64_MAX,
                        .abandon_one_in = abandon_one_in,
                        .reload_one_in = reload_one_in,
                        .shrink_one_in = shrink_one_in};
    memset(versions, 0, sizeof versions);
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_PAGED,
                                           .framesInFlight = FRAMES_IN_FLIGHT,
                                           .tilesPerFrame = 24,
                                           .maxTextureCount = 3 * TEXTURES,
                                           .heapTileCapacity = heap_capacity,
                                           .maxHeapCount = heaps,
                                           .feedbackTimeoutTicks = 2,
                                           .maxRegionCount = 1 << 14};
    fake_vulkan_fill(&info);
    m->fake.maxPageChunkCount = CHUNKS;
    m->fake.has_upload_queue = uses_upload_queue;
    CHECK_OK(fake_vulkan_create(&m->fake, &info, &m->streamer));
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    sluiceGetVulkanBuffers(m->streamer, &buffers);
    m->fake.watches[0].buffer = buffers.pageTable;
    m->fake.watches[1].buffer = buffers.textureTable;
    roll_seed(seed);
    uint64_t shown = 0, generation;
    for (uint64_t step = 1; step <= 2000; step++) {
        model_step(m, step);
        if (shrink_one_in && (uint32_t)roll() % shrink_one_in == 0)
            change_memory(m);
        if (reload_one_in && (uint32_t)roll() % reload_one_in == 0)
            model_reload(m);
        shown += model_frame(m, step);
    }
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetVulkanStreamerStatistics(m->streamer, &stats);
    sluiceGetVulkanPages(m->streamer, &pages);
    generation = pages.generation;
    assert_true(shown > 10000);
    assert_true((stats.uploadQueueCopies > 500) == uses_upload_queue);
    assert_true(stats.tilesUnmapped > 50);
    assert_true(stats.tilesRestored > 500);
    assert_true((stats.tilesReloaded > 500) == (reload_one_in > 0));
    assert_true(generation >= 6); /* images were destroyed and created again */
    assert_true((m->moved > 10) == (shrink_one_in > 0));
    check_buffers(&m->fake, &buffers);
    assert_true(!abandon_one_in || m->abandoned_in_all > 500);
    m->fake.destroyed_count = 0;
    fake_vulkan_destroy(m->streamer);
    assert_int_equal(m->fake.live_objects, 0);
    assert_int_equal(m->fake.live_memory, 0);
    for (uint32_t i = 0; i < TEXTURES; i++)
        sluiceDestroyImageSource(m->textures[i].source);
    for (uint32_t i = 0; i < m->old_count; i++)
        sluiceDestroyImageSource(m->old_sources[i]);
}

static void run(uint32_t heap_capacity, uint32_t heaps, unsigned seed, uint32_t abandon_one_in)
{
    run_plan(heap_capacity, heaps, seed, abandon_one_in, 0, 0);
}

static void promises_hold_while_the_budget_changes(void **state)
{
    (void)state;
    run_plan(16, 0, 55, 0, 15, 0);
    run_plan(16, 0, 56, 2, 15, 0);
    run_plan(64, 0, 57, 3, 40, 0);
}

static void promises_hold_while_texels_change(void **state)
{
    (void)state;
    run_plan(64, 0, 59, 3, 40, 4);
}

static void devices_with_few_samplers_have_no_sets(void **state)
{
    (void)state;
    static struct fake_vulkan fake;
    for (uint32_t samplers = CHUNKS - 1; samplers <= CHUNKS; samplers++) {
        fake = (struct fake_vulkan){.max_samplers = samplers, .maxPageChunkCount = CHUNKS};
        SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                               .residencyMode = SLUICE_RESIDENCY_MODE_PAGED,
                                               .maxRegionCount = 1 << 10};
        SluiceVulkanStreamer *streamer;
        CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
        VkDescriptorSetLayout layout;
        const bool enough = samplers >= CHUNKS;
        CHECK_RESULT(sluiceGetVulkanDescriptorSetLayout(streamer, &layout),
                     enough ? SLUICE_SUCCESS : SLUICE_ERROR_UNSUPPORTED);
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        CHECK_OK(sluiceBeginStreamingFrame(streamer, fake_vulkan_commands(&fake), 1, &frame));
        assert_int_equal(frame.descriptorSet != VK_NULL_HANDLE, enough);
        assert_int_equal(layout != VK_NULL_HANDLE, enough);
        fake_vulkan_destroy(streamer);
        assert_int_equal(fake.live_objects, 0);
    }
}

static void promises_hold_with_little_memory(void **state)
{
    (void)state;
    run(32, 3, 51, 0);
}

static void promises_hold_with_room_for_everything(void **state)
{
    (void)state;
    run(256, 0, 52, 0);
}

static void promises_hold_where_frames_are_abandoned(void **state)
{
    (void)state;
    run(32, 3, 53, 2);
    run(256, 0, 54, 3);
}

static void promises_hold_with_an_upload_queue(void **state)
{
    (void)state;
    uses_upload_queue = true;
    run_plan(64, 0, 62, 3, 40, 4);
    uses_upload_queue = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(devices_with_few_samplers_have_no_sets),
        cmocka_unit_test(promises_hold_with_little_memory),
        cmocka_unit_test(promises_hold_with_room_for_everything),
        cmocka_unit_test(promises_hold_where_frames_are_abandoned),
        cmocka_unit_test(promises_hold_while_the_budget_changes),
        cmocka_unit_test(promises_hold_while_texels_change),
        cmocka_unit_test(promises_hold_with_an_upload_queue),
    };
    return RUN_TESTS(tests);
}
