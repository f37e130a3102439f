#include "vulkan/page_timelines.h"

uint32_t slc_page_timelines_free_place(const struct slc_page_timelines *timelines)
{
    uint32_t at = 0;
    while (at < SLC_MAX_PAGE_USERS && timelines->of[at].semaphore)
        at++;
    return at;
}

void slc_page_timelines_add(struct slc_page_timelines *timelines, uint32_t user,
                            VkSemaphore semaphore)
{
    timelines->of[user].semaphore = semaphore;
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) /* clears values of the index's last user */
        timelines->of[i].seen[user] = timelines->of[i].still[user] = 0;
    timelines->user_count++;
}

void slc_page_timelines_remove(struct slc_page_timelines *timelines, uint32_t user)
{
    timelines->of[user] = (struct slc_page_timeline){0};
    timelines->user_count--;
}

/* Polls the other users: their completed frames release pages and chunks. */
static void poll_others(struct slc_page_timelines *timelines, const struct slc_vk *vk,
                        uint32_t user)
{
    for (uint32_t i = 0; timelines->user_count > 1 && i < SLC_MAX_PAGE_USERS; i++) {
        uint64_t value = 0;
        struct slc_page_timeline *other = &timelines->of[i];
        if (i != user && other->semaphore &&
            vk->GetSemaphoreCounterValue(vk->device, other->semaphore, &value) == VK_SUCCESS &&
            value > other->completed)
            other->completed = value;
    }
}

/* Advances safe_tick of each user whose marked frame is complete, and sets the next mark. */
static void advance_safe_ticks(struct slc_page_timelines *timelines)
{
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) {
        struct slc_page_timeline *user = &timelines->of[i];
        if (user->completed >= user->recorded) {
            user->safe_tick = timelines->tick;
            user->mark_frame = 0;
        } else if (user->mark_frame && user->completed >= user->mark_frame) {
            user->safe_tick = user->mark_tick;
            user->mark_frame = 0;
        }
        if (user->completed < user->recorded && user->mark_frame == 0) {
            user->mark_frame = user->recorded;
            user->mark_tick = timelines->tick;
        }
    }
}

/* Notes which other users have made progress since the user's last frame. */
static void look_at_others(const struct slc_page_timelines *timelines,
                           struct slc_page_timeline *self)
{
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++) {
        uint64_t progress = timelines->of[i].recorded + timelines->of[i].completed;
        self->still[i] = progress == self->seen[i] ? self->still[i] + 1 : 0;
        self->seen[i] = progress;
    }
}

void slc_page_timelines_advance(struct slc_page_timelines *timelines, const struct slc_vk *vk,
                                uint32_t user, uint64_t completed_frame)
{
    struct slc_page_timeline *self = &timelines->of[user];
    self->completed = completed_frame > self->completed ? completed_frame : self->completed;
    poll_others(timelines, vk, user);
    advance_safe_ticks(timelines);
    look_at_others(timelines, self);
    timelines->tick++;
}

void slc_page_timelines_record(struct slc_page_timelines *timelines, uint32_t user, uint64_t frame)
{
    struct slc_page_timeline *self = &timelines->of[user];
    self->recorded = self->frames[self->frame_count++ % SLC_PAGE_FRAMES] = frame;
}

static uint64_t last_frame(const struct slc_page_timeline *user)
{
    return user->frame_count ? user->frames[(user->frame_count - 1) % SLC_PAGE_FRAMES] : 0;
}

void slc_page_timelines_abandon(struct slc_page_timelines *timelines, uint32_t user, uint64_t frame)
{
    struct slc_page_timeline *self = &timelines->of[user];
    while (self->frame_count && last_frame(self) >= frame)
        self->frame_count--;
    self->recorded = last_frame(self);
    self->mark_frame = 0;
}

bool slc_page_timelines_are_idle(const struct slc_page_timelines *timelines, uint32_t users,
                                 uint32_t except)
{
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        if (users & 1u << i && i != except &&
            timelines->of[i].completed < timelines->of[i].recorded)
            return false;
    return true;
}

bool slc_page_timelines_passed(const struct slc_page_timelines *timelines, uint32_t users,
                               uint32_t except, uint64_t tick)
{
    for (uint32_t i = 0; i < SLC_MAX_PAGE_USERS; i++)
        if (users & 1u << i && i != except && timelines->of[i].safe_tick < tick)
            return false;
    return true;
}
