/** A window of the system, by GLFW: its pixels, its input, its clipboard. */
#ifndef SLUICE_VIEW_WINDOW_H
#define SLUICE_VIEW_WINDOW_H

#include "ui.h"

#include "../common/files.h"
#include "../common/gpu.h"

struct window;

/** NULL, with a line on stderr, without a display. One window per process. */
struct window *window_open(const char *title, uint32_t width, uint32_t height);
/** NULL is allowed. */
void window_close(struct window *window);
/** Extensions of instances for its surface. */
const char *const *window_extensions(struct window *window, uint32_t *count);
bool window_create_surface(struct window *window, const struct gpu *gpu);
/** NULL and a window without a surface are allowed. */
void window_destroy_surface(struct window *window, const struct gpu *gpu);
VkSurfaceKHR window_surface(const struct window *window);
/** Pixels now; 0 while it is minimized. */
void window_size(const struct window *window, uint32_t *width, uint32_t *height);
/** Of letters: 1 for 96 dots per inch. */
double window_scale(const struct window *window);
void window_share_clipboard(struct window *window);
/** Adds what happened since the last call. */
void window_poll(struct window *window, struct ui_input *input);
bool window_closed(const struct window *window);
/** Moves out the files that were dropped since the last call. False if there are none. */
bool window_dropped(struct window *window, struct file_list *paths);
/** Asks for so many pixels. */
void window_set_size(struct window *window, uint32_t width, uint32_t height);
void window_set_full_screen(struct window *window, bool full);
/** Adds a key, and sets the modifiers by it. */
void window_note_key(struct ui_input *input, int key, bool down);
/** Adds characters of UTF-8 behind the keys. */
void window_note_text(struct ui_input *input, const char *text);

#endif /* SLUICE_VIEW_WINDOW_H */
