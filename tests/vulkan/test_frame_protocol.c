/*
 * Promises of the frame loop, with frames and bindings that finish at any time:
 * - texels are copied only to tiles whose binding is complete,
 * - MinMip maps show only tiles that are bound and were copied to since,
 * - no tile's binding changes and no image is destroyed while an incomplete frame may read it,
 * - no page belongs to two tiles,
 * - the upload queue copies only to tiles that no incomplete frame may read,
 * - the upload queue is done before images are destroyed,
 * - memory is freed only when nothing is bound to it, and no pending binding was.
 */
#include "vulkan/fake_vulkan.h"
#include "vulkan/streamer.h"

#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/gray_source.h"
#include "support/test.h"

#include <string.h>

static uint32_t binds_per_call; /* 0: default */
static bool uses_upload_queue;
static uint32_t binds_in_parts; /* frames of the last run that made several calls */

enum { TEXTURES = 4, MAX_TILES = 512, HISTORY = 64, FRAMES_IN_FLIGHT = 6 };

struct tile {
    VkDeviceMemory memory; ///< VK_NULL_HANDLE: unbound
    uint64_t offset;
    uint64_t batch;        ///< batch of the last change
    VkDeviceMemory before; ///< memory before that change
    bool copied;           ///< true: copied since it was bound
};

struct texture {
    bool used;
    SluiceVulkanTexture texture;
    SluiceImageSource *source;
    SluiceStreamedTextureLayout layout;
    struct tile tiles[MAX_TILES];
    bool visible[HISTORY][MAX_TILES]; ///< by frame
    uint64_t removed_frame;           ///< for removed textures
    bool removed;
    uint64_t upload_value; ///< upload value of the last copy on the upload queue
};

struct model {
    struct fake_vulkan fake;
    SluiceVulkanStreamer *streamer;
    struct texture textures[2 * TEXTURES]; ///< removed textures stay until their image is destroyed
    uint64_t frame;
    uint64_t submitted;        ///< last submitted frame
    bool abandoned[HISTORY];   ///< by frame
    uint32_t abandon_one_in;   ///< one frame in this many; 0: none
    uint32_t abandoned_in_all; ///< abandoned frames in total
    uint32_t heaps_freed, added;
    uint32_t window;        ///< seed of the visible window
    uint32_t shrink_one_in; ///< one frame in this many changes the budget or empties heaps; 0: none
    uint32_t moved;         ///< tiles moved by emptying heaps
    uint32_t frames_in_parts; ///< frames that made several calls
};

/* Returns a few requested regions that change with the window. */
static uint8_t want(void *user, uint32_t region)
{
    const struct model *m = user;
    uint32_t h = (region / 6 + m->window) * 0x9E3779B1u;
    h ^= h >> 15;
    return h % 4 == 0 ? (uint8_t)(h >> 8 & 3) : SLUICE_MIP_UNTOUCHED;
}

static void model_add(struct model *m)
{
    const uint32_t sizes[][2] = {{1024, 1024}, {1500, 700}, {2048, 256}, {100, 100}, {512, 1000}};
    uint32_t i = 0;
    while (i < 2 * TEXTURES && (m->textures[i].used || m->textures[i].removed))
        i++;
    if (i == 2 * TEXTURES)
        return; /* removed textures still exist */
    const uint32_t *size = sizes[roll() % 5];
    struct texture *t = &m->textures[i];
    m->added++;
    *t = (struct texture){.used = true};
    t->source = gray_source(size[0], size[1]);
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = t->source};
    CHECK_OK(sluiceAddVulkanTexture(m->streamer, &create, &t->texture));
    t->layout.structSize = sizeof t->layout;
    CHECK_OK(sluiceGetTextureLayout(manager_of(m->streamer), t->texture.textureId, &t->layout));
    assert_true(t->layout.tileCount <= MAX_TILES);
}

static struct texture *find_image(struct model *m, VkImage image)
{
    for (uint32_t i = 0; i < 2 * TEXTURES; i++)
        if ((m->textures[i].used || m->textures[i].removed) &&
            m->textures[i].texture.image == image)
            return &m->textures[i];
    fail_msg("an image that is gone");
    return NULL;
}

static uint32_t tile_index(const struct texture *t, uint32_t level, uint32_t x, uint32_t y)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    if (level == FAKE_TAIL)
        return l->regularTileCount + x;
    if (level >= l->desc.regularMipCount)
        return l->regularTileCount + level - l->desc.regularMipCount;
    return l->levelFirstTile[level] + y * l->levelWidthInTiles[level] + x;
}

/* Checks that no incomplete earlier frame may show the tile. */
static void check_unseen(const struct model *m, const struct texture *t, uint32_t tile)
{
    for (uint64_t f = m->fake.frame_value + 1; f < m->frame; f++)
        if (t->visible[f % HISTORY][tile])
            fail_msg("frame %llu rebinds tile %u, which frame %llu may still read",
                     (unsigned long long)m->frame, tile, (unsigned long long)f);
}

/* Checks that no other tile is on this tile's page. */
static void check_page(const struct model *m, const struct tile *tile)
{
    for (uint32_t i = 0; i < 2 * TEXTURES && tile->memory; i++)
        for (uint32_t j = 0; j < m->textures[i].layout.tileCount; j++) {
            const struct tile *other = &m->textures[i].tiles[j];
            assert_false(other != tile && other->memory == tile->memory &&
                         other->offset == tile->offset);
        }
}

static void take_destroyed(struct model *m)
{
    for (uint32_t d = 0; d < m->fake.destroyed_count; d++) {
        struct texture *t = find_image(m, m->fake.destroyed_images[d]);
        assert_true(t->removed);
        assert_true(t->removed_frame <= m->fake.frame_value);
        assert_true(t->upload_value <= m->fake.upload_value);
        for (uint32_t i = 0; i < t->layout.tileCount; i++)
            assert_true(t->tiles[i].batch <= m->fake.bind_value);
        sluiceDestroyImageSource(t->source);
        *t = (struct texture){0};
    }
}

static void take_binds(struct model *m)
{
    for (uint32_t i = 0; i < m->fake.bind_count; i++) {
        const struct fake_bind *bind = &m->fake.binds[i];
        struct texture *t = find_image(m, bind->image);
        uint32_t index = tile_index(t, bind->level, bind->x, bind->y);
        check_unseen(m, t, index);
        struct tile *tile = &t->tiles[index];
        assert_true(tile->batch < m->fake.submitted_bind_value); /* at most once per batch */
        *tile = (struct tile){bind->memory, bind->offset, m->fake.submitted_bind_value,
                              tile->memory, false};
    }
    assert_true(m->fake.bind_calls <= 1 || binds_per_call);
    m->frames_in_parts += m->fake.bind_calls > 1;
    for (uint32_t i = 0; i < m->fake.bind_count; i++) { /* when all of them are done */
        const struct fake_bind *bind = &m->fake.binds[i];
        const struct texture *t = find_image(m, bind->image);
        check_page(m, &t->tiles[tile_index(t, bind->level, bind->x, bind->y)]);
    }
}

/* Images that were destroyed have been removed from the model before. */
static void take_freed(struct model *m)
{
    for (uint32_t f = 0; f < m->fake.freed_count; f++)
        for (uint32_t i = 0; i < 2 * TEXTURES; i++)
            for (uint32_t j = 0; j < m->textures[i].layout.tileCount; j++) {
                const struct tile *tile = &m->textures[i].tiles[j];
                assert_true(tile->memory != m->fake.freed_memories[f]);
                assert_true(tile->before != m->fake.freed_memories[f] ||
                            tile->batch <= m->fake.bind_value);
            }
    m->heaps_freed += m->fake.freed_count;
}

static void check_copied_into(const struct model *m, const struct tile *tile)
{
    assert_true(tile->memory != VK_NULL_HANDLE);
    assert_true(tile->batch <= m->fake.bind_value);
}

/* `early`: copies on the upload queue; otherwise copies of the frame. */
static void take_copies(struct model *m, bool early)
{
    for (uint32_t i = 0; i < m->fake.copy_count; i++) {
        const struct fake_copy *copy = &m->fake.copies[i];
        if (copy->early != early)
            continue;
        struct texture *t = find_image(m, copy->image);
        const SluiceStreamedTextureLayout *l = &t->layout;
        if (early)
            t->upload_value = m->fake.submitted_upload_value;
        if (copy->level < l->desc.regularMipCount) {
            struct tile *tile = &t->tiles[tile_index(t, copy->level, copy->x, copy->y)];
            check_copied_into(m, tile);
            if (early)
                check_unseen(m, t, (uint32_t)(tile - t->tiles));
            tile->copied = true;
            continue;
        }
        for (uint32_t j = l->regularTileCount; j < l->tileCount; j++) {
            check_copied_into(m, &t->tiles[j]);
            if (early)
                check_unseen(m, t, j);
            t->tiles[j].copied = true;
        }
    }
}

static uint32_t take_visible(struct model *m)
{
    uint32_t count = 0;
    const SluiceStreamedTextureManager *manager = manager_of(m->streamer);
    for (uint32_t i = 0; i < 2 * TEXTURES; i++) {
        struct texture *t = &m->textures[i];
        for (uint32_t j = 0; t->removed && j < t->layout.tileCount; j++)
            t->visible[m->frame % HISTORY][j] = false; /* no longer drawn */
        for (uint32_t j = 0; t->used && j < t->layout.tileCount; j++) {
            SluiceTileState state;
            CHECK_OK(sluiceGetTileState(manager, t->texture.textureId, j, &state, NULL));
            bool shown = state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY;
            t->visible[m->frame % HISTORY][j] = shown;
            if (!shown)
                continue;
            count++;
            check_copied_into(m, &t->tiles[j]);
            assert_true(t->tiles[j].copied);
        }
    }
    return count;
}

static uint32_t frames_under_way(const struct model *m)
{
    uint32_t count = 0;
    for (uint64_t f = m->fake.frame_value + 1; f <= m->frame; f++)
        count += !m->abandoned[f % HISTORY];
    return count;
}

/* The timeline never stops at an abandoned frame. */
static uint64_t advance_frames(const struct model *m, uint64_t value)
{
    while (value > m->fake.frame_value && m->abandoned[value % HISTORY])
        value--;
    return value;
}

static bool is_visible(const struct model *m, const struct fake_copy *copy)
{
    for (uint32_t i = 0; i < 2 * TEXTURES; i++) {
        const struct texture *t = &m->textures[i];
        if (t->used && t->texture.image == copy->image)
            return copy->level >= t->layout.desc.regularMipCount ||
                   t->visible[m->frame % HISTORY][tile_index(t, copy->level, copy->x, copy->y)];
    }
    return false;
}

/* Every copied tile is shown: a hidden tile's page may belong to another tile by now. */
static void check_copies_are_shown(const struct model *m)
{
    for (uint32_t i = 0; i < m->fake.copy_count; i++)
        assert_true(m->fake.copies[i].early || is_visible(m, &m->fake.copies[i]));
}

/* Undoes the last frames, one or several. */
static void abandon(struct model *m, const SluiceStreamingFrame *first)
{
    CHECK_OK(sluiceAbandonStreamingFrame(m->streamer, first));
    CHECK_RESULT(sluiceAbandonStreamingFrame(m->streamer, first), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceEndStreamingFrame(m->streamer, fake_vulkan_commands(&m->fake)),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    for (uint64_t f = first->frameIndex; f <= m->frame; f++) {
        m->abandoned[f % HISTORY] = true;
        m->abandoned_in_all++;
    }
}

static uint64_t advance(uint64_t value, uint64_t end)
{
    return value + (uint64_t)roll() % (end - value + 1);
}

static SluiceResult begin(struct model *m, uint64_t time, SluiceStreamingFrame *frame)
{
    struct fake_vulkan *fake = &m->fake;
    fake->bind_count = fake->copy_count = fake->destroyed_count = 0;
    fake->freed_count = fake->bind_calls = 0;
    fake->published = false;
    fake->frame_value = advance_frames(
        m, advance(fake->frame_value, m->frame < m->submitted ? m->frame : m->submitted));
    if (roll() % 4 == 0) /* sometimes slow, so that batches accumulate */
        fake->bind_value = advance(fake->bind_value, fake->submitted_bind_value);
    if (uses_upload_queue)
        fake->upload_value = advance(fake->upload_value, fake->submitted_upload_value);
    fake->now_frame = m->frame + 1;
    if (roll() % 2)
        CHECK_OK(sluiceWaitVulkanStreamerIdle(m->streamer)); /* waits for reads */
    SluiceResult result =
        sluiceBeginStreamingFrame(m->streamer, fake_vulkan_commands(fake), time, frame);
    if (result == SLUICE_NOT_READY) {
        assert_int_equal(frames_under_way(m), FRAMES_IN_FLIGHT);
        return result;
    }
    CHECK_OK(result);
    fake->frame_semaphore = frame->semaphore;
    assert_int_equal(frame->frameIndex, m->frame + 1);
    m->frame = frame->frameIndex;
    m->abandoned[m->frame % HISTORY] = false;
    for (uint32_t i = 0; i < 2 * TEXTURES; i++) /* an abandoned frame shows nothing */
        memset(m->textures[i].visible[m->frame % HISTORY], 0, MAX_TILES * sizeof(bool));
    take_destroyed(m);
    take_freed(m); /* before the binds of this frame */
    take_binds(m);
    take_copies(m, true);
    assert_int_equal(frame->uploadValue, fake->upload_value);
    CHECK_RESULT(sluiceBeginStreamingFrame(m->streamer, fake_vulkan_commands(fake), time, frame),
                 SLUICE_ERROR_INVALID_ARGUMENT);
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
    abandon(m, &first);
}

static uint32_t model_frame(struct model *m, uint64_t time)
{
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    while (m->abandon_one_in && m->frame + 4 - m->fake.frame_value < HISTORY &&
           roll() % m->abandon_one_in == 0)
        abandoned_frames(m, time);
    if (begin(m, time, &frame) != SLUICE_SUCCESS)
        return 0;
    take_copies(m, false);
    uint32_t visible = take_visible(m);
    check_copies_are_shown(m);
    CHECK_OK(sluiceEndStreamingFrame(m->streamer, fake_vulkan_commands(&m->fake)));
    return visible;
}

static void remove_any(struct model *m)
{
    struct texture *t = &m->textures[roll() % (2 * TEXTURES)];
    if (!t->used)
        return;
    CHECK_OK(sluiceRemoveVulkanTexture(m->streamer, t->texture.textureId));
    t->used = false;
    t->removed = true;
    t->removed_frame = m->frame;
    model_add(m);
}

/* Releases heaps like an application that needs memory. Some tiles are requested again at once. */
static void release_heaps(struct model *m)
{
    SluiceStreamedTextureManager *manager = manager_of(m->streamer);
    uint32_t heaps[8], count = 8;
    CHECK_OK(sluiceTrimStandbyTiles(manager, 0));
    SluiceResult result = sluiceGetEmptyHeaps(manager, &count, heaps);
    assert_true(result >= 0);
    for (uint32_t i = 0; i < count; i++)
        CHECK_OK(sluiceReleaseHeap(manager, heaps[i]));
}

#define HEAP_SIZE (64u * 65536u)

/* Sets a budget of 1 to 5 heaps or none, or compacts tiles. */
static void change_memory(struct model *m)
{
    uint32_t count = 0;
    if (roll() % 3) {
        CHECK_OK(
            sluiceSetVulkanMemoryBudget(m->streamer->context, (uint64_t)roll() % 6 * HEAP_SIZE));
        return;
    }
    CHECK_OK(sluiceCompactVulkanStreamer(m->streamer, (uint32_t)roll() % 20, &count));
    assert_true(count < 20);
    m->moved += count;
}

static uint64_t freed_in_all;

struct memory_plan {
    uint32_t heap_capacity, heaps, shrink_one_in;
};

static void run_plan(uint32_t tail_page_count, uint64_t metadata_size,
                     const struct memory_plan *plan, unsigned seed, uint32_t abandon_one_in)
{
    uint32_t heap_capacity = plan->heap_capacity, heaps = plan->heaps;
    static struct model model; /* large */
    struct model *m = &model;
    *m = (struct model){.fake = {.tail_page_count = tail_page_count,
                                 .metadata_size = metadata_size,
                                 .maxBindsPerCall = binds_per_call,
                                 .has_upload_queue = uses_upload_queue,
                                 .want = want,
                                 .user = m},
                        .submitted = UINT64_MAX,
                        .abandon_one_in = abandon_one_in,
                        .shrink_one_in = plan->shrink_one_in};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_SPARSE,
                                           .framesInFlight = FRAMES_IN_FLIGHT,
                                           .tilesPerFrame = 24,
                                           .maxTextureCount = 3 * TEXTURES,
                                           .texturesPerFrame = 3,
                                           .heapTileCapacity = heap_capacity,
                                           .maxHeapCount = heaps,
                                           .feedbackTimeoutTicks = 2,
                                           .maxRegionCount = 1 << 14};
    fake_vulkan_fill(&info);
    CHECK_OK(fake_vulkan_create(&m->fake, &info, &m->streamer));
    roll_seed(seed);
    for (int i = 0; i < TEXTURES; i++)
        model_add(m);
    uint64_t shown = 0;
    for (uint64_t step = 1; step <= 1500; step++) {
        /* back and forth: tiles are wanted again just after they were given up */
        if (step % 3 == 0)
            m->window = (uint32_t)roll() % (step % 500 < 250 ? 2 : 40);
        if (step % 50 == 0)
            remove_any(m);
        if (step % 7 == 0 && !m->shrink_one_in)
            release_heaps(m);
        if (m->shrink_one_in && (uint32_t)roll() % m->shrink_one_in == 0)
            change_memory(m);
        shown += model_frame(m, step);
    }
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(m->streamer, &stats);
    assert_true(shown > 10000);
    assert_true(stats.tilesUnmapped > 50);
    assert_true(stats.unbinds + stats.unbindsSaved > 50);
    assert_true(stats.unbindsSaved > 0);
    assert_true((stats.uploadQueueCopies > 500) == uses_upload_queue);
    binds_in_parts = m->frames_in_parts;
    assert_true(stats.tilesRestored > 100);
    assert_true(!abandon_one_in || m->abandoned_in_all > 500);
    assert_in_range(m->fake.frame_value, 1000, m->frame); /* the timeline went on */
    /* once each, but for those that came last */
    assert_in_range(m->fake.metadata_binds, metadata_size ? m->added - 2 * TEXTURES : 0,
                    metadata_size ? m->added : 0);
    assert_true(!m->shrink_one_in || m->heaps_freed > 3);
    freed_in_all += m->heaps_freed;
    /* whatever is bound now is never looked at again */
    m->fake.destroyed_count = 0;
    fake_vulkan_destroy(m->streamer);
    assert_int_equal(m->fake.live_objects, 0);
    assert_int_equal(m->fake.live_memory, 0);
    for (uint32_t i = 0; i < 2 * TEXTURES; i++)
        sluiceDestroyImageSource(m->textures[i].source);
}

static void run_abandoning(uint32_t tail_page_count, uint64_t metadata_size, uint32_t heap_capacity,
                           uint32_t heaps, unsigned seed, uint32_t abandon_one_in)
{
    const struct memory_plan plan = {heap_capacity, heaps, 0};
    run_plan(tail_page_count, metadata_size, &plan, seed, abandon_one_in);
}

static void promises_hold_while_the_budget_changes(void **state)
{
    (void)state;
    const struct memory_plan small = {16, 0, 20}, usual = {32, 0, 40};
    run_plan(1, 0, &small, 51, 0);
    run_plan(2, 0, &usual, 52, 0);
    run_plan(0, 0, &small, 53, 3);
}

static void run(uint32_t tail_page_count, uint64_t metadata_size, uint32_t heap_capacity,
                uint32_t heaps, unsigned seed)
{
    run_abandoning(tail_page_count, metadata_size, heap_capacity, heaps, seed, 0);
}

static void promises_hold_where_frames_are_abandoned(void **state)
{
    (void)state;
    run_abandoning(0, 0, 64, 6, 46, 3);
    run_abandoning(2, 196608, 32, 3, 47, 2);
}

/* The loader's threads decide which run empties a heap. */
static void heaps_were_freed_in_some_run(void **state)
{
    (void)state;
    assert_true(freed_in_all > 0);
}

static void promises_hold_without_a_tail(void **state)
{
    (void)state;
    run(0, 0, 64, 6, 41);
}

static void promises_hold_with_a_tail_of_one_page(void **state)
{
    (void)state;
    run(1, 0, 64, 6, 42);
}

static void promises_hold_with_a_tail_of_many_pages_and_little_memory(void **state)
{
    (void)state;
    run(5, 0, 32, 3, 43);
}

static void promises_hold_with_metadata_that_is_bound_once(void **state)
{
    (void)state;
    run(1, 196608, 64, 6, 45);
}

/* The binding queue stops between two calls of a frame as often as between frames. */
static void promises_hold_where_a_call_binds_two_regions(void **state)
{
    (void)state;
    binds_per_call = 2;
    run(1, 196608, 64, 6, 48);
    binds_per_call = 0;
    assert_true(binds_in_parts > 100);
}

static void promises_hold_with_room_for_everything(void **state)
{
    (void)state;
    run(2, 0, 256, 0, 44);
}

/* Its regions still hold requests for a removed texture. The next resolve clears them. */
static void texture_added_inside_a_frame_has_no_feedback_in_it(void **state)
{
    (void)state;
    static struct model model; /* large */
    struct model *m = &model;
    *m = (struct model){.fake = {.tail_page_count = 1, .want = want, .user = m}};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_SPARSE,
                                           .maxRegionCount = 1 << 10,
                                           .feedbackTimeoutTicks = 2};
    fake_vulkan_fill(&info);
    CHECK_OK(fake_vulkan_create(&m->fake, &info, &m->streamer));
    for (uint64_t i = 1; i <= 3; i++) {
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        VkCommandBuffer commands = fake_vulkan_commands(&m->fake);
        CHECK_OK(sluiceBeginStreamingFrame(m->streamer, commands, i, &frame));
        if (i == 1)
            model_add(m);
        CHECK_OK(sluiceEndStreamingFrame(m->streamer, commands));
        m->fake.frame_semaphore = frame.semaphore;
        m->fake.frame_value = frame.signalValue;
        SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
        sluiceGetVulkanStreamerStatistics(m->streamer, &stats);
        assert_int_equal(stats.feedbackMaps,
                         i == 3); /* map of the second frame, read in the third */
    }
    fake_vulkan_destroy(m->streamer);
    sluiceDestroyImageSource(m->textures[0].source);
    assert_int_equal(m->fake.live_objects, 0);
}

/* Pages of the tails of three layers: two each, one stride apart. Metadata once per layer. */
static void layers_of_an_array_bind_tails_and_metadata_of_their_own(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    fake = (struct fake_vulkan){.tail_page_count = 2, .metadata_size = 131072, .want = want};
    struct model window = {.window = 1};
    fake.user = &window;
    SluiceImageInfo gray = {sizeof gray, 300, 200, 0, SLUICE_FORMAT_R8G8B8A8_UNORM, "gray"};
    SluiceImageSource *layer, *array;
    layer = gray_source_with(&gray);
    CHECK_OK(sluiceCreateArrayImageSource((SluiceImageSource *[]){layer, layer, layer}, 3, NULL,
                                          &array));
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .maxRegionCount = 1 << 10, .maxTextureCount = 4};
    fake_vulkan_fill(&info);
    SluiceVulkanStreamer *streamer;
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = array};
    SluiceVulkanTexture textures[3];
    CHECK_OK(sluiceAddVulkanTextureArray(streamer, &create, 3, textures));
    uint32_t seen[3] = {0}, stride = (uint32_t)(FAKE_TAIL_STRIDE / 65536);
    for (uint64_t i = 1; i <= 6; i++) {
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        fake.bind_count = fake.copy_count = 0;
        fake.published = false;
        CHECK_OK(sluiceWaitVulkanStreamerIdle(streamer));
        CHECK_OK(sluiceBeginStreamingFrame(streamer, fake_vulkan_commands(&fake), i, &frame));
        for (uint32_t b = 0; b < fake.bind_count; b++)
            if (fake.binds[b].level == FAKE_TAIL) {
                assert_true(fake.binds[b].x / stride < 3 && fake.binds[b].x % stride < 2);
                seen[fake.binds[b].x / stride] |= 1u << fake.binds[b].x % stride;
            }
        CHECK_OK(sluiceEndStreamingFrame(streamer, fake_vulkan_commands(&fake)));
        fake.frame_semaphore = frame.semaphore;
        fake.frame_value = i;
        fake.bind_value = fake.submitted_bind_value;
    }
    assert_int_equal(fake.metadata_binds, 3);
    for (uint32_t i = 0; i < 3; i++)
        assert_int_equal(seen[i], 3);
    fake_vulkan_destroy(streamer);
    sluiceDestroyImageSource(array);
    sluiceDestroyImageSource(layer);
    assert_int_equal(fake.live_objects, 0);
    assert_int_equal(fake.live_memory, 0);
}

static void promises_hold_with_an_upload_queue(void **state)
{
    (void)state;
    const struct memory_plan small = {16, 0, 20};
    uses_upload_queue = true;
    run_plan(1, 0, &small, 61, 0);
    run_abandoning(2, 65536, 256, 0, 63, 3);
    uses_upload_queue = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(promises_hold_without_a_tail),
        cmocka_unit_test(promises_hold_with_a_tail_of_one_page),
        cmocka_unit_test(promises_hold_with_a_tail_of_many_pages_and_little_memory),
        cmocka_unit_test(promises_hold_with_metadata_that_is_bound_once),
        cmocka_unit_test(promises_hold_where_a_call_binds_two_regions),
        cmocka_unit_test(promises_hold_with_room_for_everything),
        cmocka_unit_test(promises_hold_where_frames_are_abandoned),
        cmocka_unit_test(promises_hold_while_the_budget_changes),
        cmocka_unit_test(heaps_were_freed_in_some_run),
        cmocka_unit_test(layers_of_an_array_bind_tails_and_metadata_of_their_own),
        cmocka_unit_test(texture_added_inside_a_frame_has_no_feedback_in_it),
        cmocka_unit_test(promises_hold_with_an_upload_queue),
    };
    return RUN_TESTS(tests);
}
