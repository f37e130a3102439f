/* Arguments that the manager refuses: its log names the call, the argument and the limit. */
#include "support/test.h"

#include <sluice/manager.h>

#include <stdio.h>
#include <string.h>

static struct {
    SluiceStreamedTextureManager *manager;
    bool locked;
    uint32_t count; ///< number of messages
    char text[256]; ///< last message
} rig;

static void keep_line(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    assert_int_equal(severity, SLUICE_LOG_ERROR);
    rig.count++;
    snprintf(rig.text, sizeof rig.text, "%s", message);
}

static void check_refused(SluiceResult result, const char *part)
{
    CHECK_RESULT(result, SLUICE_ERROR_INVALID_ARGUMENT);
    if (rig.count != 1 || !strstr(rig.text, part))
        fail_msg("%u lines, the last \"%s\", not \"%s\"", rig.count, rig.text, part);
    rig.count = 0;
}

static SluiceResult no_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    (void)user, (void)size, (void)heap_id;
    return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
}

static void no_release(void *user, uint32_t heap_id)
{
    (void)user, (void)heap_id;
}

static const SluiceStreamedTextureManagerCreateInfo good_info = {
    .structSize = sizeof good_info,
    .heapAllocator = {NULL, no_heap, no_release},
    .heapTileCapacity = 16,
    .tileSize = 65536,
    .pLocked = &rig.locked,
    .log = {NULL, keep_line}};

static const SluiceStreamedTextureDesc good_desc = {512, 256, 10, 3, 1, 128, 128};

static int begin(void **state)
{
    (void)state;
    memset(&rig, 0, sizeof rig);
    CHECK_OK(sluiceCreateStreamedTextureManager(&good_info, &rig.manager));
    return 0;
}

static int end(void **state)
{
    (void)state;
    rig.locked = false;
    sluiceDestroyStreamedTextureManager(rig.manager);
    return 0;
}

static SluiceTextureId add(void)
{
    SluiceTextureId id;
    CHECK_OK(sluiceAddStreamedTexture(rig.manager, &good_desc, &id));
    return id;
}

static void no_texture_is_not_all_textures(void **state)
{
    (void)state;
    SluiceStreamedTextureManager *m = rig.manager;
    SluiceTile tiles[4];
    uint32_t count = 4;
    SluiceTextureId id = SLUICE_NO_TEXTURE;
    check_refused(sluiceGetTilesToMap(m, id, &count, tiles),
                  "sluiceGetTilesToMap: textureId is SLUICE_NO_TEXTURE");
    check_refused(sluiceGetTilesToMap(m, id, &count, NULL), "SLUICE_ALL_TEXTURES");
    check_refused(sluiceGetTilesToUnmap(m, id, 0, &count, tiles),
                  "sluiceGetTilesToUnmap: textureId is SLUICE_NO_TEXTURE");
    check_refused(sluiceGetTilesToCancel(m, id, &count, tiles),
                  "sluiceGetTilesToCancel: textureId is SLUICE_NO_TEXTURE");
    check_refused(sluiceRetryFailedTiles(m, id),
                  "sluiceRetryFailedTiles: textureId is SLUICE_NO_TEXTURE");
    assert_int_equal(count, 4);
    CHECK_OK(sluiceGetTilesToMap(m, SLUICE_ALL_TEXTURES, &count, tiles));
    CHECK_OK(sluiceRetryFailedTiles(m, SLUICE_ALL_TEXTURES));
}

static void sets_that_cannot_be_are_named(void **state)
{
    (void)state;
    SluiceStreamedTextureManager *m = rig.manager;
    SluiceTextureId a = add(), b = add(), c = add();
    CHECK_OK(sluiceSetPrimaryTexture(m, b, a));
    check_refused(sluiceSetPrimaryTexture(m, c, c), "sluiceSetPrimaryTexture: a texture cannot");
    check_refused(sluiceSetPrimaryTexture(m, c, b), "primaryId follows another texture");
    check_refused(sluiceSetPrimaryTexture(m, a, c), "followerId has followers of its own");
    check_refused(sluiceMatchPrimaryTexture(m, c, c, 1, 1),
                  "sluiceMatchPrimaryTexture: primaryId and followerId are both 0x100000002");
}

static void sizes_out_of_range_are_named(void **state)
{
    (void)state;
    SluiceStreamedTextureManager *m = rig.manager;
    SluiceTextureId id = add();
    SluiceStreamedTextureDesc desc = good_desc;
    uint8_t texels[16];
    const SluiceMinMipRect rect = {id, 3, 1, 2, 1};
    desc.mipLevelCount = 11;
    check_refused(sluiceAddStreamedTexture(m, &desc, &id),
                  "sluiceAddStreamedTexture: 512x256 texels, 11 levels");
    desc.width = (1u << 20) + 1;
    check_refused(sluiceAddStreamedTexture(m, &desc, &id), "1048577x256 texels");
    check_refused(sluiceWriteMinMipRect(m, &rect, 2, 4, texels),
                  "rectangle 2x1 at 3, 1 is empty or leaves the map of 4x2");
}

static void structs_without_their_size_are_named(void **state)
{
    (void)state;
    const SluiceStreamedTextureManagerConfig config = {0};
    SluiceStreamedTextureStatistics statistics = {0};
    check_refused(sluiceSetConfig(rig.manager, &config), "SluiceStreamedTextureManagerConfig");
    check_refused(sluiceGetStatistics(rig.manager, &statistics), "SluiceStreamedTextureStatistics");
}

static void locked_managers_say_so(void **state)
{
    (void)state;
    SluiceTextureId id = add();
    rig.locked = true;
    check_refused(sluiceRemoveStreamedTexture(rig.manager, id, 0),
                  "sluiceRemoveStreamedTexture: the manager is locked");
    check_refused(sluiceCompleteRetireValue(rig.manager, 0),
                  "sluiceCompleteRetireValue: the manager is locked");
}

static void create_infos_out_of_range_are_named(void **state)
{
    (void)state;
    SluiceStreamedTextureManager *manager;
    const SluiceAllocationCallbacks half = {NULL, NULL, NULL};
    SluiceStreamedTextureManagerCreateInfo info = good_info;
    info.heapTileCapacity = (1u << 20) + 1;
    check_refused(sluiceCreateStreamedTextureManager(&info, &manager),
                  "heapTileCapacity 1048577 is above 1048576");
    info = good_info;
    info.pAllocator = &half;
    check_refused(sluiceCreateStreamedTextureManager(&info, &manager), "pAllocator lacks");
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(no_texture_is_not_all_textures), TEST(sets_that_cannot_be_are_named),
        TEST(sizes_out_of_range_are_named),   TEST(structs_without_their_size_are_named),
        TEST(locked_managers_say_so),         TEST(create_infos_out_of_range_are_named),
    };
    return RUN_TESTS(tests);
}
