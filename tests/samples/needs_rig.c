#include "needs_rig.h"

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static SluiceResult allocate_heap(void *user_data, uint64_t size, uint32_t *heap_id)
{
    (void)size;
    *heap_id = (*(uint32_t *)user_data)++;
    return SLUICE_SUCCESS;
}

static void release_heap(void *user_data, uint32_t heap_id)
{
    (void)user_data;
    (void)heap_id;
}

SluiceStreamedTextureManager *needs_rig_manager(struct needs_rig *rig, SluiceTextureId *ids)
{
    SluiceStreamedTextureManager *manager;
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {&rig->heap_count, allocate_heap, release_heap},
        .heapTileCapacity = 256,
        .tileSize = 65536};
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config, .missesToExpire = 1};
    CHECK_OK(sluiceCreateStreamedTextureManager(&info, &manager));
    CHECK_OK(sluiceSetConfig(manager, &config));
    for (uint32_t i = 0; i < rig->count; i++)
        CHECK_OK(sluiceAddStreamedTexture(manager, &rig->descs[i], &ids[i]));
    return manager;
}

/* Textures in the buffers one after the other, the last one first, with gaps. */
void needs_rig_open(struct needs_rig *rig, const SluiceStreamedTextureDesc *descs, uint32_t count)
{
    *rig = (struct needs_rig){.count = count};
    assert_true(count <= NEEDS_RIG_TEXTURES);
    memcpy(rig->descs, descs, count * sizeof *descs);
    rig->manager = needs_rig_manager(rig, rig->ids);
    uint32_t words = 5;
    for (uint32_t i = count; i-- > 0;) {
        SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
        CHECK_OK(sluiceGetTextureLayout(rig->manager, rig->ids[i], &layout));
        rig->needs_ids[i] = (struct needs_id){rig->ids[i], count - 1 - i};
        struct SluiceTextureEntry *entry = &rig->table[count - 1 - i];
        entry->feedbackOffset = words;
        entry->minMipOffset = words + 2;
        words += layout.feedbackWidth * layout.feedbackHeight + 3;
    }
    rig->word_count = words + 2;
    rig->feedback = malloc(rig->word_count * sizeof *rig->feedback);
    rig->min_mip = malloc(rig->word_count * sizeof *rig->min_mip);
    assert_non_null(rig->feedback);
    assert_non_null(rig->min_mip);
    for (uint32_t i = 0; i < rig->word_count; i++) {
        rig->feedback[i] = SLUICE_MIP_UNTOUCHED;
        rig->min_mip[i] = 0xFFFFFFFF;
    }
    rig->words = (struct needs_words){rig->table, rig->feedback, rig->min_mip};
    assert_true(needs_begin(&rig->needs, rig->manager, rig->needs_ids, count));
}

void needs_rig_close(struct needs_rig *rig)
{
    needs_finish(&rig->needs);
    sluiceDestroyStreamedTextureManager(rig->manager);
    free(rig->feedback);
    free(rig->min_mip);
}

uint32_t *needs_rig_feedback(struct needs_rig *rig, uint32_t texture)
{
    return rig->feedback + rig->table[rig->needs_ids[texture].table_index].feedbackOffset;
}

uint32_t *needs_rig_min_mip(struct needs_rig *rig, uint32_t texture)
{
    return rig->min_mip + rig->table[rig->needs_ids[texture].table_index].minMipOffset;
}

struct needs_frame needs_rig_frame(struct needs_rig *rig)
{
    struct needs_frame frame = {0};
    assert_true(needs_add_frame(&rig->needs, &rig->words, &frame));
    return frame;
}
