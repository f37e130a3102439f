/* Panels, widgets and tables of ui.h. */
#include "ui.h"
#include "ui_theme.h"

#include <imgui.h>

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The first frames draw all rows, so that widths of columns fit. */
#define FITTING_FRAMES 4

/* True if the next cell of the row is visible. */
static bool cell_shown;

bool ui_begin_panel(const char *title, bool *open, const float placement[4], const float pivot[2],
                    unsigned flags)
{
    ImGuiWindowFlags window =
        ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings;
    if (flags & UI_PANEL_PLAIN)
        window |= ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav;
    if (flags & UI_PANEL_FIT)
        window |= ImGuiWindowFlags_AlwaysAutoResize;
    if (flags & UI_PANEL_NO_INPUT)
        window |= ImGuiWindowFlags_NoInputs;
    if (flags & UI_PANEL_NO_KEYS)
        window |= ImGuiWindowFlags_NoNav;
    if (flags & UI_PANEL_BEHIND)
        window |= ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoBackground;
    const ImGuiCond when = flags & UI_PANEL_PLAIN ? ImGuiCond_Always : ImGuiCond_Appearing;
    ImGui::SetNextWindowPos(ImVec2(placement[0], placement[1]), when, ImVec2(pivot[0], pivot[1]));
    if (!(flags & UI_PANEL_FIT))
        ImGui::SetNextWindowSize(ImVec2(placement[2], placement[3]), when);
    return ImGui::Begin(title, open, window);
}

void ui_end_panel(void)
{
    ImGui::End();
}

float ui_panel_width(void)
{
    return ImGui::GetWindowWidth();
}

void ui_begin_part(const char *id, float width, float height)
{
    ImGui::BeginChild(id, ImVec2(width, height), false);
}

void ui_end_part(void)
{
    ImGui::EndChild();
}

void ui_begin_list(const char *id, float width, float height, uint32_t count, uint32_t selected,
                   bool follow, uint32_t *first, uint32_t *last)
{
    ImGui::BeginChild(id, ImVec2(width, height), true, ImGuiWindowFlags_NoNav);
    if (count == 0) {
        if (first)
            *first = *last = 0;
        return;
    }
    const float line = ImGui::GetTextLineHeightWithSpacing(), room = ImGui::GetWindowHeight();
    float scroll = ImGui::GetScrollY();
    const float at = (float)selected * line;
    if (follow && (at < scroll || at + 2 * line > scroll + room)) {
        scroll = at < scroll ? at : at + 2 * line - room;
        scroll = scroll > 0.0f ? scroll : 0.0f;
        ImGui::SetScrollY(scroll);
    }
    *first = (uint32_t)(scroll / line);
    *last = *first + (uint32_t)(room / line) + 2;
    *last = *last < count ? *last : count;
    *first = *first < *last ? *first : *last;
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + (float)*first * line);
}

int ui_list_line(int id, bool selected, uint32_t color, const char *text)
{
    ImGui::PushID(id);
    ImGui::PushStyleColor(ImGuiCol_Text, ui_themed(color));
    const bool clicked =
        ImGui::Selectable("##line", selected, ImGuiSelectableFlags_AllowDoubleClick);
    ImGui::SameLine(0.0f, 0.0f);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
    ImGui::PopID();
    return !clicked ? 0 : ImGui::IsMouseDoubleClicked(0) ? 2 : 1;
}

void ui_end_list(uint32_t count)
{
    if (count > 0) {
        const float line = ImGui::GetTextLineHeightWithSpacing();
        ImGui::SetCursorPosY(ImGui::GetStyle().WindowPadding.y + (float)count * line);
        ImGui::Dummy(ImVec2(0.0f, 0.0f));
    }
    ImGui::EndChild();
}

void ui_follow(void)
{
    ImGui::SetScrollHereY();
}

bool ui_begin_group(const char *label, bool open_at_first)
{
    return ImGui::CollapsingHeader(label, open_at_first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void ui_text(uint32_t color, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    ImGui::PushStyleColor(ImGuiCol_Text, ui_themed(color));
    ImGui::TextV(format, arguments);
    ImGui::PopStyleColor();
    va_end(arguments);
}

void ui_begin_tight(bool tight)
{
    const ImVec2 space = ImGui::GetStyle().ItemSpacing;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                        ImVec2(space.x, tight ? space.y / 5.0f : space.y));
}

void ui_end_tight(void)
{
    ImGui::PopStyleVar();
}

void ui_paragraph(uint32_t color, const char *text)
{
    ImGui::PushStyleColor(ImGuiCol_Text, ui_themed(color));
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

void ui_same_line(float x)
{
    ImGui::SameLine(x);
}

void ui_space(float height)
{
    ImGui::Dummy(ImVec2(0.0f, height));
}

bool ui_in_sight(float height)
{
    return ImGui::IsRectVisible(ImVec2(1.0f, height));
}

void ui_line(void)
{
    ImGui::Separator();
}

bool ui_button(const char *label, float width, float height, bool pressed)
{
    if (pressed)
        ImGui::PushStyleColor(ImGuiCol_Button, ui_pressed_color());
    const bool clicked = ImGui::Button(label, ImVec2(width, height));
    if (pressed)
        ImGui::PopStyleColor();
    return clicked;
}

void ui_begin_disabled(bool disabled)
{
    ImGui::BeginDisabled(disabled);
}

void ui_end_disabled(void)
{
    ImGui::EndDisabled();
}

bool ui_check(const char *label, bool *value)
{
    return ImGui::Checkbox(label, value);
}

bool ui_slider_real(const char *label, double *value, double minimum, double maximum,
                    bool logarithmic, const char *format)
{
    return ImGui::SliderScalar(label, ImGuiDataType_Double, value, &minimum, &maximum, format,
                               ImGuiSliderFlags_AlwaysClamp |
                                   (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
}

bool ui_slider_whole(const char *label, uint32_t *value, uint32_t minimum, uint32_t maximum,
                     bool logarithmic)
{
    return ImGui::SliderScalar(label, ImGuiDataType_U32, value, &minimum, &maximum, "%u",
                               ImGuiSliderFlags_AlwaysClamp |
                                   (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
}

bool ui_choice(const char *label, const char *words, int *value)
{
    char items[256];
    size_t length = strlen(words);
    if (length > sizeof items - 2)
        length = sizeof items - 2;
    for (size_t i = 0; i < length; i++)
        items[i] = words[i] == '|' ? '\0' : words[i];
    items[length] = items[length + 1] = '\0';
    return ImGui::Combo(label, value, items);
}

bool ui_type_extent(const char *label, uint32_t value[2], uint32_t minimum, uint32_t maximum)
{
    static uint32_t typed[2]; /* there is one keyboard */
    static ImGuiID owner;
    const ImGuiID id = ImGui::GetID(label);
    if (owner != id) {
        typed[0] = value[0];
        typed[1] = value[1];
    }
    ImGui::InputScalarN(label, ImGuiDataType_U32, typed, 2);
    const bool left = ImGui::IsItemDeactivatedAfterEdit();
    owner = ImGui::IsItemActive() ? id : 0;
    for (int i = 0; left && i < 2; i++)
        value[i] = typed[i] < minimum ? minimum : typed[i] > maximum ? maximum : typed[i];
    return left;
}

bool ui_type_text(const char *label, const char *hint, char *text, size_t size)
{
    return ImGui::InputTextWithHint(label, hint, text, size);
}

void ui_item_width(float width)
{
    ImGui::SetNextItemWidth(width);
}

bool ui_hovered(void)
{
    return ImGui::IsItemHovered();
}

bool ui_active(void)
{
    return ImGui::IsItemActive();
}

bool ui_any_active(void)
{
    return ImGui::IsAnyItemActive();
}

bool ui_released(void)
{
    return ImGui::IsItemDeactivatedAfterEdit();
}

bool ui_double_clicked(void)
{
    /* ImGui::IsItemHovered would fail: the first click may have opened a list above the widget,
     * which the second click closed. */
    return ImGui::IsMouseDoubleClicked(0) &&
           ImGui::IsMouseHoveringRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax()) &&
           ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByPopup |
                                  ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
}

bool ui_deleted(void)
{
#if IMGUI_VERSION_NUM >= 18700
    const bool pressed = ImGui::IsKeyPressed(ImGuiKey_Delete, false);
#else
    const bool pressed = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Delete), false);
#endif
    return pressed && ImGui::IsItemFocused() && ImGui::GetIO().NavVisible &&
           !ImGui::GetIO().WantTextInput;
}

void ui_show_hint(const char *text)
{
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(360.0f * ui_scale());
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void ui_hint(const char *format, ...)
{
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        return;
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ui_show_hint(text);
}

/* Sets up columns, each at least as wide as the sample after '=' in its title. */
static void set_up_columns(const char *columns, int count)
{
    char title[64], sample[64];
    const float padding = 2.0f * ImGui::GetStyle().CellPadding.x;
    for (const char *c = columns; count > 0; count--) {
        const size_t length = strcspn(c, "|"), words = strcspn(c, "=|");
        snprintf(title, sizeof title, "%.*s", (int)words, c);
        snprintf(sample, sizeof sample, "%.*s", words < length ? (int)(length - words - 1) : 0,
                 c + words + 1);
        const float width = ImGui::CalcTextSize(sample).x, own = ImGui::CalcTextSize(title).x;
        ImGui::TableSetupColumn(title,
                                ImGuiTableColumnFlags_WidthFixed |
                                    (c == columns ? 0 : ImGuiTableColumnFlags_PreferSortDescending),
                                sample[0] ? (width > own ? width : own) + padding : 0.0f);
        c += length + 1;
    }
}

bool ui_begin_table(const char *id, const char *columns, float height, bool sortable)
{
    int count = 1;
    for (const char *c = columns; *c; c++)
        count += *c == '|';
    const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY |
                                  ImGuiTableFlags_ScrollX | ImGuiTableFlags_SizingFixedFit |
                                  ImGuiTableFlags_Resizable | ImGuiTableFlags_NoSavedSettings |
                                  (sortable ? ImGuiTableFlags_Sortable : 0);
    if (!ImGui::BeginTable(id, count, flags, ImVec2(0.0f, height)))
        return false;
    ImGui::TableSetupScrollFreeze(1, 1);
    set_up_columns(columns, count);
    ImGui::TableHeadersRow();
    return true;
}

bool ui_table_sort(uint32_t *column, bool *descending)
{
    ImGuiTableSortSpecs *sort = ImGui::TableGetSortSpecs();
    if (!sort || sort->SpecsCount == 0)
        return false;
    *column = (uint32_t)sort->Specs[0].ColumnIndex;
    *descending = sort->Specs[0].SortDirection == ImGuiSortDirection_Descending;
    const bool dirty = sort->SpecsDirty;
    sort->SpecsDirty = false;
    return dirty;
}

void ui_table_rows(uint32_t count, void (*draw)(void *user_data, uint32_t row), void *user_data)
{
    ImGuiListClipper clipper;
    int *frames = ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("frames"));
    clipper.Begin((int)count);
    if (*frames < FITTING_FRAMES && ++*frames && count > 0)
        clipper.ForceDisplayRangeByIndices(0, (int)count);
    while (clipper.Step())
        for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; row++)
            draw(user_data, (uint32_t)row);
}

bool ui_table_row(int id, bool selected)
{
    ImGui::TableNextRow();
    cell_shown = ImGui::TableNextColumn();
    ImGui::PushID(id);
    const bool clicked = ImGui::Selectable("##row", selected, ImGuiSelectableFlags_SpanAllColumns);
    ImGui::PopID();
    ImGui::SameLine(0.0f, 0.0f);
    return clicked;
}

void ui_table_image(uint32_t texture, float size, const float uv[4])
{
    ImGui::Image((ImTextureID)(uintptr_t)texture, ImVec2(size, size), ImVec2(uv[0], uv[1]),
                 ImVec2(uv[2], uv[3]));
    ImGui::SameLine();
}

/* Draws a cell. A text that the column cuts is shown whole while it is hovered. */
void ui_table_cell(uint32_t color, const char *format, ...)
{
    char text[512];
    va_list arguments;
    if (cell_shown) {
        va_start(arguments, format);
        vsnprintf(text, sizeof text, format, arguments);
        va_end(arguments);
        const float room = ImGui::GetContentRegionAvail().x;
        ImGui::PushStyleColor(ImGuiCol_Text, ui_themed(color));
        ImGui::TextUnformatted(text);
        ImGui::PopStyleColor();
        if (ImGui::GetItemRectSize().x > room + 0.5f && ImGui::IsItemHovered())
            ui_show_hint(text);
    }
    if (ImGui::TableGetColumnIndex() + 1 < ImGui::TableGetColumnCount())
        cell_shown = ImGui::TableNextColumn();
}

void ui_end_table(void)
{
    ImGui::EndTable();
}
