/* Texels of sets whose latents are pages of a demand loader: compares a shader's decoding with
 * C. */
#include "device/conform.h"
#include "neural/decoded.h"
#include "neural/neural_files.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"

#include <sluice/demand.h>
#include <sluice/neural_pages.h>

#include "neural_pages_comp.h"
#include "neural_pages_shared.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_TEXELS = 2048, MAX_LAUNCHES = 32 };

static struct harness h;

struct rig {
    SluiceNeuralSet *set;
    SluiceNeuralSetInfo info;
    SluiceNeuralPages pages;
    struct decodable decodable;
    float *mips[SLUICE_NEURAL_MAX_MIPS];
    SluiceDemandLoader *loader;
    SluiceDemandResourceId resource;
    uint32_t first_page;
    struct harness_buffer buffers[4]; ///< buffers as bound by the shader
    struct conform_set own;           ///< set 1
    VkPipelineLayout layout;
    VkPipeline pipeline;
    uint32_t count;
    uint32_t pages_read;
};

static SluiceResult read_page(void *user, uint32_t page, uint32_t size, void *bytes)
{
    struct rig *rig = user;
    assert_int_equal(size, rig->pages.pageSize);
    rig->pages_read++; /* only one thread reads */
    return sluiceReadNeuralPage(rig->set, &rig->pages, page, bytes);
}

static void create_loader(struct rig *rig)
{
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .context = h.context,
                                         .memoryBudget = 64u << 20,
                                         .byteMemoryBudget = 32u << 20,
                                         .bufferDeviceAddress = true};
    SluiceDemandResourceCreateInfo resource = {.structSize = sizeof resource,
                                               .pageCount = rig->pages.pageCount,
                                               .pageSize = rig->pages.pageSize,
                                               .pUserData = rig,
                                               .pfnRead = read_page};
    CHECK_OK(sluiceCreateDemandLoader(&info, &rig->loader));
    CHECK_OK(sluiceAddDemandResource(rig->loader, &resource, &rig->resource, &rig->first_page));
}

static void create_pipeline(struct rig *rig)
{
    const uint64_t sizes[4] = {sizeof rig->pages, rig->decodable.weight_size,
                               MAX_TEXELS * sizeof(struct NeuralPageInput),
                               MAX_TEXELS * sizeof(struct NeuralPageOutput)};
    for (int i = 0; i < 4; i++)
        harness_buffer_init(&h, &rig->buffers[i], sizes[i], VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    memcpy(rig->buffers[0].mapped, &rig->pages, sizeof rig->pages);
    memcpy(rig->buffers[1].mapped, rig->decodable.weights, rig->decodable.weight_size);
    conform_create_set(&h, 4, 0, 8, &rig->own);
    conform_write_buffers(&h, &rig->own, 4,
                          (const struct harness_buffer *const[]){&rig->buffers[0], &rig->buffers[1],
                                                                 &rig->buffers[2],
                                                                 &rig->buffers[3]});
    VkDescriptorSetLayout layouts[2] = {VK_NULL_HANDLE, rig->own.set_layout};
    CHECK_OK(sluiceGetDemandDescriptorSetLayout(rig->loader, &layouts[0]));
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, 8};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = 2,
                                             .pSetLayouts = layouts,
                                             .pushConstantRangeCount = 1,
                                             .pPushConstantRanges = &push};
    assert_int_equal(h.CreatePipelineLayout(h.device, &info, NULL, &rig->layout), VK_SUCCESS);
    rig->pipeline = conform_compute_pipeline(
        &h, rig->layout, conform_module(&h, neural_pages_comp, sizeof neural_pages_comp), NULL);
}

/* Skips the test if there are no buffer addresses. */
static void rig_init(struct rig *rig, const char *sample, uint32_t page_size)
{
    char path[512];
    *rig = (struct rig){.info = {.structSize = sizeof rig->info}};
    if (!h.reads_bytes)
        SKIP_TEST("the device's addresses are not there");
    assert_true(find_neural_sample(sample, path, sizeof path));
    rig->set = open_neural_sample(path);
    CHECK_OK(sluiceGetNeuralSetInfo(rig->set, &rig->info));
    CHECK_OK(sluiceLayOutNeuralPages(rig->set, page_size, &rig->pages));
    read_decodable(rig->set, NULL, SLUICE_NEURAL_WEIGHTS_INT8, &rig->decodable);
    for (uint32_t mip = 0; mip < rig->info.mipCount; mip++)
        rig->mips[mip] = decode_mip(rig->set, SLUICE_NEURAL_WEIGHTS_INT8, mip);
    create_loader(rig);
    create_pipeline(rig);
}

static void rig_finish(struct rig *rig)
{
    assert_int_equal(h.DeviceWaitIdle(h.device), VK_SUCCESS);
    sluiceDestroyDemandLoader(rig->loader);
    h.DestroyPipeline(h.device, rig->pipeline, NULL);
    h.DestroyPipelineLayout(h.device, rig->layout, NULL);
    conform_destroy_set(&h, &rig->own);
    for (int i = 0; i < 4; i++)
        harness_buffer_finish(&h, &rig->buffers[i]);
    for (uint32_t mip = 0; mip < rig->info.mipCount; mip++)
        free(rig->mips[mip]);
    free_decodable(&rig->decodable);
    sluiceDestroyNeuralSet(rig->set);
    harness_check_silence(&h);
}

static void add(struct rig *rig, uint32_t mip, uint32_t x, uint32_t y)
{
    struct NeuralPageInput *inputs = rig->buffers[2].mapped;
    assert_true(rig->count < MAX_TEXELS);
    inputs[rig->count++] = (struct NeuralPageInput){(int32_t)x, (int32_t)y, mip};
}

/* Returns the number of missing pages, and waits until they are read. */
static uint32_t launch(struct rig *rig)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    const uint32_t push[2] = {rig->count, rig->first_page};
    VkCommandBuffer commands = h.commands[0];
    SluiceDemandLaunch at = {.structSize = sizeof at};
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    SluiceDemandTicket ticket;
    assert_int_equal(h.BeginCommandBuffer(commands, &begin), VK_SUCCESS);
    CHECK_OK(sluiceBeginDemandLaunch(rig->loader, commands, &at));
    h.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, rig->pipeline);
    h.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, rig->layout, 0, 2,
                            (const VkDescriptorSet[]){at.descriptorSet, rig->own.set}, 0, NULL);
    h.CmdPushConstants(commands, rig->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, push);
    h.CmdDispatch(commands, slc_div_up_u32(rig->count, 64), 1, 1);
    CHECK_OK(sluiceEndDemandLaunch(rig->loader, commands));
    assert_int_equal(h.EndCommandBuffer(commands), VK_SUCCESS);
    const VkTimelineSemaphoreSubmitInfo values = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &at.signalValue};
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .pNext = &values,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &commands,
                                 .signalSemaphoreCount = 1,
                                 .pSignalSemaphores = &at.semaphore};
    assert_int_equal(h.QueueSubmit(h.queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    CHECK_OK(sluiceProcessDemandRequests(rig->loader, &at, UINT64_MAX, &requests, &ticket));
    CHECK_OK(sluiceWaitDemandTicket(rig->loader, ticket, UINT64_MAX, NULL));
    assert_int_equal(h.DeviceWaitIdle(h.device), VK_SUCCESS);
    return requests.missingCount;
}

/* Checks that every result equals the decoder's at the reported mip; with `sharp`, at the requested
 * mip. */
static void check(const struct rig *rig, bool sharp)
{
    const struct NeuralPageInput *inputs = rig->buffers[2].mapped;
    const struct NeuralPageOutput *outputs = rig->buffers[3].mapped;
    for (uint32_t i = 0; i < rig->count; i++) {
        const struct NeuralPageInput *in = &inputs[i];
        const struct NeuralPageOutput *out = &outputs[i];
        assert_true(out->resident || !sharp);
        if (!out->resident)
            continue;
        assert_in_range(out->shown, in->mip, sharp ? in->mip : rig->info.mipCount - 1);
        uint32_t coarser = out->shown - in->mip, width = slc_mip_size(rig->info.width, out->shown),
                 height = slc_mip_size(rig->info.height, out->shown);
        size_t x = slc_min_u32((uint32_t)in->x >> coarser, width - 1),
               y = slc_min_u32((uint32_t)in->y >> coarser, height - 1);
        const float *texel = &rig->mips[out->shown][(y * width + x) * rig->info.channelCount];
        if (memcmp(texel, out->channels, sizeof *texel * rig->info.channelCount))
            fail_msg("mip %u (%d, %d), shown mip %u: other bits", in->mip, in->x, in->y,
                     out->shown);
    }
}

static void check_sample(const char *sample, uint32_t page_size)
{
    struct rig rig;
    bool asked[4096] = {false};
    rig_init(&rig, sample, page_size);
    assert_true(rig.pages.pageCount <= 4096);
    roll_seed(5);
    for (uint32_t i = 0; i < 400; i++) {
        uint32_t mip = (uint32_t)roll() % rig.info.mipCount, g = rig.pages.groupCount - 1;
        uint32_t width = slc_mip_size(rig.info.width, mip), x = (uint32_t)roll() % width / 2;
        uint32_t y = (uint32_t)roll() % slc_mip_size(rig.info.height, mip);
        while (rig.pages.groups[g].firstMip > mip)
            g--;
        const SluiceNeuralPageGroup *group = &rig.pages.groups[g];
        uint32_t fine = mip - group->firstMip;
        asked[group->firstPage + (y << fine) / group->pageHeight * group->columns +
              (x << fine) / group->pageWidth] = true;
        add(&rig, mip, x, y);
    }
    asked[rig.pages.groups[rig.pages.groupCount - 1].firstPage] = true;
    uint32_t launches = 0, wanted = 0;
    for (; launch(&rig) && launches < MAX_LAUNCHES; launches++)
        check(&rig, false);
    check(&rig, true);
    for (uint32_t i = 0; i < rig.pages.pageCount; i++)
        wanted += asked[i];
    assert_int_equal(rig.pages_read, wanted);
    assert_true(launches == 1);
    rig_finish(&rig);
}

static void texels_of_schema_3_are_decoded_once_their_pages_are_there(void **state)
{
    (void)state;
    check_sample("v9_300x200.ntc", 8192);
}

static void texels_of_schema_1_are_decoded_once_their_pages_are_there(void **state)
{
    (void)state;
    check_sample("v7_64_g.ntc", 4096);
}

static void the_coarsest_page_stands_in_for_all(void **state)
{
    struct rig rig;
    (void)state;
    rig_init(&rig, "v9_300x200.ntc", 8192);
    const struct NeuralPageOutput *outputs = rig.buffers[3].mapped;
    const SluiceNeuralPageGroup *last = &rig.pages.groups[rig.pages.groupCount - 1];
    uint8_t *page = malloc(rig.pages.pageSize);
    CHECK_OK(sluiceReadNeuralPage(rig.set, &rig.pages, last->firstPage, page));
    CHECK_OK(sluiceSetDemandPageBytes(rig.loader, rig.resource, last->firstPage, page, true));
    for (uint32_t i = 0; i < 100; i++)
        add(&rig, 0, i * 3, i * 2);
    assert_true(launch(&rig) > 1);
    check(&rig, false);
    for (uint32_t i = 0; i < rig.count; i++)
        assert_true(outputs[i].resident && outputs[i].shown == last->firstMip);
    assert_int_equal(launch(&rig), 0);
    check(&rig, true);
    free(page);
    rig_finish(&rig);
}

static void texels_that_do_not_exist_are_refused(void **state)
{
    struct rig rig;
    (void)state;
    rig_init(&rig, "v9_64_g.ntc", 65536);
    const struct NeuralPageOutput *outputs = rig.buffers[3].mapped;
    add(&rig, 0, 64, 0);
    add(&rig, 0, UINT32_MAX, 5);
    add(&rig, 1, 0, 32);
    add(&rig, rig.info.mipCount, 0, 0);
    assert_int_equal(launch(&rig), 0);
    for (uint32_t i = 0; i < rig.count; i++)
        assert_false(outputs[i].resident);
    rig_finish(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_of_schema_3_are_decoded_once_their_pages_are_there),
        cmocka_unit_test(texels_of_schema_1_are_decoded_once_their_pages_are_there),
        cmocka_unit_test(the_coarsest_page_stands_in_for_all),
        cmocka_unit_test(texels_that_do_not_exist_are_refused),
    };
    int status = need_neural_samples(
        (const char *const[]){"v7_64_g.ntc", "v9_300x200.ntc", "v9_64_g.ntc", NULL});
    if (status == 0)
        status = harness_init(&h);
    if (status)
        return status;
    return harness_finish(&h, RUN_TESTS(tests));
}
