/* Drawing of ui.h: lines, rectangles and pictures in panels and behind them. */
#include "ui.h"
#include "ui_theme.h"

#include <imgui.h>

static ImDrawList *panel_list()
{
    return ImGui::GetWindowDrawList();
}

void ui_canvas(float width, float height, float rectangle[4])
{
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (width <= 0.0f)
        width = ImGui::GetContentRegionAvail().x;
    ImGui::Dummy(ImVec2(width, height));
    rectangle[0] = at.x;
    rectangle[1] = at.y;
    rectangle[2] = width;
    rectangle[3] = height;
}

void ui_fill(float x, float y, float width, float height, uint32_t color)
{
    panel_list()->AddRectFilled(ImVec2(x, y), ImVec2(x + width, y + height), color);
}

void ui_frame(float x, float y, float width, float height, uint32_t color)
{
    panel_list()->AddRect(ImVec2(x, y), ImVec2(x + width, y + height), color);
}

void ui_stroke(float x0, float y0, float x1, float y1, uint32_t color, float thickness)
{
    panel_list()->AddLine(ImVec2(x0, y0), ImVec2(x1, y1), color, thickness);
}

void ui_polyline(const float *xy, uint32_t count, uint32_t color, float thickness)
{
    panel_list()->AddPolyline((const ImVec2 *)xy, (int)count, color, 0, thickness);
}

void ui_label(float x, float y, uint32_t color, const char *text)
{
    panel_list()->AddText(ImVec2(x, y), ui_themed(color), text);
}
void ui_picture(uint32_t texture, uint32_t mode, const float rectangle[4], const float uv[4],
                uint32_t color)
{
    ImGui::GetBackgroundDrawList()->AddImage(
        (ImTextureID)(uintptr_t)(texture | mode << UI_MODE_SHIFT),
        ImVec2(rectangle[0], rectangle[1]),
        ImVec2(rectangle[0] + rectangle[2], rectangle[1] + rectangle[3]), ImVec2(uv[0], uv[1]),
        ImVec2(uv[2], uv[3]), color);
}

void ui_fill_behind(float x, float y, float width, float height, uint32_t color)
{
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(x, y), ImVec2(x + width, y + height),
                                                  color);
}

void ui_stroke_behind(float x0, float y0, float x1, float y1, uint32_t color, float thickness)
{
    ImGui::GetBackgroundDrawList()->AddLine(ImVec2(x0, y0), ImVec2(x1, y1), color, thickness);
}

void ui_label_behind(float x, float y, float pad, const char *text)
{
    const ImVec2 size = ImGui::CalcTextSize(text);
    ui_fill_behind(x - pad, y - pad, size.x + 2 * pad, size.y + 2 * pad, UI_COLOR(18, 20, 26, 235));
    ImGui::GetBackgroundDrawList()->AddText(ImVec2(x, y), UI_WHITE, text);
}

void ui_image(uint32_t texture, float width, float height, const float uv[4])
{
    ImGui::Image((ImTextureID)(uintptr_t)texture, ImVec2(width, height), ImVec2(uv[0], uv[1]),
                 ImVec2(uv[2], uv[3]));
}

void ui_mouse(float *x, float *y)
{
    const ImVec2 at = ImGui::GetIO().MousePos;
    *x = at.x;
    *y = at.y;
}

bool ui_mouse_clicked(int button)
{
    return ImGui::IsMouseClicked(button);
}
