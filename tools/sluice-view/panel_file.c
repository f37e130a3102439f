#include "panels.h"

#include "messages.h"

#include "../common/remote.h"

#include <stdio.h>
#include <string.h>

#define LABEL_END 26u /* column of values in reports */
#define MOST_LINES 40u

/* Draws a line of the report. "  format                  RGBA8" has a label and a value. */
static void draw_line(const char *line, size_t length)
{
    char text[512], label[LABEL_END] = "";
    snprintf(text, sizeof text, "%.*s", (int)length, line);
    if (length <= LABEL_END || strncmp(text, "  ", 2) != 0 || text[LABEL_END - 1] != ' ' ||
        text[LABEL_END] == ' ') {
        ui_paragraph(text[0] == ' ' ? UI_WHITE : UI_BLUE, text);
        return;
    }
    memcpy(label, text + 2, LABEL_END - 2);
    label[LABEL_END - 2] = '\0';
    ui_text(UI_GRAY, "%s", label);
    ui_same_line(150 * ui_scale());
    ui_paragraph(UI_WHITE, text + LABEL_END);
}

static void draw_report(const struct file_facts *facts)
{
    for (const char *line = facts->report; *line;) {
        const size_t length = strcspn(line, "\n");
        draw_line(line, length);
        line += length + (line[length] == '\n');
    }
}

/* Returns the texture of the opened file; STAGE_NO_TEXTURE: none. */
static uint32_t find_texture(const struct view_app *app)
{
    for (uint32_t i = 0; app->stage && i < stage_texture_count(app->stage); i++)
        if (strcmp(stage_texture(app->stage, i)->path, app->file.path) == 0)
            return i;
    return STAGE_NO_TEXTURE;
}

/* Draws facts of an opened file without a report: a scene, or a picture without tiles. */
static void draw_opened(const struct view_app *app)
{
    const uint32_t texture = find_texture(app);
    ui_paragraph(UI_BLUE, app->file.path);
    if (texture != STAGE_NO_TEXTURE) {
        const struct stage_texture *t = stage_texture(app->stage, texture);
        ui_text(UI_WHITE, "%u x %u texels, %u levels, %s", t->width, t->height, t->level_count,
                t->format);
        ui_paragraph(UI_GRAY, remote_is_url(app->file.path)
                                  ? "On a server: sluice-info URL has its report."
                                  : "A picture without tiles. It is prepared once, and its tile "
                                    "store is kept in the cache (--cache).");
    } else if (app->stage && stage_streamer(app->stage)) {
        ui_text(UI_WHITE, "%u triangles, %u textures, %u cameras", stage_triangle_count(app->stage),
                stage_texture_count(app->stage), stage_camera_count(app->stage));
    }
}

/* Draws a message and its advice. Equal advice of consecutive messages is shown once, below the
 * last. */
static void draw_message(uint32_t number, const char *text)
{
    char next[512];
    const char *advice = messages_advice(text);
    ui_paragraph(UI_ORANGE, text);
    if (messages_get(number + 1, next, sizeof next) && messages_advice(next) == advice)
        return;
    if (advice)
        ui_paragraph(UI_GRAY, advice);
    ui_space(3);
}

/* Draws messages, oldest first: causes come before their effects. */
static void draw_messages(const struct file_facts *facts)
{
    char text[512];
    const uint32_t count = messages_count();
    uint32_t shown = 0;
    for (uint32_t i = facts->first_message; i < count && shown < MOST_LINES; i++)
        if (messages_get(i, text, sizeof text)) {
            draw_message(i, text);
            shown++;
        }
    if (count - facts->first_message > shown)
        ui_text(UI_GRAY, "%u more on the terminal", count - facts->first_message - shown);
}

void panel_file(struct view_app *app)
{
    const struct file_facts *facts = &app->file;
    if (!app->open[PANEL_FILE])
        return;
    if (panel_begin(app, PANEL_FILE, "File and messages (Shift+I)", 460, 360)) {
        const bool said = messages_count() > facts->first_message;
        if (facts->failed[0]) {
            ui_paragraph(UI_RED, "This cannot be opened; the previous scene stays:");
            ui_paragraph(UI_WHITE, facts->failed);
        }
        draw_messages(facts);
        if (facts->path[0] && (facts->report || !facts->failed[0])) {
            if (said || facts->failed[0])
                ui_line();
            if (facts->report)
                draw_report(facts);
            else
                draw_opened(app);
        } else if (!said && !facts->failed[0]) {
            ui_paragraph(UI_GRAY, "Nothing was said since the scene was opened. Drop a file, or "
                                  "select a texture and press \"Its file\" in the inspector (I).");
        }
    }
    ui_end_panel();
}
