/* Textures: shown levels, opened and read images, and ids. */
#include "demand_vulkan/loader.h"
#include "device/demand_runner.h"

#include "support/test.h"

#include <sluice/demand_query.h>

#include <sched.h>
#include <string.h>

static struct harness h;

struct size {
    uint32_t width, height;
};

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

/* Lists texels of a level, at its corners and in between. Returns their number. */
static uint32_t texels_of(uint32_t width, uint32_t height, uint32_t level, uint32_t (*at)[2])
{
    uint32_t count = 0, w = level_size(width, level), x_of[3] = {0, w / 3, w - 1};
    uint32_t t = level_size(height, level), y_of[3] = {0, 2 * t / 3, t - 1};
    for (uint32_t i = 0; i < 9; i++, count++) {
        at[count][0] = x_of[i % 3];
        at[count][1] = y_of[i / 3];
    }
    return count;
}

static void add_all_levels(struct runner *r, SluiceDemandTextureId id, const SluiceImageInfo *info)
{
    uint32_t at[9][2];
    for (uint32_t l = 0; l < info->mipLevelCount; l++)
        for (uint32_t i = 0, n = texels_of(info->width, info->height, l, at); i < n; i++)
            runner_add_texel(r, id, info->width, info->height, l, at[i][0], at[i][1]);
}

static uint32_t check_all_levels(struct runner *r, struct runner_image *image, uint32_t sample)
{
    uint32_t at[9][2];
    for (uint32_t l = 0; l < image->info.mipLevelCount; l++)
        for (uint32_t i = 0, n = texels_of(image->info.width, image->info.height, l, at); i < n;
             i++)
            runner_check_texel(r, sample++, image, l, at[i][0], at[i][1]);
    return sample;
}

static void colors_are_the_images_own_when_nothing_is_missing(void **state)
{
    (void)state;
    static const struct size sizes[] = {{1, 1},     {64, 64},    {65, 64},   {1000, 700},
                                        {513, 129}, {16384, 1},  {1, 3000},  {2048, 2048},
                                        {255, 257}, {128, 4097}, {4095, 255}};
    enum { COUNT = sizeof sizes / sizeof sizes[0] };
    static struct runner_image images[2 * COUNT];
    SluiceDemandTextureId ids[2 * COUNT];
    struct runner r;
    runner_init(&r, &h, NULL);
    for (uint32_t i = 0; i < 2 * COUNT; i++) {
        runner_image_init(&images[i],
                          i % 2 ? SLUICE_FORMAT_R32G32B32A32_SFLOAT : SLUICE_FORMAT_R8G8B8A8_UNORM,
                          sizes[i / 2].width, sizes[i / 2].height, i);
        ids[i] = runner_add_texture(&r, &images[i]);
        add_all_levels(&r, ids[i], &images[i].info);
    }
    assert_in_range(runner_load(&r, 20), 3, 19);
    for (uint32_t i = 0, sample = 0; i < 2 * COUNT; i++)
        sample = check_all_levels(&r, &images[i], sample);
    assert_true(runner_all_resident(&r));
    runner_finish(&r);
    for (uint32_t i = 0; i < 2 * COUNT; i++) {
        assert_int_equal(images[i].opened, 1);
        assert_int_equal(images[i].closed, 1);
        runner_image_finish(&images[i]);
    }
}

static void only_what_is_sampled_is_opened_and_only_its_tiles_are_read(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image images[3];
    SluiceDemandTextureId ids[3];
    runner_init(&r, &h, NULL);
    for (uint32_t i = 0; i < 3; i++) {
        runner_image_init(&images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, 1024, 1024, i);
        ids[i] = runner_add_texture(&r, &images[i]);
    }
    /* Three tiles of level 0, one of level 2: 128 x 128 texels each. */
    runner_add_texel(&r, ids[1], 1024, 1024, 0, 5, 5);
    runner_add_texel(&r, ids[1], 1024, 1024, 0, 100, 120);
    runner_add_texel(&r, ids[1], 1024, 1024, 0, 130, 5);
    runner_add_texel(&r, ids[1], 1024, 1024, 0, 1000, 1000);
    runner_add_texel(&r, ids[1], 1024, 1024, 2, 200, 3);
    runner_load(&r, 20);
    assert_true(runner_all_resident(&r));
    assert_int_equal(images[0].opened + images[2].opened, 0);
    assert_int_equal(images[0].source.info_count + images[2].source.info_count, 0);
    assert_int_equal(images[1].source.read_count, 1 + 4); /* first the color of the last level */
    SluiceDemandStatistics statistics = runner_statistics(&r);
    assert_int_equal(statistics.residentTileCount, 4);
    assert_int_equal(statistics.texturesCreated, 3);
    assert_int_equal(statistics.texturesOpened, 1);
    assert_int_equal(statistics.bytesRead, 4 * 65536);
    assert_int_equal(statistics.bytesUploaded, 4 * 65536);
    /* An equal launch costs nothing. */
    runner_launch(&r);
    assert_int_equal(r.requests.missingCount, 0);
    assert_int_equal(r.launch.tileCount, 0);
    assert_int_equal(r.ticket, 0);
    runner_finish(&r);
    for (uint32_t i = 0; i < 3; i++)
        runner_image_finish(&images[i]);
}

static SluiceDemandTileInfo tile_info(struct runner *r, SluiceDemandTextureId id, uint32_t level,
                                      uint32_t x, uint32_t y)
{
    SluiceDemandTileInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetDemandTileInfo(r->loader, id, level, x, y, &info));
    return info;
}

static void tiles_and_misses_are_told(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandMiss misses[8];
    uint32_t count = 8;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 1000, 700, 5);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    CHECK_OK(sluiceGetDemandMisses(r.loader, &count, misses));
    assert_true(count == 0 && !tile_info(&r, id, 0, 999, 699).isOpen);
    runner_add_texel(&r, id, 1000, 700, 0, 999, 699); /* tile 7, 5 */
    runner_add_texel(&r, id, 1000, 700, 2, 130, 3);   /* tile 1, 0 */
    runner_add_texel(&r, id, 1000, 700, 5, 3, 3);     /* mip tail */
    runner_launch(&r);
    CHECK_OK(sluiceGetDemandMisses(r.loader, &(uint32_t){8}, misses));
    assert_true(misses[0].kind == SLUICE_DEMAND_MISS_OPENING && misses[0].id == id);
    CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    runner_launch(&r); /* notices that it is open */
    for (uint32_t i = 0; i < 8 && (i == 0 || count < 3); i++, runner_launch(&r)) {
        CHECK_OK(sluiceGetDemandMisses(r.loader, (count = 8, &count), misses));
        if (count == 3)
            break;
    }
    assert_int_equal(count, 3); /* coarse ones first */
    assert_true(misses[0].kind == SLUICE_DEMAND_MISS_TAIL && misses[0].level == 4);
    assert_true(misses[1].level == 2 && misses[1].x == 1 && misses[1].y == 0);
    assert_true(misses[2].level == 0 && misses[2].x == 7 && misses[2].y == 5);
    const SluiceDemandTileInfo last = tile_info(&r, id, 0, 999, 699),
                               other = tile_info(&r, id, 0, 0, 0),
                               tail = tile_info(&r, id, 9, 0, 0);
    assert_true(last.page == misses[2].page && last.state == SLUICE_DEMAND_PAGE_PENDING);
    assert_true(last.x == 896 && last.y == 640 && last.width == 104 && last.height == 60);
    assert_true(other.state == SLUICE_DEMAND_PAGE_ABSENT && other.page == last.page - 47);
    assert_true(tail.isTail && tail.level == 4 && tail.page == misses[0].page);
    assert_true(tail.width == 62 && tail.height == 43);
    runner_load(&r, 20);
    CHECK_OK(sluiceGetDemandMisses(r.loader, &count, NULL));
    assert_true(count == 0 && tile_info(&r, id, 0, 900, 650).state == SLUICE_DEMAND_PAGE_RESIDENT);
    assert_int_equal(tile_info(&r, id, 30, 0, 0).state, SLUICE_DEMAND_PAGE_RESIDENT);
    SluiceDemandTileInfo info = {.structSize = sizeof info};
    CHECK_RESULT(sluiceGetDemandTileInfo(r.loader, id, 1, 500, 0, &info),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    runner_finish(&r);
    runner_image_finish(&image);
}

/* Counts the entries of a tile. Returns the last one. */
static uint32_t slots_of(const SluiceDemandSlot *slots, uint32_t count, uint32_t page,
                         SluiceDemandSlot *found)
{
    uint32_t entries = 0;
    for (uint32_t i = 0; i < count; i++)
        if (slots[i].page == page) {
            *found = slots[i];
            entries++;
        }
    return entries;
}

/* Checks that all entries name tiles as in sluiceGetDemandTileInfo, in slots of existing images. */
static void check_slots(struct runner *r, SluiceDemandTextureId id, uint32_t size)
{
    static SluiceDemandSlot slots[1024];
    static bool taken[64][2048];
    SluiceDemandSlotImage images[64];
    uint32_t count = 1024, image_count = 64, resident = 0, held = 0, used = 0;
    CHECK_OK(sluiceGetDemandSlots(r->loader, &count, slots));
    CHECK_OK(sluiceGetDemandSlotImages(r->loader, &image_count, images));
    memset(taken, 0, sizeof taken);
    for (uint32_t i = 0; i < count; i++) {
        const SluiceDemandSlot *s = &slots[i];
        const SluiceDemandTileInfo info = tile_info(r, id, s->level, 128 * s->x, 128 * s->y);
        assert_true(s->textureId == id && s->page == info.page && s->isTail == info.isTail);
        assert_true((s->state == SLUICE_DEMAND_SLOT_RESIDENT) ==
                    (info.state == SLUICE_DEMAND_PAGE_RESIDENT));
        assert_true(s->image < 64 && s->layer < 2048 && !taken[s->image][s->layer]);
        taken[s->image][s->layer] = true;
        resident += s->state == SLUICE_DEMAND_SLOT_RESIDENT;
        held += s->state != SLUICE_DEMAND_SLOT_STANDBY;
        uint32_t at = 0;
        while (at < image_count && images[at].image != s->image)
            at++;
        assert_true(at < image_count && s->layer < images[at].slotCount &&
                    images[at].format == SLUICE_FORMAT_R8G8B8A8_UNORM);
    }
    for (uint32_t i = 0; i < image_count; i++)
        used += images[i].usedSlotCount;
    assert_int_equal(used, held);
    for (uint32_t l = 0; size >> l >= 128; l++)
        for (uint32_t i = 0, side = size >> l >> 7; i < side * side; i++) {
            SluiceDemandSlot found = {0};
            const SluiceDemandTileInfo info =
                tile_info(r, id, l, 128 * (i % side), 128 * (i / side));
            if (info.state == SLUICE_DEMAND_PAGE_RESIDENT)
                assert_int_equal(slots_of(slots, count, info.page, &found), 1);
        }
    assert_true(resident == runner_statistics(r).residentTileCount);
}

/* The oracle is the state of each tile. 64 slots for 512 tiles: most are evicted. */
static void each_resident_tile_has_one_slot(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 4u << 20};
    SluiceDemandSlot slot;
    uint32_t count = 7;
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 2048, 2048, 5);
    const SluiceDemandTextureId id = runner_add_texture(&r, &image);
    CHECK_OK(sluiceGetDemandSlots(r.loader, &count, NULL));
    assert_int_equal(count, 0);
    for (uint32_t row = 0; row < 16; row += 2) {
        runner_clear(&r);
        runner_add_tiles(&r, id, 2048, row, 2);
        runner_load(&r, 20);
        assert_true(runner_all_resident(&r));
        check_slots(&r, id, 2048);
    }
    assert_true(runner_statistics(&r).evictedCount >= 160);
    CHECK_RESULT(sluiceGetDemandSlots(r.loader, (count = 1, &count), &slot), SLUICE_INCOMPLETE);
    assert_int_equal(count, 1);
    SluiceDemandSlotImage images[1];
    CHECK_RESULT(sluiceGetDemandSlotImages(r.loader, (count = 0, &count), images),
                 SLUICE_INCOMPLETE);
    runner_finish(&r);
    runner_image_finish(&image);
}

/* A standby tile is restored to its slot without a read. Tiles of another format evict it, but
 * cannot use its slot yet. */
static void a_tile_that_stands_by_is_restored_to_its_slot(void **state)
{
    (void)state;
    static SluiceDemandSlot slots[1024], later[1024];
    struct runner r;
    struct runner_image image, other;
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .memoryBudget = 16u << 20, .maxTilesInFlight = 64};
    uint32_t count = 1024, later_count = 1024, restored = 0;
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 4096, 4096, 1);
    runner_image_init(&other, SLUICE_FORMAT_R32G32B32A32_SFLOAT, 4096, 4096, 2);
    const SluiceDemandTextureId id = runner_add_texture(&r, &image);
    const SluiceDemandTextureId other_id = runner_add_texture(&r, &other);
    runner_add_tiles(&r, id, 4096, 0, 7);
    runner_load(&r, 30);
    const uint64_t reads = image.source.read_count;
    runner_clear(&r);
    runner_add_tiles(&r, other_id, 4096, 0, 1);
    runner_load(&r, 2);
    CHECK_OK(sluiceGetDemandSlots(r.loader, &count, slots));
    runner_clear(&r);
    runner_add_tiles(&r, id, 4096, 0, 7);
    runner_load(&r, 30);
    CHECK_OK(sluiceGetDemandSlots(r.loader, &later_count, later));
    for (uint32_t i = 0; i < count; i++) {
        SluiceDemandSlot now = {0};
        if (slots[i].textureId != id || slots[i].state != SLUICE_DEMAND_SLOT_STANDBY)
            continue;
        assert_int_equal(slots_of(later, later_count, slots[i].page, &now), 1);
        assert_true(now.state == SLUICE_DEMAND_SLOT_RESIDENT && now.image == slots[i].image &&
                    now.layer == slots[i].layer);
        restored++;
    }
    assert_true(restored > 0 && restored == runner_statistics(&r).restoredCount);
    assert_int_equal(image.source.read_count, reads);
    runner_finish(&r);
    runner_image_finish(&image);
    runner_image_finish(&other);
}

static void a_texture_smaller_than_a_pixel_needs_no_tile(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 4096, 4096, 7);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    runner_add_texel(&r, id, 4096, 4096, 12, 0, 0);
    runner_add_texel(&r, id, 4096, 4096, 30, 0, 0);
    assert_int_equal(runner_load(&r, 9), 2);
    runner_check_texel(&r, 0, &image, 12, 0, 0);
    runner_check_texel(&r, 1, &image, 12, 0, 0);
    assert_int_equal(runner_statistics(&r).residentTileCount, 0);
    assert_int_equal(runner_statistics(&r).bytesUploaded, 0);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void a_variant_shares_tiles_and_not_the_sampler(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandTextureId variant, late;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 512, 512, 3);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    SluiceDemandSampler clamp = runner_nearest;
    clamp.addressModeU = clamp.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    CHECK_OK(sluiceAddDemandTextureVariant(r.loader, id, &clamp, &variant));
    runner_add(&r, (struct RunnerInput){
                       .kind = RUNNER_LOD, .index = (uint32_t)variant, .uv = {1.001f, 0.001f}});
    runner_load(&r, 9);
    runner_check_texel(&r, 0, &image, 0, 511, 0);
    uint64_t reads = image.source.read_count;
    CHECK_OK(sluiceAddDemandTextureVariant(r.loader, variant, &clamp, &late));
    runner_clear(&r);
    runner_add_texel(&r, id, 512, 512, 0, 511, 0);
    runner_add_texel(&r, late, 512, 512, 0, 511, 0);
    assert_int_equal(runner_load(&r, 9), 1);
    runner_check_texel(&r, 0, &image, 0, 511, 0);
    runner_check_texel(&r, 1, &image, 0, 511, 0);
    assert_int_equal(image.source.read_count, reads);
    assert_int_equal(image.opened, 1);
    /* Removed with their base. */
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, late));
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, id));
    CHECK_RESULT(sluiceRemoveDemandTexture(r.loader, variant), SLUICE_ERROR_STALE_TEXTURE);
    runner_finish(&r);
    runner_image_finish(&image);
}

static uint32_t filter_bits(const struct runner *r, SluiceDemandTextureId id)
{
    const struct SluiceDemandTexture *entry = slc_table_mirror_get(&r->loader->table, (uint32_t)id);
    return entry->shape & (SLUICE_DEMAND_NEAREST | SLUICE_DEMAND_SPLINE | SLUICE_DEMAND_SMART);
}

static void shaders_see_the_filter_before_and_after_a_texture_is_opened(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 512, 512, 3);
    SluiceDemandTextureId ids[4], base = runner_add_texture(&r, &image);
    const uint32_t expected[4] = {[SLUICE_DEMAND_FILTER_NEAREST] = SLUICE_DEMAND_NEAREST,
                                  [SLUICE_DEMAND_FILTER_CUBIC] = SLUICE_DEMAND_SPLINE,
                                  [SLUICE_DEMAND_FILTER_SMART_CUBIC] =
                                      SLUICE_DEMAND_SPLINE | SLUICE_DEMAND_SMART};
    for (uint32_t i = 0; i < 4; i++) {
        SluiceDemandSampler sampler = {.structSize = sizeof sampler,
                                       .filter = (SluiceDemandFilter)i};
        CHECK_OK(sluiceAddDemandTextureVariant(r.loader, base, &sampler, &ids[i]));
        assert_int_equal(filter_bits(&r, ids[i]), expected[i]);
        runner_add_texel(&r, ids[i], 512, 512, 0, 511, 0);
    }
    runner_load(&r, 9);
    assert_true(runner_all_resident(&r));
    for (uint32_t i = 0; i < 4; i++)
        assert_int_equal(filter_bits(&r, ids[i]), expected[i]);
    runner_finish(&r);
    runner_image_finish(&image);
}

/* Zero in a sampler selects the mode that the image records, or else REPEAT. */
static void address_modes_are_those_of_the_image_unless_they_are_explicit(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image clamped, plain;
    SluiceDemandTextureId ids[3];
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = 512,
                                  .height = 512,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .addressModeU = SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  .addressModeV = SLUICE_IMAGE_ADDRESS_MODE_REPEAT};
    runner_init(&r, &h, NULL);
    runner_image_init_as(&clamped, &info, 5);
    runner_image_init(&plain, SLUICE_FORMAT_R8G8B8A8_UNORM, 512, 512, 6);
    ids[0] = runner_add_texture(&r, &clamped);
    ids[1] = runner_add_texture(&r, &plain);
    SluiceDemandTextureCreateInfo repeats = {.structSize = sizeof repeats,
                                             .image = runner_image_desc(&clamped),
                                             .pSampler = &runner_nearest};
    SluiceDemandSampler sampler = runner_nearest;
    sampler.explicitAddressModes = true;
    repeats.pSampler = &sampler;
    CHECK_OK(sluiceAddDemandTexture(r.loader, &repeats, &ids[2]));
    uint32_t told = h.log_count[SLUICE_LOG_WARNING];
    for (uint32_t i = 0; i < 3; i++)
        runner_add(&r, (struct RunnerInput){.kind = RUNNER_LOD,
                                            .index = (uint32_t)ids[i],
                                            .uv = {1 + 10.5f / 512, 1 + 20.5f / 512}});
    runner_load(&r, 9);
    runner_check_texel(&r, 0, &clamped, 0, 511, 20);
    runner_check_texel(&r, 1, &plain, 0, 10, 20);
    runner_check_texel(&r, 2, &clamped, 0, 10, 20);
    assert_int_equal(h.log_count[SLUICE_LOG_WARNING], told + 1); /* for the explicit one */
    runner_finish(&r);
    runner_image_finish(&clamped);
    runner_image_finish(&plain);
}

static void a_grid_shows_the_texture_of_each_cell(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image images[2];
    SluiceDemandTextureId cells[6] = {0}, grid;
    SluiceDemandGridCreateInfo info = {.structSize = sizeof info,
                                       .columnCount = 3,
                                       .rowCount = 2,
                                       .pTextureIds = cells,
                                       .missingColor = {0.25f, 0.5f, 0.75f, 1}};
    const float *missing = info.missingColor;
    runner_init(&r, &h, NULL);
    for (uint32_t i = 0; i < 2; i++)
        runner_image_init(&images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, 256 << i, 256, i);
    cells[1] = runner_add_texture(&r, &images[0]); /* column 1, row 0 */
    cells[5] = runner_add_texture(&r, &images[1]); /* column 2, row 1 */
    CHECK_OK(sluiceAddDemandGrid(r.loader, &info, &grid));
    const float at[5][2] = {{1 + 10.5f / 256, 20.5f / 256},
                            {2 + 300.5f / 512, 1 + 20.5f / 256},
                            {0.5f, 0.5f},
                            {-0.5f, 0.5f},
                            {1.5f, 2.5f}};
    for (uint32_t i = 0; i < 5; i++)
        runner_add(&r, (struct RunnerInput){.kind = RUNNER_LOD,
                                            .index = (uint32_t)grid,
                                            .uv = {at[i][0], at[i][1]}});
    runner_load(&r, 9);
    runner_check_texel(&r, 0, &images[0], 0, 10, 20);
    runner_check_texel(&r, 1, &images[1], 0, 300, 20);
    for (uint32_t i = 2; i < 5; i++) {
        struct RunnerOutput out = runner_output(&r, i);
        assert_true(out.resident);
        assert_memory_equal(out.color, missing, sizeof out.color);
    }
    const SluiceDemandGridCreateInfo nested = {
        .structSize = sizeof nested, .columnCount = 1, .rowCount = 1, .pTextureIds = &grid};
    CHECK_RESULT(sluiceAddDemandGrid(r.loader, &nested, &cells[0]), SLUICE_ERROR_INVALID_ARGUMENT);
    /* A removed texture leaves a hole. */
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, cells[1]));
    runner_launch(&r);
    struct RunnerOutput out = runner_output(&r, 0);
    assert_memory_equal(out.color, missing, sizeof out.color);
    runner_check_texel(&r, 1, &images[1], 0, 300, 20);
    /* Check that nothing of a removed grid is shown. */
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, grid));
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, cells[5]));
    runner_launch(&r);
    for (uint32_t i = 0; i < 5; i++) {
        out = runner_output(&r, i);
        assert_true(out.resident);
        assert_memory_equal(out.color, missing, sizeof out.color);
    }
    runner_finish(&r);
    for (uint32_t i = 0; i < 2; i++)
        runner_image_finish(&images[i]);
}

static void another_image_takes_a_textures_place_while_it_is_sampled(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image images[2];
    runner_init(&r, &h, NULL);
    runner_image_init(&images[0], SLUICE_FORMAT_R8G8B8A8_UNORM, 600, 300, 1);
    runner_image_init(&images[1], SLUICE_FORMAT_R32G32B32A32_SFLOAT, 300, 300, 2);
    SluiceDemandTextureId id = runner_add_texture(&r, &images[0]);
    runner_add_texel(&r, id, 300, 300, 0, 299, 0);
    for (uint32_t i = 0; i < 6; i++) {
        struct runner_image *image = &images[i % 2], *other = &images[1 - i % 2];
        if (i > 0) {
            SluiceDemandImage desc = runner_image_desc(image);
            uint32_t opened = image->opened;
            CHECK_OK(runner_submit(&r)); /* a launch with the old image is in flight */
            CHECK_OK(sluiceReplaceDemandImage(r.loader, id, &desc));
            assert_int_equal(image->opened, opened);
            CHECK_OK(
                sluiceProcessDemandRequests(r.loader, &r.launch, UINT64_MAX, &r.requests, NULL));
            assert_int_equal(other->closed, other->opened);
        }
        assert_in_range(runner_load(&r, 20), 2, 9);
        runner_check_texel(&r, 0, image, 0, i % 2 ? 299 : 599, 0);
    }
    runner_finish(&r);
    for (uint32_t i = 0; i < 2; i++) {
        assert_int_equal(images[i].opened, 3);
        assert_int_equal(images[i].closed, 3);
        runner_image_finish(&images[i]);
    }
}

static void texels_that_changed_are_read_again(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 500, 500, 1);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    runner_add_texel(&r, id, 500, 500, 0, 400, 400);
    runner_add_texel(&r, id, 500, 500, 5, 3, 3);
    runner_add_texel(&r, id, 500, 500, 8, 0, 0);
    runner_load(&r, 9);
    runner_check_texel(&r, 2, &image, 8, 0, 0);
    image.seed ^= 0x55555;
    CHECK_OK(sluiceInvalidateDemandTexture(r.loader, id));
    runner_load(&r, 9);
    runner_check_texel(&r, 0, &image, 0, 400, 400);
    runner_check_texel(&r, 1, &image, 5, 3, 3);
    /* The color of the last level is loaded separately. */
    float rgba[4];
    runner_image_texel(&image, 8, 0, 0, rgba);
    for (uint32_t i = 0; i < 10000 && runner_output(&r, 2).color[0] != rgba[0]; i++) {
        runner_launch(&r);
        sched_yield();
    }
    runner_check_texel(&r, 2, &image, 8, 0, 0);
    assert_int_equal(image.opened, 1);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void ids_of_destroyed_textures_are_refused_and_their_places_used_again(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image images[2];
    SluiceDemandTextureId ids[2], last;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .maxTextureCount = 2};
    runner_init(&r, &h, &info);
    for (uint32_t i = 0; i < 2; i++) {
        runner_image_init(&images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, i);
        ids[i] = runner_add_texture(&r, &images[i]);
        runner_add_texel(&r, ids[i], 300, 300, 0, 9, 9);
    }
    const SluiceDemandTextureCreateInfo create = {.structSize = sizeof create,
                                                  .image = runner_image_desc(&images[0])};
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &create, &last), SLUICE_ERROR_LIMIT_EXCEEDED);
    CHECK_RESULT(sluiceRemoveDemandTexture(r.loader, ids[1] + 1), SLUICE_ERROR_UNKNOWN_TEXTURE);
    CHECK_RESULT(sluiceRemoveDemandTexture(r.loader, 0), SLUICE_ERROR_UNKNOWN_TEXTURE);
    for (uint32_t i = 0; i < 5; i++) {
        runner_load(&r, 9);
        runner_check_texel(&r, 0, &images[0], 0, 9, 9);
        CHECK_OK(runner_submit(&r)); /* a launch that names the index */
        CHECK_OK(sluiceRemoveDemandTexture(r.loader, ids[0]));
        CHECK_RESULT(sluiceRemoveDemandTexture(r.loader, ids[0]), SLUICE_ERROR_STALE_TEXTURE);
        CHECK_RESULT(sluiceInvalidateDemandTexture(r.loader, ids[0]), SLUICE_ERROR_STALE_TEXTURE);
        CHECK_RESULT(sluiceAddDemandTexture(r.loader, &create, &last), SLUICE_ERROR_LIMIT_EXCEEDED);
        CHECK_OK(
            sluiceProcessDemandRequests(r.loader, &r.launch, UINT64_MAX, &r.requests, &r.ticket));
        last = ids[0];
        ids[0] = runner_add_texture(&r, &images[0]);
        assert_true(ids[0] != last && (uint32_t)ids[0] == (uint32_t)last);
        CHECK_RESULT(sluiceRemoveDemandTexture(r.loader, last), SLUICE_ERROR_STALE_TEXTURE);
        assert_int_equal(images[0].closed, i + 1);
    }
    runner_finish(&r);
    for (uint32_t i = 0; i < 2; i++)
        runner_image_finish(&images[i]);
}

static void textures_by_the_hundred_thousand_cost_nothing_before_they_are_sampled(void **state)
{
    (void)state;
    enum { COUNT = 100000, LAST = 99999 };
    struct runner r;
    struct runner_image image;
    static SluiceDemandTextureId ids[COUNT];
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .maxTextureCount = COUNT};
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    uint64_t memory = runner_statistics(&r).deviceMemorySize;
    for (uint32_t i = 0; i < COUNT; i++)
        ids[i] = runner_add_texture(&r, &image);
    assert_int_equal(runner_statistics(&r).deviceMemorySize, memory);
    const uint32_t some[3] = {0, 77777, LAST};
    for (uint32_t i = 0; i < 3; i++)
        runner_add_texel(&r, ids[some[i]], 300, 300, 0, i, 299);
    runner_load(&r, 9);
    for (uint32_t i = 0; i < 3; i++)
        runner_check_texel(&r, i, &image, 0, i, 299);
    assert_int_equal(image.opened, 3);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK_OK(sluiceRemoveDemandTexture(r.loader, ids[i]));
    assert_int_equal(image.closed, 3);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandTextureId id;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 64, 64, 1);
    SluiceDemandTextureCreateInfo create = {.structSize = sizeof create,
                                            .image = runner_image_desc(&image)};
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &create, NULL), SLUICE_ERROR_NULL_POINTER);
    create.pSampler =
        &(SluiceDemandSampler){.structSize = sizeof(SluiceDemandSampler), .maxAnisotropy = 65};
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &create, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    create.pSampler =
        &(SluiceDemandSampler){.structSize = sizeof(SluiceDemandSampler), .lodBias = -17};
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &create, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    create.pSampler = &(SluiceDemandSampler){.structSize = sizeof(SluiceDemandSampler),
                                             .filter = (SluiceDemandFilter)4};
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &create, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    create.pSampler = &(SluiceDemandSampler){.structSize = sizeof(SluiceDemandSampler),
                                             .mipmapFilter = SLUICE_DEMAND_FILTER_CUBIC};
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &create, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    create.image = (SluiceDemandImage){0};
    CHECK_RESULT(sluiceAddDemandTexture(r.loader, &create, &id), SLUICE_ERROR_NULL_POINTER);
    SluiceDemandLaunch none = {.structSize = sizeof none, .launchIndex = 1};
    CHECK_RESULT(sluiceProcessDemandRequests(r.loader, &none, 0, &r.requests, NULL),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceEndDemandLaunch(r.loader, h.commands[0]), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 1000};
    SluiceDemandLoader *loader;
    runner_fill(&h, &info);
    CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    info.memoryBudget = 0;
    info.launchesInFlight = 17;
    CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    info.launchesInFlight = 0;
    info.pageCapacity = 2048;
    info.maxTextureCount = 2048;
    CHECK_RESULT(sluiceCreateDemandLoader(&info, &loader), SLUICE_ERROR_LIMIT_EXCEEDED);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void launches_are_processed_once_and_in_order(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    runner_add_texel(&r, runner_add_texture(&r, &image), 300, 300, 0, 2, 2);
    CHECK_OK(runner_submit(&r));
    SluiceDemandLaunch first = r.launch;
    CHECK_OK(runner_submit(&r));
    CHECK_RESULT(runner_submit(&r), SLUICE_NOT_READY); /* two in flight */
    CHECK_OK(sluiceProcessDemandRequests(r.loader, &r.launch, UINT64_MAX, &r.requests, &r.ticket));
    assert_int_equal(r.requests.missingCount, 2); /* misses of both launches */
    assert_int_equal(r.requests.servedCount, 1);
    assert_int_equal(r.requests.pendingCount, 1);
    CHECK_RESULT(sluiceProcessDemandRequests(r.loader, &first, 0, &r.requests, NULL),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    /* Later tickets do not include pending requests. */
    CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    runner_load(&r, 9);
    runner_check_texel(&r, 0, &image, 0, 2, 2);
    runner_finish(&r);
    runner_image_finish(&image);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_are_the_images_own_when_nothing_is_missing),
        cmocka_unit_test(tiles_and_misses_are_told),
        cmocka_unit_test(each_resident_tile_has_one_slot),
        cmocka_unit_test(a_tile_that_stands_by_is_restored_to_its_slot),
        cmocka_unit_test(only_what_is_sampled_is_opened_and_only_its_tiles_are_read),
        cmocka_unit_test(a_texture_smaller_than_a_pixel_needs_no_tile),
        cmocka_unit_test(a_variant_shares_tiles_and_not_the_sampler),
        cmocka_unit_test(shaders_see_the_filter_before_and_after_a_texture_is_opened),
        cmocka_unit_test(address_modes_are_those_of_the_image_unless_they_are_explicit),
        cmocka_unit_test(a_grid_shows_the_texture_of_each_cell),
        cmocka_unit_test(another_image_takes_a_textures_place_while_it_is_sampled),
        cmocka_unit_test(texels_that_changed_are_read_again),
        cmocka_unit_test(ids_of_destroyed_textures_are_refused_and_their_places_used_again),
        cmocka_unit_test(textures_by_the_hundred_thousand_cost_nothing_before_they_are_sampled),
        cmocka_unit_test(launches_are_processed_once_and_in_order),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
