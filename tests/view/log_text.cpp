/* Texts that Dear ImGui draws, for tests. */
#include "log_text.h"

#include <imgui.h>

void log_text_begin(void)
{
    ImGui::LogToClipboard();
}

const char *log_text_end(void)
{
    ImGui::LogFinish();
    const char *text = ImGui::GetClipboardText();
    return text ? text : "";
}
