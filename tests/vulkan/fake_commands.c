#include "support/test.h"
#include "vulkan/fake_functions.h"
#include "vulkan/fake_objects.h"

#include <string.h>

static VKAPI_ATTR void VKAPI_CALL copy_to_image(VkCommandBuffer commands, VkBuffer buffer,
                                                VkImage image, VkImageLayout layout, uint32_t count,
                                                const VkBufferImageCopy *regions)
{
    struct fake_vulkan *fake = fake_of(commands);
    assert_false(fake->published);
    assert_true(layout == VK_IMAGE_LAYOUT_GENERAL && FAKE_OBJECT(image)->general);
    if (fake->records_uploads) /* the other queue waits for no frame under way */
        assert_true(FAKE_OBJECT(image)->general_frame <= fake->frame_value);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(fake->copy_count < FAKE_EVENTS);
        struct fake_copy *copy = &fake->copies[fake->copy_count++];
        *copy = (struct fake_copy){image,
                                   regions[i].imageSubresource.mipLevel,
                                   regions[i].imageSubresource.baseArrayLayer,
                                   (uint32_t)regions[i].imageOffset.x / FAKE_TILE,
                                   (uint32_t)regions[i].imageOffset.y / FAKE_TILE,
                                   0,
                                   fake->records_uploads,
                                   VK_NULL_HANDLE,
                                   0};
        const uint8_t *texels = FAKE_OBJECT(FAKE_OBJECT(buffer)->memory)->memory;
        memcpy(&copy->texel, texels + regions[i].bufferOffset, sizeof copy->texel);
    }
}

static VKAPI_ATTR void VKAPI_CALL copy_image(VkCommandBuffer commands, VkImage from,
                                             VkImageLayout from_layout, VkImage to,
                                             VkImageLayout to_layout, uint32_t count,
                                             const VkImageCopy *regions)
{
    struct fake_vulkan *fake = fake_of(commands);
    assert_false(fake->published);
    assert_true(from_layout == VK_IMAGE_LAYOUT_GENERAL && FAKE_OBJECT(from)->general);
    assert_true(to_layout == VK_IMAGE_LAYOUT_GENERAL && FAKE_OBJECT(to)->general);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(fake->copy_count < FAKE_EVENTS);
        assert_int_equal(regions[i].extent.width, FAKE_TILE);
        assert_int_equal(regions[i].extent.height, FAKE_TILE);
        fake->copies[fake->copy_count++] =
            (struct fake_copy){.image = to,
                               .level = regions[i].dstSubresource.mipLevel,
                               .layer = regions[i].dstSubresource.baseArrayLayer,
                               .from = from,
                               .from_layer = regions[i].srcSubresource.baseArrayLayer};
    }
}

/* Notes the copy of MinMip maps, which may only show earlier copies. */
static VKAPI_ATTR void VKAPI_CALL copy_buffer(VkCommandBuffer commands, VkBuffer from, VkBuffer to,
                                              uint32_t count, const VkBufferCopy *regions)
{
    (void)from, (void)to, (void)count, (void)regions;
    fake_of(commands)->published = true;
    fake_of(commands)->copy_calls++;
}

/* Writes to watched buffers come before the MinMip maps. */
static struct fake_watch *find_watch(struct fake_vulkan *fake, VkBuffer buffer)
{
    for (int i = 0; i < 2; i++)
        if (fake->watches[i].buffer == buffer) {
            assert_false(fake->published);
            return &fake->watches[i];
        }
    return NULL;
}

static VKAPI_ATTR void VKAPI_CALL fill_buffer(VkCommandBuffer commands, VkBuffer buffer,
                                              VkDeviceSize offset, VkDeviceSize size, uint32_t data)
{
    struct fake_watch *watch = find_watch(fake_of(commands), buffer);
    if (size == VK_WHOLE_SIZE)
        size = FAKE_OBJECT(buffer)->size - offset;
    for (VkDeviceSize i = offset / 4; watch && i < (offset + size) / 4 && i < FAKE_WORDS; i++)
        watch->words[i] = data;
}

static VKAPI_ATTR void VKAPI_CALL update_buffer(VkCommandBuffer commands, VkBuffer buffer,
                                                VkDeviceSize offset, VkDeviceSize size,
                                                const void *data)
{
    struct fake_watch *watch = find_watch(fake_of(commands), buffer);
    if (!watch)
        return;
    assert_true(offset + size <= sizeof watch->words);
    memcpy((uint8_t *)watch->words + offset, data, size);
}

static VKAPI_ATTR void VKAPI_CALL barrier(VkCommandBuffer commands, VkPipelineStageFlags from,
                                          VkPipelineStageFlags to, VkDependencyFlags flags,
                                          uint32_t memory_count, const VkMemoryBarrier *memory,
                                          uint32_t buffer_count,
                                          const VkBufferMemoryBarrier *buffers,
                                          uint32_t image_count, const VkImageMemoryBarrier *images)
{
    (void)from, (void)to, (void)flags, (void)memory_count, (void)memory;
    (void)buffer_count, (void)buffers;
    struct fake_vulkan *fake = fake_of(commands);
    for (uint32_t i = 0; i < image_count; i++) {
        struct fake_object *image = FAKE_OBJECT(images[i].image);
        assert_true(images[i].newLayout == VK_IMAGE_LAYOUT_GENERAL);
        if (!image->general && fake->general_count < FAKE_EVENTS)
            fake->general[fake->general_count++] = image;
        if (!image->general)
            image->general_frame = fake->now_frame;
        image->general = true;
    }
}

void fake_vulkan_mark(struct fake_vulkan *fake)
{
    fake->general_count = 0;
    for (int i = 0; i < 2; i++)
        memcpy(fake->watches[i].marked, fake->watches[i].words, sizeof fake->watches[i].words);
}

void fake_vulkan_undo(struct fake_vulkan *fake)
{
    while (fake->general_count)
        fake->general[--fake->general_count]->general = false;
    for (int i = 0; i < 2; i++)
        memcpy(fake->watches[i].words, fake->watches[i].marked, sizeof fake->watches[i].words);
}

const struct fake_function fake_command_functions[] = {
    FAKE_FUNCTION(CmdCopyBuffer, copy_buffer),
    FAKE_FUNCTION(CmdFillBuffer, fill_buffer),
    FAKE_FUNCTION(CmdPipelineBarrier, barrier),
    FAKE_FUNCTION(CmdUpdateBuffer, update_buffer),
    FAKE_FUNCTION(CmdCopyBufferToImage, copy_to_image),
    FAKE_FUNCTION(CmdCopyImage, copy_image),
    {NULL, NULL},
};
