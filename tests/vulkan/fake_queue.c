#include "support/test.h"
#include "vulkan/fake_functions.h"
#include "vulkan/fake_objects.h"

#define DEFAULT_BINDS_PER_CALL 512u

static VKAPI_ATTR VkResult VKAPI_CALL create_semaphore(VkDevice device,
                                                       const VkSemaphoreCreateInfo *info,
                                                       const VkAllocationCallbacks *cb,
                                                       VkSemaphore *semaphore)
{
    FAKE_MAY_FAIL(device);
    (void)info, (void)cb;
    *semaphore = fake_make_shown(fake_of(device), 0);
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_semaphore(VkDevice device, VkSemaphore semaphore,
                                                    const VkAllocationCallbacks *cb)
{
    (void)cb;
    fake_drop(fake_of(device), semaphore);
}

static uint64_t value_of(const struct fake_vulkan *fake, VkSemaphore semaphore)
{
    if (fake->upload_semaphore && semaphore == fake->upload_semaphore)
        return fake->upload_value;
    /* until the first bind tells which one is its, both stand at 0 */
    bool binds = fake->submitted_bind_value == 0 || semaphore == fake->bind_semaphore;
    return semaphore == fake->frame_semaphore ? fake->frame_value : binds ? fake->bind_value : 0;
}

static VKAPI_ATTR VkResult VKAPI_CALL counter_value(VkDevice device, VkSemaphore semaphore,
                                                    uint64_t *value)
{
    FAKE_MAY_FAIL(device);
    *value = value_of(fake_of(device), semaphore);
    return VK_SUCCESS;
}

/* Records a wait. The timelines advance only if the test wants it. */
static VKAPI_ATTR VkResult VKAPI_CALL wait_semaphores(VkDevice device,
                                                      const VkSemaphoreWaitInfo *info,
                                                      uint64_t timeout)
{
    FAKE_MAY_FAIL(device);
    struct fake_vulkan *fake = fake_of(device);
    struct fake_wait wait = {info->pSemaphores[0], info->pValues[0], timeout, fake->live_objects};
    fake->waits[fake->wait_count++ % 64] = wait;
    if (fake->waits_signal && fake->frame_value < wait.value)
        fake->frame_value = wait.value;
    if (fake->upload_semaphore && wait.semaphore == fake->upload_semaphore)
        fake->upload_value = wait.value;
    bool waits = fake->waits_time_out && value_of(fake, wait.semaphore) < wait.value;
    return waits ? VK_TIMEOUT : VK_SUCCESS;
}

static void note_bind(struct fake_vulkan *fake, const struct fake_bind *bind)
{
    assert_true(fake->bind_count < FAKE_EVENTS);
    fake->binds[fake->bind_count++] = *bind;
}

static void note_tiles(struct fake_vulkan *fake, VkImage image, const VkSparseImageMemoryBind *b)
{
    const struct fake_object *object = FAKE_OBJECT(image);
    uint32_t level = b->subresource.mipLevel;
    uint32_t width = object->extent.width >> level ? object->extent.width >> level : 1;
    uint32_t height = object->extent.height >> level ? object->extent.height >> level : 1;
    uint32_t x = (uint32_t)b->offset.x, y = (uint32_t)b->offset.y;
    /* whole tiles, or up to the edge */
    assert_true(x % FAKE_TILE == 0 && y % FAKE_TILE == 0);
    assert_true(b->extent.width % FAKE_TILE == 0 || x + b->extent.width == width);
    assert_true(b->extent.height % FAKE_TILE == 0 || y + b->extent.height == height);
    uint32_t columns = (b->extent.width + FAKE_TILE - 1) / FAKE_TILE;
    uint32_t rows = (b->extent.height + FAKE_TILE - 1) / FAKE_TILE;
    assert_true(columns > 0 && rows > 0);
    for (uint32_t i = 0; i < columns * rows; i++)
        note_bind(fake, &(struct fake_bind){image, level, x / FAKE_TILE + i % columns,
                                            y / FAKE_TILE + i / columns, b->memory,
                                            b->memoryOffset + i * 65536ull});
}

/* Every use of a queue is inside the application's lock, by the queue that it is about. */
static void check_lock(const struct fake_vulkan *fake, VkQueue queue)
{
    if (fake->no_queue_lock)
        return;
    assert_int_equal(fake->lock_depth, 1);
    assert_ptr_equal(fake->locked_queue, queue);
}

static uint32_t count_regions(const VkBindSparseInfo *info)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < info->imageBindCount; i++)
        count += info->pImageBinds[i].bindCount;
    for (uint32_t i = 0; i < info->imageOpaqueBindCount; i++)
        count += info->pImageOpaqueBinds[i].bindCount;
    return count;
}

static VKAPI_ATTR VkResult VKAPI_CALL bind_sparse(VkQueue queue, uint32_t count,
                                                  const VkBindSparseInfo *info, VkFence fence)
{
    (void)fence;
    struct fake_vulkan *fake = fake_of(queue);
    check_lock(fake, queue);
    FAKE_MAY_FAIL(queue);
    assert_int_equal(count, 1);
    assert_in_range(count_regions(info), 1,
                    fake->maxBindsPerCall ? fake->maxBindsPerCall : DEFAULT_BINDS_PER_CALL);
    for (uint32_t i = 0; i < info->imageBindCount; i++)
        for (uint32_t j = 0; j < info->pImageBinds[i].bindCount; j++)
            note_tiles(fake, info->pImageBinds[i].image, &info->pImageBinds[i].pBinds[j]);
    for (uint32_t i = 0; i < info->imageOpaqueBindCount; i++)
        for (uint32_t j = 0; j < info->pImageOpaqueBinds[i].bindCount; j++) {
            const VkSparseMemoryBind *b = &info->pImageOpaqueBinds[i].pBinds[j];
            if (b->flags & VK_SPARSE_MEMORY_BIND_METADATA_BIT) {
                assert_int_equal(b->resourceOffset % FAKE_TAIL_STRIDE, 0);
                assert_true(b->resourceOffset >= 1ull << 31);
                assert_int_equal((b->resourceOffset - (1ull << 31)) / FAKE_TAIL_STRIDE,
                                 b->memoryOffset / fake->metadata_size); /* the layer */
                assert_int_equal(b->size, fake->metadata_size);
                assert_true(b->memory != VK_NULL_HANDLE);
                fake->metadata_binds++;
                continue;
            }
            assert_int_equal(b->size, 65536);
            uint32_t page = (uint32_t)((b->resourceOffset - (1ull << 30)) / 65536);
            note_bind(fake, &(struct fake_bind){info->pImageOpaqueBinds[i].image, FAKE_TAIL, page,
                                                0, b->memory, b->memoryOffset});
        }
    const VkTimelineSemaphoreSubmitInfo *timeline = info->pNext;
    assert_int_equal(timeline->pSignalSemaphoreValues[0], fake->submitted_bind_value + 1);
    /* batches have no order but for this */
    assert_int_equal(timeline->pWaitSemaphoreValues[0], fake->submitted_bind_value);
    fake->bind_semaphore = info->pSignalSemaphores[0];
    fake->submitted_bind_value++;
    fake->bind_calls++;
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_pool(VkDevice device,
                                                  const VkCommandPoolCreateInfo *info,
                                                  const VkAllocationCallbacks *cb,
                                                  VkCommandPool *pool)
{
    FAKE_MAY_FAIL(device);
    (void)cb;
    assert_in_range(info->queueFamilyIndex, 0, FAKE_TRANSFER_FAMILY);
    *pool = fake_make_shown(fake_of(device), 0);
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_pool(VkDevice device, VkCommandPool pool,
                                               const VkAllocationCallbacks *cb)
{
    (void)cb;
    struct fake_vulkan *fake = fake_of(device);
    if (fake->failing_call == 0) /* else the wait may have failed */
        assert_int_equal(fake->upload_value, fake->submitted_upload_value);
    fake_drop(fake, pool);
}

static VKAPI_ATTR VkResult VKAPI_CALL allocate_commands(VkDevice device,
                                                        const VkCommandBufferAllocateInfo *info,
                                                        VkCommandBuffer *commands)
{
    FAKE_MAY_FAIL(device);
    for (uint32_t i = 0; i < info->commandBufferCount; i++)
        commands[i] = fake_vulkan_commands(fake_of(device));
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL begin_commands(VkCommandBuffer commands,
                                                     const VkCommandBufferBeginInfo *info)
{
    FAKE_MAY_FAIL(commands);
    (void)info;
    assert_false(fake_of(commands)->records_uploads);
    fake_of(commands)->records_uploads = true;
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL end_commands(VkCommandBuffer commands)
{
    fake_of(commands)->records_uploads = false;
    FAKE_MAY_FAIL(commands);
    return VK_SUCCESS;
}

/* Checks that a batch of uploads waits only for past work, so that it cannot stall. */
static VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count,
                                             const VkSubmitInfo *info, VkFence fence)
{
    struct fake_vulkan *fake = fake_of(queue);
    check_lock(fake, queue);
    FAKE_MAY_FAIL(queue);
    const VkTimelineSemaphoreSubmitInfo *timeline = info->pNext;
    assert_true(count == 1 && fence == VK_NULL_HANDLE && !fake->records_uploads);
    assert_true(info->waitSemaphoreCount == 1 && info->signalSemaphoreCount == 1);
    assert_ptr_equal(info->pWaitSemaphores[0], fake->frame_semaphore);
    assert_in_range(timeline->pWaitSemaphoreValues[0], 1, fake->frame_value);
    assert_int_equal(timeline->pSignalSemaphoreValues[0], ++fake->submitted_upload_value);
    fake->upload_semaphore = info->pSignalSemaphores[0];
    return VK_SUCCESS;
}

/* Fails only if the device is lost. */
static VKAPI_ATTR VkResult VKAPI_CALL wait_idle(VkDevice device)
{
    struct fake_vulkan *fake = fake_of(device);
    check_lock(fake, VK_NULL_HANDLE);
    fake->device_waits++;
    bool is_lost = fake->fails_on && fake->failing_call && fake->calls >= fake->failing_call;
    return is_lost ? fake->failure : VK_SUCCESS;
}

const struct fake_function fake_queue_functions[] = {
    FAKE_FUNCTION(AllocateCommandBuffers, allocate_commands),
    FAKE_FUNCTION(BeginCommandBuffer, begin_commands),
    FAKE_FUNCTION(CreateCommandPool, create_pool),
    FAKE_FUNCTION(DestroyCommandPool, destroy_pool),
    FAKE_FUNCTION(EndCommandBuffer, end_commands),
    FAKE_FUNCTION(QueueSubmit, submit),
    FAKE_FUNCTION(CreateSemaphore, create_semaphore),
    FAKE_FUNCTION(DestroySemaphore, destroy_semaphore),
    FAKE_FUNCTION(DeviceWaitIdle, wait_idle),
    FAKE_FUNCTION(GetSemaphoreCounterValue, counter_value),
    FAKE_FUNCTION(QueueBindSparse, bind_sparse),
    FAKE_FUNCTION(WaitSemaphores, wait_semaphores),
    {NULL, NULL},
};
