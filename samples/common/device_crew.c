#include "device_crew.h"

#include <stdio.h>

#include "crew.h"

static bool create_device(struct device_crew *c, const char *name)
{
    bool exists = false;
    const bool done = c->calls->create(c->user_data, c->device_count, name, &exists);
    c->device_count += exists;
    return done && exists;
}

bool device_crew_create(struct device_crew *c, const struct device_list *list, const char *device,
                        const struct gpu *first, bool *none)
{
    uint32_t indices[DEVICE_LIST_MOST], count = 1;
    char name[16];
    *none = false;
    snprintf(name, sizeof name, "%u", list->indices[0]);
    if (!create_device(c, list->count > 0 ? name : device))
        return false;
    if (list->wanted > 0 || list->count > 0)
        count = gpu_list_alike(first, list, indices);
    *none = count == 0;
    for (uint32_t i = 1; i < count; i++) {
        snprintf(name, sizeof name, "%u", indices[i]);
        if (!create_device(c, name))
            return false;
    }
    return count > 0;
}

struct film_share device_crew_share(const struct device_crew *c, uint32_t device)
{
    const bool splits = c->split == SPLIT_FRAME && c->device_count > 1;
    return splits ? (struct film_share){device, c->device_count} : (struct film_share){0};
}

static bool create_ring(const struct device_crew *c, uint32_t count, struct picture_ring *ring)
{
    return picture_ring_create(count, c->size, c->plain, c->calls->write, c->user_data, ring);
}

/* SPLIT_ALTERNATE: each device thread creates pictures of its own. Otherwise one picture is traced
 * while up to device_count are written. */
bool device_crew_create_pictures(struct device_crew *c)
{
    const uint32_t most = c->device_count + 1, count = c->end_of_pictures - c->first_picture;
    return c->split == SPLIT_ALTERNATE || create_ring(c, count < most ? count : most, &c->ring);
}

void device_crew_finish(struct device_crew *c)
{
    picture_ring_destroy(&c->ring);
}

static bool trace(struct device_crew *c, uint32_t device, uint32_t index, struct picture *picture)
{
    return c->calls->trace(c->user_data, device, index, picture);
}

static bool end_if_failed(struct device_crew *c, bool done)
{
    if (!done)
        atomic_store(&c->ends, true);
    return done;
}

/** Traces the device's tiles of the picture that all devices share. */
static bool trace_share(void *user_data, uint32_t device)
{
    struct device_crew *c = user_data;
    return end_if_failed(c, trace(c, device, c->index, c->picture));
}

/** Traces whole pictures: always the next one that no device has begun. */
static bool trace_pictures(void *user_data, uint32_t device)
{
    struct device_crew *c = user_data;
    struct picture_ring ring = {0};
    bool done = create_ring(c, 2, &ring);
    for (uint32_t i; done && (i = atomic_fetch_add(&c->next_picture, 1)) < c->end_of_pictures;)
        done = trace(c, device, i, picture_ring_next(&ring)) && picture_ring_write(&ring, i);
    done = picture_ring_wait(&ring) && done;
    picture_ring_destroy(&ring);
    return end_if_failed(c, done);
}

bool device_crew_trace(struct device_crew *c)
{
    bool done = true;
    atomic_store(&c->next_picture, c->first_picture);
    if (c->split == SPLIT_ALTERNATE)
        return crew_run(c->device_count, trace_pictures, c);
    for (uint32_t i = c->first_picture; i < c->end_of_pictures && done; i++) {
        c->index = i;
        c->picture = picture_ring_next(&c->ring);
        done = crew_run(c->device_count, trace_share, c) && picture_ring_write(&c->ring, i);
    }
    return picture_ring_wait(&c->ring) && done;
}
