/** Themes, as shared by the implementations of ui.h. */
#ifndef SLUICE_VIEW_UI_THEME_H
#define SLUICE_VIEW_UI_THEME_H

#include <stdint.h>

/** Sets the colors, even if the theme has not changed. */
void ui_choose_theme(int theme);
/** Returns the color of a text in the present theme. */
uint32_t ui_themed(uint32_t color);
/** Returns the color of buttons that stay pressed. */
uint32_t ui_pressed_color(void);

#endif /* SLUICE_VIEW_UI_THEME_H */
