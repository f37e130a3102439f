#include "ui.h"

#include "keys.h"
#include "ui_theme.h"

#include <imgui.h>

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static_assert(sizeof(ui_vertex) == sizeof(ImDrawVert), "vertices are those of ImGui");
static_assert(sizeof(ImDrawIdx) == 2, "indices are those of ImGui");

namespace
{

struct array {
    void *items;
    size_t size, capacity;
};

/* State from ui_create to ui_destroy, like ImGui's own context. */
struct state {
    float scale;
    ImFont *font, *large;
    uint8_t *font_pixels;
    int font_width, font_height;
    array vertices, indices, draws;
    void (*set_clipboard)(void *, const char *);
    const char *(*get_clipboard)(void *);
    void *clipboard_user;
    char *clipboard;
} * ui;

const char *const fonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                             "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
                             "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
                             "/usr/share/fonts/TTF/DejaVuSans.ttf",
                             "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"};

ImGuiKey imgui_key(int key)
{
    switch (key) {
    case VIEW_KEY_TAB: return ImGuiKey_Tab;
    case VIEW_KEY_LEFT: return ImGuiKey_LeftArrow;
    case VIEW_KEY_RIGHT: return ImGuiKey_RightArrow;
    case VIEW_KEY_UP: return ImGuiKey_UpArrow;
    case VIEW_KEY_DOWN: return ImGuiKey_DownArrow;
    case VIEW_KEY_PAGE_UP: return ImGuiKey_PageUp;
    case VIEW_KEY_PAGE_DOWN: return ImGuiKey_PageDown;
    case VIEW_KEY_HOME: return ImGuiKey_Home;
    case VIEW_KEY_END: return ImGuiKey_End;
    case VIEW_KEY_INSERT: return ImGuiKey_Insert;
    case VIEW_KEY_DELETE: return ImGuiKey_Delete;
    case VIEW_KEY_BACKSPACE: return ImGuiKey_Backspace;
    case VIEW_KEY_SPACE: return ImGuiKey_Space;
    case VIEW_KEY_ENTER: return ImGuiKey_Enter;
    case VIEW_KEY_ESCAPE: return ImGuiKey_Escape;
    case 'A': return ImGuiKey_A;
    case 'C': return ImGuiKey_C;
    case 'V': return ImGuiKey_V;
    case 'X': return ImGuiKey_X;
    case 'Y': return ImGuiKey_Y;
    case 'Z': return ImGuiKey_Z;
    default: return ImGuiKey_COUNT;
    }
}

bool is_file(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

void load_fonts()
{
    static const ImWchar ranges[] = {0x20,   0xFF,   0x2013, 0x2026, 0x2190, 0x2193,
                                     0x221E, 0x221E, 0x25A0, 0x25CF, 0};
    ImFontAtlas *atlas = ImGui::GetIO().Fonts;
    const char *path = nullptr;
    for (const char *candidate : fonts)
        if (!path && is_file(candidate))
            path = candidate;
    if (path) {
        ui->font = atlas->AddFontFromFileTTF(path, 15.0f * ui->scale, nullptr, ranges);
        ui->large = atlas->AddFontFromFileTTF(path, 22.0f * ui->scale, nullptr, ranges);
    }
    if (!ui->font || !ui->large) {
        ImFontConfig config;
        config.SizePixels = 13.0f * ui->scale;
        ui->font = atlas->AddFontDefault(&config);
        config.SizePixels = 20.0f * ui->scale;
        ui->large = atlas->AddFontDefault(&config);
    }
    atlas->GetTexDataAsRGBA32(&ui->font_pixels, &ui->font_width, &ui->font_height);
    atlas->SetTexID((ImTextureID)(intptr_t)UI_TEXTURE_FONT);
}

void choose_style()
{
    ImGuiStyle &style = ImGui::GetStyle();
    ui_choose_theme(UI_DARK);
    style.WindowRounding = 6.0f;
    style.FrameRounding = 4.0f;
    style.GrabRounding = 4.0f;
    style.WindowPadding = ImVec2(12.0f, 10.0f);
    style.ItemSpacing = ImVec2(8.0f, 5.0f);
    style.ScaleAllSizes(ui->scale);
}

void set_clipboard(void *, const char *text)
{
    if (ui->set_clipboard) {
        ui->set_clipboard(ui->clipboard_user, text);
        return;
    }
    free(ui->clipboard);
    ui->clipboard = strdup(text);
}

const char *get_clipboard(void *)
{
    if (ui->get_clipboard)
        return ui->get_clipboard(ui->clipboard_user);
    return ui->clipboard ? ui->clipboard : "";
}

void *array_add(array *array, const void *items, size_t size)
{
    if (array->size + size > array->capacity) {
        size_t capacity = 2 * (array->size + size);
        void *grown = realloc(array->items, capacity);
        if (!grown)
            return nullptr;
        array->items = grown;
        array->capacity = capacity;
    }
    void *added = (char *)array->items + array->size;
    memcpy(added, items, size);
    array->size += size;
    return added;
}

int32_t clamp(float value, float most)
{
    return (int32_t)(value < 0.0f ? 0.0f : value > most ? most : value);
}

void add_draw(const ImDrawCmd &command, uint32_t first_index, uint32_t first_vertex)
{
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const uintptr_t id = (uintptr_t)command.GetTexID();
    const ui_draw draw = {{clamp(command.ClipRect.x, size.x), clamp(command.ClipRect.y, size.y),
                           clamp(command.ClipRect.z, size.x), clamp(command.ClipRect.w, size.y)},
                          (uint32_t)(id & ((1u << UI_MODE_SHIFT) - 1)),
                          (uint32_t)(id >> UI_MODE_SHIFT),
                          first_index + command.IdxOffset,
                          command.ElemCount,
                          (int32_t)(first_vertex + command.VtxOffset)};
    if (draw.clip[2] > draw.clip[0] && draw.clip[3] > draw.clip[1] && draw.index_count > 0)
        array_add(&ui->draws, &draw, sizeof draw);
}

/* Adds a list of triangles. Leaves it out without memory. */
void add_list(const ImDrawList *list)
{
    const uint32_t first_index = (uint32_t)(ui->indices.size / sizeof(uint16_t));
    const uint32_t first_vertex = (uint32_t)(ui->vertices.size / sizeof(ui_vertex));
    if (list->CmdBuffer.Size == 0 || list->VtxBuffer.Size == 0 ||
        !array_add(&ui->vertices, list->VtxBuffer.Data,
                   (size_t)list->VtxBuffer.Size * sizeof(ui_vertex)) ||
        !array_add(&ui->indices, list->IdxBuffer.Data,
                   (size_t)list->IdxBuffer.Size * sizeof(uint16_t)))
        return;
    for (const ImDrawCmd &command : list->CmdBuffer)
        add_draw(command, first_index, first_vertex);
}

void pass_keys(const ui_input *input)
{
    ImGuiIO &io = ImGui::GetIO();
#if IMGUI_VERSION_NUM >= 18700
    io.AddKeyEvent(ImGuiMod_Shift, input->shift);
    io.AddKeyEvent(ImGuiMod_Ctrl, input->control);
    io.AddKeyEvent(ImGuiMod_Alt, input->alt);
#else
    io.KeyShift = input->shift;
    io.KeyCtrl = input->control;
    io.KeyAlt = input->alt;
#endif
    for (uint32_t i = 0; i < input->key_count; i++) {
        const ui_key_event &event = input->keys[i];
        const ImGuiKey key = imgui_key(event.key);
        if (key == ImGuiKey_COUNT)
            continue;
#if IMGUI_VERSION_NUM >= 18700
        io.AddKeyEvent(key, event.down);
#else
        io.KeysDown[event.key] = event.down;
#endif
    }
    io.AddInputCharactersUTF8(input->text);
}

} // namespace

bool ui_create(float scale)
{
    ui = (state *)calloc(1, sizeof *ui);
    if (!ui) {
        fprintf(stderr, "sluice-view: out of memory\n");
        return false;
    }
    ui->scale = scale;
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    io.SetClipboardTextFn = set_clipboard;
    io.GetClipboardTextFn = get_clipboard;
#if IMGUI_VERSION_NUM < 18700
    for (int key = 0; key < VIEW_KEY_COUNT; key++)
        if (imgui_key(key) != ImGuiKey_COUNT)
            io.KeyMap[imgui_key(key)] = key;
#endif
    load_fonts();
    choose_style();
    return true;
}

void ui_destroy(void)
{
    if (!ui)
        return;
    ImGui::DestroyContext();
    free(ui->vertices.items);
    free(ui->indices.items);
    free(ui->draws.items);
    free(ui->clipboard);
    free(ui);
    ui = nullptr;
}

const uint8_t *ui_font_pixels(uint32_t *width, uint32_t *height)
{
    *width = (uint32_t)ui->font_width;
    *height = (uint32_t)ui->font_height;
    return ui->font_pixels;
}

void ui_set_clipboard(void (*set)(void *, const char *), const char *(*get)(void *),
                      void *user_data)
{
    ui->set_clipboard = set;
    ui->get_clipboard = get;
    ui->clipboard_user = user_data;
}

void ui_begin_frame(const ui_input *input)
{
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = ImVec2(input->width, input->height);
    io.DeltaTime = input->seconds;
#if IMGUI_VERSION_NUM >= 18700
    io.AddMousePosEvent(input->mouse_x, input->mouse_y);
    for (int i = 0; i < 3; i++)
        io.AddMouseButtonEvent(i, input->buttons[i]);
    if (input->wheel != 0.0f)
        io.AddMouseWheelEvent(0.0f, input->wheel);
#else
    io.MousePos = ImVec2(input->mouse_x, input->mouse_y);
    for (int i = 0; i < 3; i++)
        io.MouseDown[i] = input->buttons[i];
    io.MouseWheel = input->wheel;
#endif
    pass_keys(input);
    ImGui::NewFrame();
    ImGui::PushFont(ui->font);
}

void ui_end_frame(ui_geometry *geometry)
{
    ImGui::PopFont();
    ImGui::Render();
    const ImDrawData *data = ImGui::GetDrawData();
    ui->vertices.size = ui->indices.size = ui->draws.size = 0;
    for (int i = 0; i < data->CmdListsCount; i++)
        add_list(data->CmdLists[i]);
    *geometry = ui_geometry{(const ui_vertex *)ui->vertices.items,
                            (const uint16_t *)ui->indices.items,
                            (const ui_draw *)ui->draws.items,
                            (uint32_t)(ui->vertices.size / sizeof(ui_vertex)),
                            (uint32_t)(ui->indices.size / sizeof(uint16_t)),
                            (uint32_t)(ui->draws.size / sizeof(ui_draw)),
                            data->DisplaySize.x,
                            data->DisplaySize.y};
}

void ui_copy_text(const char *text)
{
    ImGui::SetClipboardText(text);
}

bool ui_owns_mouse(void)
{
    return ImGui::GetIO().WantCaptureMouse;
}

/* Keys that move the focus belong to the user interface while a panel has the focus. */
bool ui_owns_key(int key)
{
    const ImGuiIO &io = ImGui::GetIO();
    if (io.WantTextInput)
        return true;
    const bool moves = key == VIEW_KEY_TAB || key == VIEW_KEY_SPACE || key == VIEW_KEY_ENTER ||
                       key == VIEW_KEY_DELETE || (key >= VIEW_KEY_RIGHT && key <= VIEW_KEY_UP);
    return io.NavVisible && io.WantCaptureKeyboard && moves;
}

float ui_scale(void)
{
    return ui->scale;
}

float ui_line_height(void)
{
    return ImGui::GetTextLineHeightWithSpacing();
}

float ui_text_height(void)
{
    return ImGui::GetTextLineHeight();
}

float ui_text_width(const char *text)
{
    return ImGui::CalcTextSize(text).x;
}

void ui_begin_large(void)
{
    ImGui::PushFont(ui->large);
}

void ui_end_large(void)
{
    ImGui::PopFont();
}
