#include "panels.h"

#include "../common/output_file.h"
#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum column {
    COLUMN_NAME,
    COLUMN_SIZE,
    COLUMN_FORMAT,
    COLUMN_RESIDENT,
    COLUMN_WANTED,
    COLUMN_MEMORY,
    COLUMN_FINEST,
    COLUMN_LOADS,
    COLUMN_THRASH,
    COLUMN_EVICTED,
    COLUMN_FAILED
};

struct row {
    double key;
    const char *name;
    uint32_t texture;
};

static int compare_up(const void *left, const void *right)
{
    const struct row *a = left, *b = right;
    if (a->key != b->key)
        return a->key < b->key ? -1 : 1;
    int order = strcmp(a->name, b->name);
    return order ? order : (int)a->texture - (int)b->texture;
}

static int compare_down(const void *left, const void *right)
{
    return compare_up(right, left);
}

static double key_of(const struct facts_texture *f, const struct stage_texture *t, uint32_t column)
{
    switch ((enum column)column) {
    case COLUMN_SIZE: return (double)t->width * t->height;
    case COLUMN_RESIDENT: return f->statistics.residentTileCount;
    case COLUMN_WANTED: return f->statistics.wantedTileCount;
    case COLUMN_MEMORY: return (double)f->statistics.residentSize;
    case COLUMN_FINEST: return f->finest_level;
    case COLUMN_LOADS: return f->statistics.mappedTotal;
    case COLUMN_THRASH: return f->thrash;
    case COLUMN_EVICTED: return f->statistics.unmappedTotal;
    case COLUMN_FAILED: return f->statistics.failedTotal;
    default: return 0;
    }
}

static void draw_row(struct view_app *app, uint32_t index)
{
    const struct stage_texture *t = stage_texture(app->stage, index);
    const struct facts_texture *f = &app->facts.textures[index];
    const SluiceTextureStatistics *s = &f->statistics;
    const uint32_t color = s->wanted ? UI_WHITE : UI_GRAY;
    char size[32];
    if (ui_table_row((int)index, app->selected == index)) {
        app->selected = index;
        app->inspect = (struct stage_pick){.texture = index, .hit = false};
        app_set_panel(app, PANEL_INSPECTOR, true);
    }
    ui_table_cell(color, "%s", t->name);
    ui_table_cell(color, "%u x %u", t->width, t->height);
    ui_table_cell(color, "%s", t->format);
    ui_table_cell(color, "%u", s->residentTileCount);
    ui_table_cell(color, "%u", s->wantedTileCount);
    ui_table_cell(color, "%s", panel_size(s->residentSize, size, sizeof size));
    if (f->finest_level < t->level_count)
        ui_table_cell(color, "%u", f->finest_level);
    else
        ui_table_cell(color, "tail");
    ui_table_cell(color, "%u", s->mappedTotal);
    ui_table_cell(f->thrash > 3 ? UI_ORANGE : color, "%.1f", f->thrash);
    ui_table_cell(color, "%u", s->unmappedTotal);
    ui_table_cell(s->failedTotal ? UI_RED : color, "%u", s->failedTotal);
}

static void write_csv(struct view_app *app)
{
    static const char path[] = "sluice-view-textures.csv";
    struct output_file *output = output_file_begin(path);
    if (!output)
        return;
    FILE *file = output_file_stream(output);
    fprintf(file,
            "name,width,height,format,resident_tiles,wanted_tiles,resident_bytes,finest_level,"
            "loads,loads_per_tile,evictions,failures\n");
    for (uint32_t i = 0; i < app->facts.texture_count; i++) {
        const struct stage_texture *t = stage_texture(app->stage, i);
        const struct facts_texture *f = &app->facts.textures[i];
        text_write_json(file, t->name);
        fprintf(file, ",%u,%u,%s,%u,%u,%llu,%u,%u,%.3f,%u,%u\n", t->width, t->height, t->format,
                f->statistics.residentTileCount, f->statistics.wantedTileCount,
                (unsigned long long)f->statistics.residentSize, f->finest_level,
                f->statistics.mappedTotal, f->thrash, f->statistics.unmappedTotal,
                f->statistics.failedTotal);
    }
    if (output_file_end(output, true))
        app_say(app, "Wrote %s", path);
}

static void draw_table(struct view_app *app, struct row *rows)
{
    uint32_t column = COLUMN_NAME;
    bool descending = false;
    if (!ui_begin_table("textures",
                        "Name|Size|Format|Resident|Wanted|Memory|Finest|Loads|Loads/tile|Evicted|"
                        "Failed",
                        0, true))
        return;
    ui_table_sort(&column, &descending);
    for (uint32_t i = 0; i < app->facts.texture_count; i++)
        rows[i] =
            (struct row){key_of(&app->facts.textures[i], stage_texture(app->stage, i), column),
                         stage_texture(app->stage, i)->name, i};
    qsort(rows, app->facts.texture_count, sizeof *rows, descending ? compare_down : compare_up);
    for (uint32_t i = 0; i < app->facts.texture_count; i++)
        draw_row(app, rows[i].texture);
    ui_end_table();
}

void panel_textures(struct view_app *app)
{
    if (!app->open[PANEL_TEXTURES])
        return;
    struct row *rows = calloc(app->facts.texture_count + 1, sizeof *rows);
    if (panel_begin(app, PANEL_TEXTURES, "Textures (T)", 620, 360) && rows) {
        char resident[32], all[32];
        ui_text(UI_WHITE, "%u textures, %s of %s resident", app->facts.texture_count,
                panel_size(app->facts.resident_size, resident, sizeof resident),
                panel_size(app->facts.all_size, all, sizeof all));
        ui_same_line(0);
        if (ui_button("CSV", 0, 0, false))
            write_csv(app);
        ui_hint("Writes the table to sluice-view-textures.csv in the current folder.");
        draw_table(app, rows);
    }
    ui_end_panel();
    free(rows);
}
