/** What the parts of ui.h share about themes. */
#ifndef SLUICE_VIEW_UI_THEME_H
#define SLUICE_VIEW_UI_THEME_H

#include <stdint.h>

/** Sets the colors, although they may be those of now. */
void ui_choose_theme(int theme);
/** A text's color in the theme of now. */
uint32_t ui_themed(uint32_t color);
/** Of buttons that stay pressed. */
uint32_t ui_pressed_color(void);

#endif /* SLUICE_VIEW_UI_THEME_H */
