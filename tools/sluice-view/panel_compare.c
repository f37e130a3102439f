#include "panel_compare.h"

#include "actions.h"
#include "panels.h"
#include "sets.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *panel_compare_name(const struct view_app *app, char *text, size_t size)
{
    char name[160];
    snprintf(text, size, "B: %s", sets_name_second(&app->settings, &app->b, name, sizeof name));
    return text;
}

/* "A 2.30 ms, B 2.19 ms on the GPU: 0.11 ms less" */
static void draw_times(const struct half_series *a, const struct half_series *b, const char *where)
{
    const double left = half_series_median(a, HALF_TIMES_SHOWN);
    const double right = half_series_median(b, HALF_TIMES_SHOWN);
    const uint32_t count = half_series_count(b, HALF_TIMES_SHOWN);
    if (left < 0 || right < 0)
        ui_text(UI_GRAY, "A ... ms, B ... ms %s", where);
    else
        ui_text(UI_WHITE, "A %.2f ms, B %.2f ms %s: %.2f ms %s", left, right, where,
                fabs(right - left), right < left ? "less" : "more");
    ui_hint("Medians of %u frame%s. A and B are drawn one after the other, each over the whole "
            "picture. Binds of a sparse queue and the panels are not in these times.",
            count, count == 1 ? "" : "s");
}

static const char *sharp_words(const struct view_facts *f, char *text, size_t size)
{
    if (f->sharp_known)
        snprintf(text, size, "%.0f %%", floor(100.0 * f->sharp));
    else
        snprintf(text, size, "... %%");
    return text;
}

void panel_compare_figures(const struct view_app *app)
{
    const struct half_times *a = &app->times[0], *b = &app->times[1];
    char left[32], right[32], name[160];
    ui_text(UI_BLUE, "A and %s", panel_compare_name(app, name, sizeof name));
    if (!app->deterministic) {
        draw_times(&a->gpu, &b->gpu, "on the GPU");
        draw_times(&a->host, &b->host, "on the host");
    }
    ui_text(UI_WHITE, "A %s, B %s resident",
            panel_size(app->facts.resident_size, left, sizeof left),
            panel_size(app->facts_b.resident_size, right, sizeof right));
    ui_text(UI_WHITE, "A %s, B %s sharp", sharp_words(&app->facts, left, sizeof left),
            sharp_words(&app->facts_b, right, sizeof right));
    if (app->settings.compared == VIEW_WITH_EVERYTHING &&
        app->facts_b.resident_size < app->facts_b.all_size && app->facts_b.now.loadsInFlight > 0)
        ui_text(UI_ORANGE, "B is still loading: %.0f %%",
                100.0 * (double)app->facts_b.resident_size / (double)app->facts_b.all_size);
    ui_text(UI_GRAY, "each is drawn over the whole picture");
}

static void draw_preset(struct view_app *app, const char *label, int compared, const char *hint)
{
    if (ui_button(label, 0, 0, app->settings.compared == compared)) {
        if (compared == VIEW_WITH_B)
            sets_copy(&app->settings, &app->b);
        app->settings.compared = compared;
    }
    ui_hint("%s", hint);
}

void panel_compare_choose(struct view_app *app)
{
    ui_text(UI_GRAY, "Settings of");
    ui_same_line(0);
    if (ui_button("A", 44 * ui_scale(), 0, !app->edits_b))
        app->edits_b = false;
    ui_hint("Controls change A: the picture, and the left picture of a comparison.");
    ui_same_line(0);
    if (ui_button("B", 44 * ui_scale(), 0, app->edits_b))
        app->edits_b = true;
    ui_hint(
        "Controls change B, which V compares with A. Controls that are not listed then are shared. "
        "--b NAME=VALUE");
    ui_same_line(0);
    if (ui_button("Swap (X)", 0, 0, false))
        actions_press(app, 'X', 0);
    ui_hint("Exchanges A and B with their tiles: nothing is loaded again. Key X.");
    if (!app->edits_b)
        return;
    draw_preset(app, "everything", VIEW_WITH_EVERYTHING,
                "B follows A and has everything resident. --compare-to everything");
    ui_same_line(0);
    draw_preset(app, "16 MB", VIEW_WITH_BUDGET,
                "B follows A and has 16 MiB for tiles. --compare-to budget");
    ui_same_line(0);
    draw_preset(app, "own, as A now", VIEW_WITH_B,
                "B gets a copy of the settings of A, and follows A no longer. --compare-to b");
}

static void exchange_facts(struct view_app *app)
{
    const struct view_facts facts = app->facts;
    struct stage *stage = app->stage;
    app->facts = app->facts_b;
    app->facts_b = facts;
    app->stage = app->other;
    app->other = stage;
}

void panel_compare_begin_set(struct view_app *app, struct panel_compare_set *set)
{
    *set = (struct panel_compare_set){.is_b = app->edits_b};
    if (!set->is_b)
        return;
    set->a = app->settings;
    app->settings = set->before = sets_of_second(&set->a, &app->b);
    set->has_facts = app->other != NULL;
    if (set->has_facts)
        exchange_facts(app);
}

void panel_compare_end_set(struct view_app *app, const struct panel_compare_set *set)
{
    if (!set->is_b)
        return;
    const struct view_settings now = app->settings;
    app->settings = set->a;
    if (set->has_facts)
        exchange_facts(app);
    if (memcmp(&now, &set->before, sizeof now) == 0)
        return;
    sets_copy(&now, &app->b);
    app->settings.compared = VIEW_WITH_B;
}
