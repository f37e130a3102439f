/* Themes of ui.h. A color of text keeps its role. Graphs and maps are dark in all themes. */
#include "ui_theme.h"

#include "ui.h"

#include <imgui.h>

namespace
{

struct palette {
    uint32_t white, gray, orange, red, blue; ///< colors of texts
    uint32_t background, field, pressed, active;
};

/* Orange, red and blue also differ in brightness (tests/view/test_view_widgets.c). */
const palette palettes[] = {
    {UI_WHITE, UI_GRAY, UI_ORANGE, UI_RED, UI_BLUE, UI_COLOR(18, 20, 26, 237),
     UI_COLOR(48, 56, 69, 255), UI_COLOR(40, 105, 180, 255), UI_COLOR(61, 97, 143, 255)},
    {UI_COLOR(24, 28, 34, 255), UI_COLOR(84, 92, 102, 255), UI_COLOR(150, 92, 0, 255),
     UI_COLOR(132, 0, 0, 255), UI_COLOR(0, 84, 166, 255), UI_COLOR(246, 247, 249, 244),
     UI_COLOR(216, 221, 228, 255), UI_COLOR(150, 196, 244, 255), UI_COLOR(178, 208, 240, 255)},
    {UI_COLOR(255, 255, 255, 255), UI_COLOR(214, 219, 226, 255), UI_COLOR(255, 214, 90, 255),
     UI_COLOR(255, 138, 112, 255), UI_COLOR(128, 196, 255, 255), UI_COLOR(0, 0, 0, 255),
     UI_COLOR(28, 28, 28, 255), UI_COLOR(0, 84, 180, 255), UI_COLOR(0, 100, 200, 255)}};

int theme_now = UI_DARK;

ImVec4 color_of(uint32_t color)
{
    return ImGui::ColorConvertU32ToFloat4(color);
}

} // namespace

/* Returns a darker color for the name of a curve on a light panel. */
static uint32_t darker(uint32_t color)
{
    switch (color) {
    case UI_COLOR(240, 228, 66, 255): return UI_COLOR(118, 106, 0, 255);
    case UI_COLOR(86, 180, 233, 255): return UI_COLOR(0, 104, 156, 255);
    case UI_COLOR(0, 158, 115, 255): return UI_COLOR(0, 110, 80, 255);
    case UI_COLOR(213, 94, 0, 255): return UI_COLOR(168, 66, 0, 255);
    case UI_COLOR(230, 159, 0, 255): return UI_COLOR(140, 90, 0, 255);
    default: return color;
    }
}

uint32_t ui_theme_color(int theme, uint32_t color)
{
    const palette &p = palettes[theme];
    switch (color) {
    case UI_WHITE: return p.white;
    case UI_GRAY: return p.gray;
    case UI_ORANGE: return p.orange;
    case UI_RED: return p.red;
    case UI_BLUE: return p.blue;
    default: return theme == UI_LIGHT ? darker(color) : color;
    }
}

uint32_t ui_theme_background(int theme)
{
    return palettes[theme].background;
}

uint32_t ui_themed(uint32_t color)
{
    return ui_theme_color(theme_now, color);
}

uint32_t ui_pressed_color(void)
{
    return palettes[theme_now].pressed;
}

void ui_choose_theme(int theme)
{
    ImGuiStyle &style = ImGui::GetStyle();
    const palette &p = palettes[theme];
    theme_now = theme;
    if (theme == UI_LIGHT)
        ImGui::StyleColorsLight(&style);
    else
        ImGui::StyleColorsDark(&style);
    style.WindowBorderSize = style.FrameBorderSize = theme == UI_CONTRAST ? 1.0f : 0.0f;
    style.Colors[ImGuiCol_Text] = color_of(p.white);
    style.Colors[ImGuiCol_WindowBg] = style.Colors[ImGuiCol_PopupBg] = color_of(p.background);
    style.Colors[ImGuiCol_ChildBg] = ImVec4(0.0f, 0.0f, 0.0f, 0.0f);
    style.Colors[ImGuiCol_FrameBg] = style.Colors[ImGuiCol_Button] = color_of(p.field);
    style.Colors[ImGuiCol_ButtonHovered] = style.Colors[ImGuiCol_FrameBgHovered] =
        color_of(p.active);
    style.Colors[ImGuiCol_TitleBg] = style.Colors[ImGuiCol_TableHeaderBg] = color_of(p.field);
    style.Colors[ImGuiCol_TitleBgActive] = color_of(p.active);
    if (theme == UI_CONTRAST)
        style.Colors[ImGuiCol_Border] = color_of(p.white);
}

void ui_set_theme(int theme)
{
    if (theme != theme_now)
        ui_choose_theme(theme);
}
