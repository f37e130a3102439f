#include "panels.h"

#include "thumbs.h"

#include "../common/output_file.h"

#define CSV_FILE "sluice-view-textures.csv"

static void draw_level(uint32_t color, uint32_t level)
{
    if (level == SLUICE_MIP_UNTOUCHED)
        ui_table_cell(color, "tail");
    else
        ui_table_cell(color, "%u", level);
}

static void draw_seen(uint32_t color, double seconds)
{
    if (seconds < 0)
        ui_table_cell(color, "never");
    else if (seconds < 60)
        ui_table_cell(color, "%.1f s ago", seconds);
    else
        ui_table_cell(color, "%.0f min ago", seconds / 60);
}

/* Draws the cells of a row or of the sum. */
static void draw_figures(const struct texture_row *r, uint32_t color)
{
    char size[32];
    ui_table_cell(r->thrash > 3 ? UI_ORANGE : color, "%.1f", r->thrash);
    ui_table_cell(color, "%llu", (unsigned long long)r->loads);
    ui_table_cell(color, "%llu", (unsigned long long)r->resident);
    ui_table_cell(color, "%llu", (unsigned long long)r->wanted);
    ui_table_cell(color, "%llu", (unsigned long long)r->all);
    ui_table_cell(color, "%s", panel_size(r->size, size, sizeof size));
    draw_level(color, r->finest_level);
    draw_seen(color, r->seen_seconds);
    ui_table_cell(color, "%llu", (unsigned long long)r->evictions);
    ui_table_cell(r->failures ? UI_RED : color, "%llu", (unsigned long long)r->failures);
}

static void draw_row(void *user_data, uint32_t row)
{
    struct view_app *app = user_data;
    const struct texture_row *r = &app->table.rows[row];
    const float name_width = ui_panel_width() / 3;
    char name[256];
    const bool wanted = app->facts.textures[r->texture].statistics.wanted;
    const uint32_t color = wanted ? UI_WHITE : UI_GRAY;
    if (ui_table_row((int)r->texture, app->selected == r->texture)) {
        app->selected = r->texture;
        app->inspect = (struct stage_pick){.texture = r->texture, .hit = false};
        app_set_panel(app, PANEL_INSPECTOR, true);
    }
    float uv[4];
    if (app->thumbs && thumbs_find(app->thumbs, r->texture, uv))
        ui_table_image(UI_TEXTURE_THUMBS, ui_text_height(), uv);
    ui_table_cell(color, "%s", panel_shorten(r->name, name_width, name, sizeof name));
    ui_hint("%s", r->name);
    draw_figures(r, color);
    ui_table_cell(color, "%u x %u", r->width, r->height);
    ui_table_cell(color, "%s", r->format);
    ui_table_cell(color, "%u", r->level_count);
    ui_table_cell(color, "%s", r->set);
    ui_table_cell(color, "%s", r->source);
}

static void draw_sum(const struct texture_row *sum, uint32_t count)
{
    ui_table_row(-1, false);
    ui_table_cell(UI_BLUE, "sum of %u", count);
    draw_figures(sum, UI_BLUE);
}

static void write_csv(struct view_app *app)
{
    struct output_file *output = output_file_begin(CSV_FILE);
    if (!output)
        return;
    app->table.next = 0; /* gathers the rows again before writing */
    texture_table_update(&app->table, app->stage, &app->facts, app->texture_filter, NULL,
                         app->seconds);
    const bool good =
        texture_rows_write(output_file_stream(output), app->table.rows, app->table.count);
    if (output_file_end(output, good))
        app_say(app, "Wrote %s", CSV_FILE);
}

static void draw_table(struct view_app *app)
{
    struct texture_order order = app->table.order;
    if (!ui_begin_table("textures",
                        "Name|Loads/tile|Loads=99999|Resident|Wanted|All|Memory=9 999 MB|Finest|"
                        "Seen=99.9 s ago|Evicted|Failed|Size|Format|Levels|Set|Source",
                        0, true))
        return;
    ui_table_sort(&order.column, &order.descending);
    texture_table_update(&app->table, app->stage, &app->facts, app->texture_filter, &order,
                         app->seconds);
    draw_sum(&app->table.sum, app->table.count);
    ui_table_rows(app->table.count, draw_row, app);
    ui_end_table();
}

void panel_textures(struct view_app *app)
{
    if (!app->open[PANEL_TEXTURES])
        return;
    if (panel_begin(app, PANEL_TEXTURES, "Textures (T)", 660, 360)) {
        char resident[32], all[32];
        ui_text(UI_WHITE, "%u textures, %s of %s resident", app->facts.texture_count,
                panel_size(app->facts.resident_size, resident, sizeof resident),
                panel_size(app->facts.all_size, all, sizeof all));
        ui_same_line(0);
        const bool writes = ui_button("CSV", 0, 0, false);
        ui_hint("Writes the rows that are shown to " CSV_FILE " in the current folder.");
        ui_same_line(0);
        ui_item_width(150 * ui_scale());
        ui_type_text("##filter", "filter", app->texture_filter, sizeof app->texture_filter);
        ui_hint("Words that must be in the name, format, set or source of a texture.");
        if (writes)
            write_csv(app);
        draw_table(app);
    }
    ui_end_panel();
}
