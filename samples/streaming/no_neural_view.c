/* Replaces neural_view.c in builds without sluice-neural. No set is ever opened. */
#include "neural_view.h"

bool neural_view_create(const struct gpu *gpu, SluiceVulkanContext *context,
                        const struct picture_list *pictures, const struct settings *settings,
                        struct neural_view *view)
{
    (void)gpu, (void)context, (void)pictures, (void)settings;
    *view = (struct neural_view){0};
    return true;
}

void neural_view_destroy(struct neural_view *view)
{
    (void)view;
}

const SluiceTileProducer *neural_view_add_producer(struct neural_view *view,
                                                   const struct neural_picture *picture)
{
    (void)view, (void)picture;
    return NULL;
}

bool neural_view_begin(struct neural_view *view, uint32_t slot, VkCommandBuffer commands)
{
    (void)view, (void)slot, (void)commands;
    return true;
}

bool neural_view_end(struct neural_view *view, VkCommandBuffer commands)
{
    (void)view, (void)commands;
    return true;
}

bool neural_view_process(struct neural_view *view, uint32_t slot, bool settle)
{
    (void)view, (void)slot, (void)settle;
    return true;
}

uint64_t neural_view_memory(const struct neural_view *view)
{
    (void)view;
    return 0;
}
