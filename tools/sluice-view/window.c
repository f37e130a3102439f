#include "window.h"

#include "keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(VIEW_KEY_ESCAPE == GLFW_KEY_ESCAPE && VIEW_KEY_END == GLFW_KEY_END &&
                   VIEW_KEY_F12 == GLFW_KEY_F12 && VIEW_KEY_SHIFT == GLFW_KEY_LEFT_SHIFT &&
                   VIEW_KEY_COUNT == GLFW_KEY_LAST + 1,
               "keys are numbered as GLFW numbers them");

/* GLFW declares this function only if Vulkan's header was included before. */
extern VkResult glfwCreateWindowSurface(VkInstance instance, GLFWwindow *window,
                                        const VkAllocationCallbacks *allocator,
                                        VkSurfaceKHR *surface);

struct window {
    GLFWwindow *glfw;
    VkSurfaceKHR surface;
    struct ui_input pending; ///< input since the last poll
    bool pressed[3]; ///< pressed since the last poll; a click shorter than a frame lasts one frame
    struct file_list dropped;
    bool full;
    int x, y, width, height; ///< placement before full screen
};

void window_note_key(struct ui_input *input, int key, bool down)
{
    if (key == VIEW_KEY_SHIFT)
        input->shift = down;
    if (key == VIEW_KEY_CONTROL)
        input->control = down;
    if (key == VIEW_KEY_ALT)
        input->alt = down;
    if (input->key_count < UI_MAX_KEY_EVENTS)
        input->keys[input->key_count++] = (struct ui_key_event){.key = key, .down = down};
}

void window_note_text(struct ui_input *input, const char *text)
{
    const size_t length = strlen(input->text);
    if (length + strlen(text) < sizeof input->text)
        strcpy(input->text + length, text);
    while (*text && input->key_count < UI_MAX_KEY_EVENTS) {
        struct ui_key_event *event = &input->keys[input->key_count++];
        size_t size = 1;
        while (size < 4 && ((unsigned char)text[size] & 0xC0) == 0x80)
            size++;
        *event = (struct ui_key_event){.key = VIEW_KEY_NONE, .down = true};
        memcpy(event->text, text, size);
        text += size;
    }
}

static struct window *of(GLFWwindow *glfw)
{
    return glfwGetWindowUserPointer(glfw);
}

static void on_key(GLFWwindow *glfw, int key, int scancode, int action, int modifiers)
{
    (void)scancode;
    (void)modifiers;
    const bool repeats =
        key == GLFW_KEY_BACKSPACE || (key >= GLFW_KEY_RIGHT && key <= GLFW_KEY_PAGE_DOWN);
    if (action == GLFW_REPEAT && !repeats)
        return;
    if (key == GLFW_KEY_KP_ENTER)
        key = GLFW_KEY_ENTER;
    if (key == GLFW_KEY_RIGHT_SHIFT || key == GLFW_KEY_RIGHT_CONTROL || key == GLFW_KEY_RIGHT_ALT)
        key -= GLFW_KEY_RIGHT_SHIFT - GLFW_KEY_LEFT_SHIFT;
    if (key >= 0 && key < VIEW_KEY_COUNT)
        window_note_key(&of(glfw)->pending, key, action != GLFW_RELEASE);
}

/* Adds a character as UTF-8. */
static void on_character(GLFWwindow *glfw, unsigned code)
{
    static const unsigned char marks[] = {0, 0xC0, 0xE0, 0xF0};
    const int more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    char text[5] = "";
    if (code < 32 || (code >= 127 && code < 160) || code > 0x10FFFF)
        return;
    text[0] = (char)(marks[more] | code >> (6 * more));
    for (int i = 1; i <= more; i++)
        text[i] = (char)(0x80 | (code >> (6 * (more - i)) & 0x3F));
    window_note_text(&of(glfw)->pending, text);
}

/* Converts points of the screen to pixels. */
static void on_move(GLFWwindow *glfw, double x, double y)
{
    int width, height, pixel_width, pixel_height;
    glfwGetWindowSize(glfw, &width, &height);
    glfwGetFramebufferSize(glfw, &pixel_width, &pixel_height);
    struct window *window = of(glfw);
    window->pending.mouse_x = (float)(x * (width > 0 ? (double)pixel_width / width : 1.0));
    window->pending.mouse_y = (float)(y * (height > 0 ? (double)pixel_height / height : 1.0));
}

static void on_button(GLFWwindow *glfw, int button, int action, int modifiers)
{
    (void)modifiers;
    if (button < 0 || button >= 3)
        return;
    of(glfw)->pending.buttons[button] = action == GLFW_PRESS;
    of(glfw)->pressed[button] |= action == GLFW_PRESS;
}

static void on_wheel(GLFWwindow *glfw, double x, double y)
{
    (void)x;
    of(glfw)->pending.wheel += (float)y;
}

static void on_drop(GLFWwindow *glfw, int count, const char **paths)
{
    struct file_list *dropped = &of(glfw)->dropped;
    files_finish(dropped);
    for (int i = 0; i < count && files_add(paths[i], dropped); i++)
        continue;
}

static void on_focus(GLFWwindow *glfw, int focused)
{
    struct window *window = of(glfw);
    if (!focused) /* releases of keys elsewhere send no event here */
        for (int key = 0; key < VIEW_KEY_COUNT; key++)
            if (key >= VIEW_KEY_SPACE && glfwGetKey(glfw, key == GLFW_KEY_UNKNOWN ? 32 : key))
                window_note_key(&window->pending, key, false);
}

static void on_error(int code, const char *message)
{
    fprintf(stderr, "sluice-view: GLFW: %s (%d)\n", message, code);
}

struct window *window_open(const char *title, uint32_t width, uint32_t height)
{
    struct window *window = calloc(1, sizeof *window);
    glfwSetErrorCallback(on_error);
    if (!window || !glfwInit()) {
        fprintf(stderr, "sluice-view: cannot open a window; --headless draws without one\n");
        free(window);
        return NULL;
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    if (glfwVulkanSupported())
        window->glfw = glfwCreateWindow((int)width, (int)height, title, NULL, NULL);
    if (!window->glfw) {
        fprintf(stderr, "sluice-view: cannot open a window; --headless draws without one\n");
        window_close(window);
        return NULL;
    }
    glfwSetWindowUserPointer(window->glfw, window);
    glfwSetKeyCallback(window->glfw, on_key);
    glfwSetCharCallback(window->glfw, on_character);
    glfwSetCursorPosCallback(window->glfw, on_move);
    glfwSetMouseButtonCallback(window->glfw, on_button);
    glfwSetScrollCallback(window->glfw, on_wheel);
    glfwSetDropCallback(window->glfw, on_drop);
    glfwSetWindowFocusCallback(window->glfw, on_focus);
    window->pending.mouse_x = window->pending.mouse_y = -1;
    return window;
}

void window_close(struct window *window)
{
    if (!window)
        return;
    if (window->glfw)
        glfwDestroyWindow(window->glfw);
    glfwTerminate();
    files_finish(&window->dropped);
    free(window);
}

const char *const *window_extensions(struct window *window, uint32_t *count)
{
    (void)window;
    return glfwGetRequiredInstanceExtensions(count);
}

bool window_create_surface(struct window *window, const struct gpu *gpu)
{
    VkBool32 presents = VK_FALSE;
    if (!gpu_check(glfwCreateWindowSurface(gpu->instance, window->glfw, NULL, &window->surface),
                   "glfwCreateWindowSurface") ||
        !gpu_check(vkGetPhysicalDeviceSurfaceSupportKHR(gpu->physical_device, gpu->family,
                                                        window->surface, &presents),
                   "vkGetPhysicalDeviceSurfaceSupportKHR"))
        return false;
    if (!presents)
        fprintf(stderr, "sluice-view: %s cannot present to this window\n",
                gpu->properties.deviceName);
    return presents;
}

void window_destroy_surface(struct window *window, const struct gpu *gpu)
{
    if (window && window->surface)
        vkDestroySurfaceKHR(gpu->instance, window->surface, NULL);
    if (window)
        window->surface = VK_NULL_HANDLE;
}

VkSurfaceKHR window_surface(const struct window *window)
{
    return window->surface;
}

void window_size(const struct window *window, uint32_t *width, uint32_t *height)
{
    int w = 0, h = 0;
    glfwGetFramebufferSize(window->glfw, &w, &h);
    *width = w > 0 ? (uint32_t)w : 0;
    *height = h > 0 ? (uint32_t)h : 0;
}

/* Converts pixels to points of the screen. */
void window_set_size(struct window *window, uint32_t width, uint32_t height)
{
    int points_x = 0, points_y = 0;
    uint32_t x, y;
    glfwGetWindowSize(window->glfw, &points_x, &points_y);
    window_size(window, &x, &y);
    if (!window->full && x > 0 && y > 0)
        glfwSetWindowSize(window->glfw, (int)((double)width * points_x / x + 0.5),
                          (int)((double)height * points_y / y + 0.5));
}

double window_scale(const struct window *window)
{
    float x = 1, y = 1;
    glfwGetWindowContentScale(window->glfw, &x, &y);
    return x >= 0.5f && x <= 4 ? (double)x : 1.0;
}

static void set_clipboard(void *user_data, const char *text)
{
    glfwSetClipboardString(((struct window *)user_data)->glfw, text);
}

static const char *get_clipboard(void *user_data)
{
    const char *text = glfwGetClipboardString(((struct window *)user_data)->glfw);
    return text ? text : "";
}

void window_share_clipboard(struct window *window)
{
    ui_set_clipboard(set_clipboard, get_clipboard, window);
}

void window_poll(struct window *window, struct ui_input *input)
{
    struct ui_input *pending = &window->pending;
    glfwPollEvents();
    input->mouse_x = pending->mouse_x;
    input->mouse_y = pending->mouse_y;
    input->wheel = pending->wheel;
    input->shift = pending->shift;
    input->control = pending->control;
    input->alt = pending->alt;
    for (int i = 0; i < 3; i++) {
        input->buttons[i] = pending->buttons[i] || window->pressed[i];
        window->pressed[i] = false;
    }
    memcpy(input->keys, pending->keys, sizeof input->keys);
    input->key_count = pending->key_count;
    memcpy(input->text, pending->text, sizeof input->text);
    pending->wheel = 0;
    pending->key_count = 0;
    pending->text[0] = '\0';
}

bool window_closed(const struct window *window)
{
    return glfwWindowShouldClose(window->glfw);
}

bool window_dropped(struct window *window, struct file_list *paths)
{
    *paths = window->dropped;
    window->dropped = (struct file_list){0};
    return paths->count > 0;
}

void window_set_full_screen(struct window *window, bool full)
{
    if (full == window->full)
        return;
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = monitor ? glfwGetVideoMode(monitor) : NULL;
    window->full = full;
    if (full && mode) {
        glfwGetWindowPos(window->glfw, &window->x, &window->y);
        glfwGetWindowSize(window->glfw, &window->width, &window->height);
        glfwSetWindowMonitor(window->glfw, monitor, 0, 0, mode->width, mode->height,
                             mode->refreshRate);
    } else if (!full && window->width > 0) {
        glfwSetWindowMonitor(window->glfw, NULL, window->x, window->y, window->width,
                             window->height, 0);
    }
}
