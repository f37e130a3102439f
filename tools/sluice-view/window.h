/** A window of the system, by GLFW: pixels, input and clipboard. */
#ifndef SLUICE_VIEW_WINDOW_H
#define SLUICE_VIEW_WINDOW_H

#include "ui.h"

#include "../common/files.h"
#include "../common/gpu.h"

struct window;

/** Opens a window. At most one per process. NULL, with a line on stderr, without a display. */
struct window *window_open(const char *title, uint32_t width, uint32_t height);
/** Closes the window. NULL is allowed. */
void window_close(struct window *window);
/** Returns the instance extensions that the surface of the window requires. */
const char *const *window_extensions(struct window *window, uint32_t *count);
bool window_create_surface(struct window *window, const struct gpu *gpu);
/** Destroys the surface. NULL and a window without a surface are allowed. */
void window_destroy_surface(struct window *window, const struct gpu *gpu);
VkSurfaceKHR window_surface(const struct window *window);
/** Writes the present size in pixels; 0 while the window is minimized. */
void window_size(const struct window *window, uint32_t *width, uint32_t *height);
/** Returns the scale of letters: 1 for 96 dots per inch. */
double window_scale(const struct window *window);
void window_share_clipboard(struct window *window);
/** Adds input since the last call. */
void window_poll(struct window *window, struct ui_input *input);
bool window_closed(const struct window *window);
/** Moves out the paths of files that were dropped since the last call. False if there are none. */
bool window_dropped(struct window *window, struct file_list *paths);
/** Requests a size in pixels. */
void window_set_size(struct window *window, uint32_t width, uint32_t height);
void window_set_full_screen(struct window *window, bool full);
/** Adds a key, and updates the modifiers from it. */
void window_note_key(struct ui_input *input, int key, bool down);
/** Adds UTF-8 characters after the keys. */
void window_note_text(struct ui_input *input, const char *text);

#endif /* SLUICE_VIEW_WINDOW_H */
