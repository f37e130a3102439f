/*
 * Helper invocations write nothing: neither those beside the edge of a triangle, which only serve
 * derivatives, nor those after a discard. An attachment shows which fragments existed.
 */
#include "device/conform.h"

#include "support/test.h"

#include "lanes_frag.h"
#include "lanes_vert.h"

#include <stdlib.h>

#define SIZE CONFORM_TARGET_SIZE
#define TRIANGLES 150u
#define OFFSET CONFORM_GUARD_COUNT

struct lanes {
    struct conform c;
    struct harness_buffer pixels;
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipeline pipeline;
    uint32_t discards;
};

static void create_attachment(struct lanes *l)
{
    struct harness *h = l->c.h;
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = VK_FORMAT_R8_UNORM,
                              .extent = {SIZE, SIZE, 1},
                              .mipLevels = 1,
                              .arrayLayers = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                       VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    assert_int_equal(h->CreateImage(h->device, &info, NULL, &l->image), VK_SUCCESS);
    VkMemoryRequirements memory;
    h->GetImageMemoryRequirements(h->device, l->image, &memory);
    VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .allocationSize = memory.size};
    while (!(memory.memoryTypeBits >> allocate.memoryTypeIndex & 1))
        allocate.memoryTypeIndex++;
    assert_int_equal(h->AllocateMemory(h->device, &allocate, NULL, &l->memory), VK_SUCCESS);
    assert_int_equal(h->BindImageMemory(h->device, l->image, l->memory, 0), VK_SUCCESS);
    VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .image = l->image,
                                  .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                  .format = info.format,
                                  .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    assert_int_equal(h->CreateImageView(h->device, &view, NULL, &l->view), VK_SUCCESS);
}

static void create_pass(struct lanes *l)
{
    struct harness *h = l->c.h;
    VkAttachmentDescription attachment = {.format = VK_FORMAT_R8_UNORM,
                                          .samples = VK_SAMPLE_COUNT_1_BIT,
                                          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                          .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                          .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &color};
    VkSubpassDependency after = {.srcSubpass = 0,
                                 .dstSubpass = VK_SUBPASS_EXTERNAL,
                                 .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                 .dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
                                 .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                 .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT};
    VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                   .attachmentCount = 1,
                                   .pAttachments = &attachment,
                                   .subpassCount = 1,
                                   .pSubpasses = &subpass,
                                   .dependencyCount = 1,
                                   .pDependencies = &after};
    assert_int_equal(h->CreateRenderPass(h->device, &pass, NULL, &l->pass), VK_SUCCESS);
    VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                           .renderPass = l->pass,
                                           .attachmentCount = 1,
                                           .pAttachments = &l->view,
                                           .width = SIZE,
                                           .height = SIZE,
                                           .layers = 1};
    assert_int_equal(h->CreateFramebuffer(h->device, &framebuffer, NULL, &l->framebuffer),
                     VK_SUCCESS);
}

static void lanes_init(struct lanes *l, struct harness *h)
{
    *l = (struct lanes){0};
    conform_init(&l->c, h);
    harness_buffer_init(h, &l->pixels, SIZE * SIZE, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    create_attachment(l);
    create_pass(l);
    l->pipeline = conform_graphics_pipeline(h, l->c.set.layout, l->pass,
                                            conform_module(h, lanes_vert, sizeof lanes_vert),
                                            conform_module(h, lanes_frag, sizeof lanes_frag), 1);
}

static void lanes_finish(struct lanes *l)
{
    struct harness *h = l->c.h;
    h->DestroyPipeline(h->device, l->pipeline, NULL);
    h->DestroyFramebuffer(h->device, l->framebuffer, NULL);
    h->DestroyRenderPass(h->device, l->pass, NULL);
    h->DestroyImageView(h->device, l->view, NULL);
    h->DestroyImage(h->device, l->image, NULL);
    h->FreeMemory(h->device, l->memory, NULL);
    harness_buffer_finish(h, &l->pixels);
    conform_finish(&l->c);
}

static void record(void *user, VkCommandBuffer commands)
{
    struct lanes *l = user;
    struct harness *h = l->c.h;
    VkClearValue clear = {0};
    VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                   .renderPass = l->pass,
                                   .framebuffer = l->framebuffer,
                                   .renderArea = {{0, 0}, {SIZE, SIZE}},
                                   .clearValueCount = 1,
                                   .pClearValues = &clear};
    h->CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    h->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, l->pipeline);
    h->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, l->c.set.layout, 0, 1,
                             &l->c.set.set, 0, NULL);
    h->CmdPushConstants(commands, l->c.set.layout,
                        VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                        sizeof l->discards, &l->discards);
    h->CmdDraw(commands, 3 * TRIANGLES, 1, 0, 0);
    h->CmdEndRenderPass(commands);
    VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                              .imageExtent = {SIZE, SIZE, 1}};
    h->CmdCopyImageToBuffer(commands, l->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                            l->pixels.buffer, 1, &copy);
    VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask =
                                   VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    h->CmdPipelineBarrier(commands,
                          VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                          VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
}

/* One region per pixel. */
static void clear_map(struct lanes *l)
{
    struct SluiceTextureEntry e = conform_entry(SIZE * 64, SIZE * 64, 64, 64, 0);
    uint32_t *words = l->c.feedback.mapped;
    e.feedbackOffset = OFFSET;
    *(struct SluiceTextureEntry *)l->c.table.mapped = e;
    for (uint32_t i = 0; i < CONFORM_WORDS; i++)
        words[i] = i >= OFFSET && i < OFFSET + SIZE * SIZE ? SLUICE_MIP_UNTOUCHED : CONFORM_GUARD;
}

/* Quads of which some pixels are covered and some are not: those have helpers. */
static uint32_t count_partial_quads(const struct lanes *l)
{
    const uint8_t *pixels = l->pixels.mapped;
    uint32_t count = 0;
    for (uint32_t y = 0; y < SIZE; y += 2)
        for (uint32_t x = 0; x < SIZE; x += 2) {
            uint32_t n = 0;
            for (uint32_t i = 0; i < 4; i++)
                n += pixels[(y + i / 2) * SIZE + x + i % 2] != 0;
            count += n > 0 && n < 4;
        }
    return count;
}

static void check_lanes(struct harness *h, uint32_t discards)
{
    struct lanes l;
    lanes_init(&l, h);
    l.discards = discards;
    clear_map(&l);
    harness_run(h, record, &l);
    const uint32_t *words = l.c.feedback.mapped;
    const uint8_t *pixels = l.pixels.mapped;
    for (uint32_t i = 0; i < SIZE * SIZE; i++)
        if (words[OFFSET + i] != (pixels[i] ? 0 : SLUICE_MIP_UNTOUCHED))
            fail_msg("pixel (%u, %u) is %s and its region is %u", i % SIZE, i / SIZE,
                     pixels[i] ? "covered" : "not covered", words[OFFSET + i]);
    for (uint32_t i = 0; i < OFFSET; i++)
        assert_int_equal(words[i], CONFORM_GUARD);
    for (uint32_t i = OFFSET + SIZE * SIZE; i < CONFORM_WORDS; i++)
        assert_int_equal(words[i], CONFORM_GUARD);
    uint32_t partial = count_partial_quads(&l);
    print_message("# partial_quads.%s %u quads\n", discards ? "discard" : "edge", partial);
    assert_true(partial > 300);
    lanes_finish(&l);
}

static void fragments_beside_an_edge_write_nothing(void **state)
{
    check_lanes(*state, 0);
}

static void discarded_fragments_write_nothing(void **state)
{
    check_lanes(*state, 3);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(fragments_beside_an_edge_write_nothing),
        cmocka_unit_test(discarded_fragments_write_nothing),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
