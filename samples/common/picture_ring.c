#include "picture_ring.h"

#include <stdio.h>
#include <stdlib.h>

bool picture_ring_create(uint32_t count, const uint32_t size[2], bool plain, picture_writer write,
                         void *user_data, struct picture_ring *ring)
{
    *ring = (struct picture_ring){.slots = calloc(count, sizeof *ring->slots)};
    if (!ring->slots) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    for (; ring->count < count; ring->count++) {
        struct picture_slot *slot = &ring->slots[ring->count];
        if (!picture_create(size[0], size[1], &slot->picture))
            return false;
        slot->picture.plain = plain;
        slot->write = write;
        slot->user_data = user_data;
    }
    return true;
}

static void wait_for(struct picture_ring *ring, struct picture_slot *slot)
{
    if (slot->has_thread) {
        pthread_join(slot->thread, NULL);
        slot->has_thread = false;
        ring->failed = ring->failed || !slot->done;
    }
}

bool picture_ring_wait(struct picture_ring *ring)
{
    for (uint32_t i = 0; i < ring->count; i++)
        wait_for(ring, &ring->slots[i]);
    return !ring->failed;
}

void picture_ring_destroy(struct picture_ring *ring)
{
    (void)picture_ring_wait(ring);
    for (uint32_t i = 0; i < ring->count; i++)
        picture_destroy(&ring->slots[i].picture);
    free(ring->slots);
    *ring = (struct picture_ring){0};
}

struct picture *picture_ring_next(struct picture_ring *ring)
{
    struct picture_slot *slot = &ring->slots[ring->next];
    wait_for(ring, slot);
    return &slot->picture;
}

static void *write_slot(void *user_data)
{
    struct picture_slot *slot = user_data;
    slot->done = slot->write(slot->user_data, &slot->picture, slot->index);
    return NULL;
}

bool picture_ring_write(struct picture_ring *ring, uint32_t index)
{
    struct picture_slot *slot = &ring->slots[ring->next];
    slot->index = index;
    slot->has_thread = pthread_create(&slot->thread, NULL, write_slot, slot) == 0;
    if (!slot->has_thread) {
        write_slot(slot);
        ring->failed = ring->failed || !slot->done;
    }
    ring->next = (ring->next + 1) % ring->count;
    return !ring->failed;
}
