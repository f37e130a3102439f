#include "frames.h"

#include "ui.h"

#include "../../samples/common/png_file.h"

static bool create_slot(const struct gpu *gpu, struct frames_slot *slot)
{
    const VkCommandBufferAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = gpu->command_pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1};
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    return gpu_check(vkAllocateCommandBuffers(gpu->device, &allocate, &slot->commands),
                     "vkAllocateCommandBuffers") &&
           gpu_check(vkCreateFence(gpu->device, &fence, NULL, &slot->fence), "vkCreateFence");
}

static bool create_times(struct frames *f)
{
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = FRAMES_TIMES * FRAMES_SLOTS};
    return gpu_check(vkCreateQueryPool(f->gpu->device, &info, NULL, &f->times),
                     "vkCreateQueryPool");
}

static bool create_pixels(struct frames *f)
{
    return gpu_create_buffer(f->gpu, (VkDeviceSize)f->target.width * f->target.height * 4,
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT, &f->pixels);
}

bool frames_create(const struct gpu *gpu, uint32_t width, uint32_t height, struct frames *f)
{
    uint32_t font_width, font_height;
    *f = (struct frames){.gpu = gpu};
    const uint8_t *font = ui_font_pixels(&font_width, &font_height);
    bool created = target_create(gpu, width, height, 1, &f->target) && create_pixels(f) &&
                   create_times(f) &&
                   ui_drawing_create(gpu, &f->target, font, font_width, font_height, &f->drawing);
    for (int i = 0; created && i < FRAMES_SLOTS; i++)
        created = create_slot(gpu, &f->slots[i]);
    if (!created)
        frames_destroy(f);
    return created;
}

bool frames_wait(struct frames *f)
{
    for (int i = 0; i < FRAMES_SLOTS; i++)
        if (f->slots[i].submitted &&
            !gpu_check(vkWaitForFences(f->gpu->device, 1, &f->slots[i].fence, VK_TRUE, UINT64_MAX),
                       "vkWaitForFences"))
            return false;
    return true;
}

void frames_destroy(struct frames *f)
{
    if (!f->gpu)
        return;
    frames_wait(f);
    for (int i = 0; i < FRAMES_SLOTS; i++) {
        vkDestroyFence(f->gpu->device, f->slots[i].fence, NULL);
        if (f->slots[i].commands)
            vkFreeCommandBuffers(f->gpu->device, f->gpu->command_pool, 1, &f->slots[i].commands);
    }
    ui_drawing_destroy(&f->drawing);
    vkDestroyQueryPool(f->gpu->device, f->times, NULL);
    gpu_destroy_buffer(f->gpu, &f->pixels);
    target_destroy(f->gpu, &f->target);
    *f = (struct frames){0};
}

bool frames_resize(struct frames *f, uint32_t width, uint32_t height)
{
    if (!frames_wait(f))
        return false;
    gpu_destroy_buffer(f->gpu, &f->pixels);
    target_destroy(f->gpu, &f->target);
    f->pixels = (struct gpu_buffer){0};
    f->target = (struct target){0};
    return target_create(f->gpu, width, height, 1, &f->target) && create_pixels(f);
}

uint32_t frames_slot(const struct frames *f)
{
    return (uint32_t)(f->number % FRAMES_SLOTS);
}

/* Reads the seconds between two time stamps of a slot. */
static bool read_pair(const struct frames *f, uint32_t slot, uint32_t first, double *seconds)
{
    uint64_t ticks[2];
    if (vkGetQueryPoolResults(f->gpu->device, f->times, FRAMES_TIMES * slot + first, 2,
                              sizeof ticks, ticks, sizeof *ticks,
                              VK_QUERY_RESULT_64_BIT) != VK_SUCCESS)
        return false;
    *seconds =
        (double)(ticks[1] - ticks[0]) * (double)f->gpu->properties.limits.timestampPeriod * 1e-9;
    return true;
}

static void read_times(struct frames *f, uint32_t number)
{
    const struct frames_slot *slot = &f->slots[number];
    read_pair(f, number, 0, &f->gpu_seconds);
    for (uint32_t half = 0; half < 2; half++) {
        const uint32_t now = slot->swapped ? 1 - half : half;
        if (slot->halves >> half & 1 && read_pair(f, number, 2 + 2 * half, &f->half_seconds[now]))
            f->halves_known |= 1u << now;
    }
}

/* Commands before have ended when those behind begin. */
static void write_time_between(struct frames *f, uint32_t time)
{
    const uint32_t number = frames_slot(f);
    const VkCommandBuffer commands = f->slots[number].commands;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL, 0, NULL);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, f->times,
                        FRAMES_TIMES * number + time);
}

void frames_begin_half(struct frames *f, uint32_t half)
{
    write_time_between(f, 2 + 2 * half);
}

void frames_end_half(struct frames *f, uint32_t half)
{
    write_time_between(f, 3 + 2 * half);
    f->slots[frames_slot(f)].halves |= 1u << half;
}

void frames_swap_halves(struct frames *f)
{
    for (uint32_t i = 0; i < FRAMES_SLOTS; i++)
        if (i != frames_slot(f))
            f->slots[i].swapped = !f->slots[i].swapped;
}

void frames_forget_halves(struct frames *f)
{
    f->halves_known = 0;
    for (uint32_t i = 0; i < FRAMES_SLOTS; i++)
        f->slots[i].halves = 0;
}

VkCommandBuffer frames_begin(struct frames *f)
{
    const uint32_t number = frames_slot(f);
    struct frames_slot *slot = &f->slots[number];
    f->halves_known = 0;
    if (slot->submitted) {
        if (!gpu_check(vkWaitForFences(f->gpu->device, 1, &slot->fence, VK_TRUE, UINT64_MAX),
                       "vkWaitForFences") ||
            !gpu_check(vkResetFences(f->gpu->device, 1, &slot->fence), "vkResetFences"))
            return VK_NULL_HANDLE;
        slot->submitted = false;
        read_times(f, number);
    }
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (!gpu_check(vkBeginCommandBuffer(slot->commands, &begin), "vkBeginCommandBuffer"))
        return VK_NULL_HANDLE;
    slot->halves = 0;
    slot->swapped = false;
    vkCmdResetQueryPool(slot->commands, f->times, FRAMES_TIMES * number, FRAMES_TIMES);
    vkCmdWriteTimestamp(slot->commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, f->times,
                        FRAMES_TIMES * number);
    return slot->commands;
}

static bool submit(struct frames *f, const struct frames_end *end, uint32_t number)
{
    struct frames_slot *slot = &f->slots[number];
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkSemaphore semaphores[FRAMES_MAX_SIGNALS + 1], acquired = VK_NULL_HANDLE;
    uint64_t values[FRAMES_MAX_SIGNALS + 1], none = 0;
    uint32_t count = 0;
    for (; count < end->signal_count; count++) {
        semaphores[count] = end->signals[count].semaphore;
        values[count] = end->signals[count].value;
    }
    if (end->swapchain) {
        acquired = end->swapchain->acquired[number];
        semaphores[count] = end->swapchain->presented[end->image];
        values[count++] = 0;
    }
    const VkTimelineSemaphoreSubmitInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .waitSemaphoreValueCount = end->swapchain ? 1 : 0,
        .pWaitSemaphoreValues = &none,
        .signalSemaphoreValueCount = count,
        .pSignalSemaphoreValues = values};
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .pNext = &timeline,
                               .waitSemaphoreCount = end->swapchain ? 1 : 0,
                               .pWaitSemaphores = &acquired,
                               .pWaitDstStageMask = &stage,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &slot->commands,
                               .signalSemaphoreCount = count,
                               .pSignalSemaphores = semaphores};
    slot->submitted =
        gpu_check(vkQueueSubmit(f->gpu->queue, 1, &info, slot->fence), "vkQueueSubmit");
    return slot->submitted;
}

bool frames_end(struct frames *f, const struct frames_end *end)
{
    static const float black[4] = {0, 0, 0, 1};
    const uint32_t number = frames_slot(f);
    VkCommandBuffer commands = f->slots[number].commands;
    if (!ui_drawing_prepare(&f->drawing, number, end->geometry, end->views))
        return false;
    target_begin(&f->target, commands, black);
    ui_drawing_record(&f->drawing, number, end->geometry, commands);
    target_end(&f->target, commands);
    if (end->swapchain)
        swapchain_record_copy(end->swapchain, end->image, &f->target, commands);
    if (end->read)
        target_copy_out(&f->target, commands, f->pixels.buffer);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, f->times,
                        FRAMES_TIMES * number + 1);
    if (!gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") || !submit(f, end, number))
        return false;
    f->number++;
    return true;
}

const uint8_t *frames_pixels(struct frames *f)
{
    return frames_wait(f) ? f->pixels.mapped : NULL;
}

bool frames_write(struct frames *f, const char *path)
{
    const uint8_t *pixels = frames_pixels(f);
    return pixels && png_file_write(path, pixels, f->target.width, f->target.height);
}
