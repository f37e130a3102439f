#include "viewer.h"

static VkPresentModeKHR mode_of(int vsync)
{
    static const VkPresentModeKHR modes[] = {VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_MAILBOX_KHR,
                                             VK_PRESENT_MODE_IMMEDIATE_KHR};
    return modes[vsync];
}

void viewer_follow_vsync(struct viewer *v)
{
    const VkPresentModeKHR wanted = mode_of(v->app.settings.vsync);
    v->swapchain.outdated |= wanted != v->swapchain.wanted;
    v->swapchain.wanted = wanted;
}

void viewer_say_vsync(struct viewer *v)
{
    const char *name = swapchain_mode_name(v->swapchain.mode);
    const bool changed = v->app.present_mode && v->app.present_mode != name;
    if (v->swapchain.mode != v->swapchain.wanted)
        app_say(&v->app, "Presents by %s: the window does not offer %s", name,
                swapchain_mode_name(v->swapchain.wanted));
    else if (changed)
        app_say(&v->app, "Presents by %s", name);
    v->app.present_mode = name;
}

static bool is_sized(const struct viewer *v, uint32_t width, uint32_t height)
{
    return v->sized[0] == width && v->sized[1] == height;
}

static void note_size(struct viewer *v, uint32_t width, uint32_t height)
{
    v->sized[0] = width;
    v->sized[1] = height;
}

/* Takes over the size of the window. A size that the user drags overrides the setting. */
static void follow_window(struct viewer *v)
{
    uint32_t width, height, *size = v->app.settings.size;
    window_size(v->window, &width, &height);
    const bool dragged = width > 0 && height > 0 && !v->app.settings.full_screen &&
                         v->swapchain.width > 0 &&
                         (width != v->swapchain.width || height != v->swapchain.height);
    if (!is_sized(v, size[0], size[1])) {
        window_set_size(v->window, size[0], size[1]);
    } else if (dragged) {
        size[0] = width;
        size[1] = height;
    }
    note_size(v, size[0], size[1]);
}

bool viewer_follow_size(struct viewer *v)
{
    const uint32_t *size = v->app.settings.size;
    if (v->sized[0] == 0) /* first frame: the window has the size of the settings */
        note_size(v, size[0], size[1]);
    if (v->window) {
        follow_window(v);
        return true;
    }
    if (is_sized(v, size[0], size[1]))
        return true;
    note_size(v, size[0], size[1]);
    return frames_wait(&v->frames) && frames_resize(&v->frames, size[0], size[1]);
}
