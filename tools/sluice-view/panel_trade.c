#include "panels.h"

#include "trade.h"

static void draw_bar(const struct trade *trade)
{
    float r[4];
    const float part = trade->total > 0 ? (float)trade->done / (float)trade->total : 0.0f;
    ui_canvas(0, 10 * ui_scale(), r);
    ui_fill(r[0], r[1], r[2], r[3], UI_COLOR(50, 56, 66, 255));
    ui_fill(r[0], r[1], r[2] * part, r[3], UI_COLOR(70, 150, 220, 255));
}

static void draw_state(struct view_app *app)
{
    const struct trade *trade = app->trade;
    switch (trade->state) {
    case TRADE_NONE: break;
    case TRADE_RUNS:
        ui_text(UI_WHITE, "%u of %u runs", trade->done, trade->total);
        draw_bar(trade);
        ui_paragraph(UI_GRAY, "This window draws 10 frames per second meanwhile, because it "
                              "disturbs the times.");
        break;
    case TRADE_CANCELED: ui_text(UI_ORANGE, "Canceled after %u runs", trade->done); break;
    case TRADE_FAILED: ui_paragraph(UI_RED, trade->reason); break;
    case TRADE_DONE:
        for (int i = 0; i < TRADE_ADVICE; i++)
            ui_paragraph(UI_WHITE, trade->advice[i]);
        if (ui_button("Open the page", 0, 0, false))
            app->trade_page = true;
        ui_hint("Opens %s with the program that the desktop has for it.", trade_page());
        ui_paragraph(UI_GRAY, trade_page());
        break;
    }
}

void panel_trade(struct view_app *app)
{
    if (!app->open[PANEL_TRADE])
        return;
    if (panel_begin(app, PANEL_TRADE, "Trade-offs (Shift+T)", 420, 300)) {
        const bool runs = app->trade->state == TRADE_RUNS;
        ui_paragraph(UI_GRAY,
                     "Follows the recorded path of the camera (R), or the walk of the scene, with "
                     "many settings, and shows what each costs. The settings of now are the base.");
        if (ui_button(runs ? "Cancel" : "Sweep", 0, 0, false))
            app->trade_toggle = true;
        ui_hint("Runs sluice-tradeoff, or ends it. Key Ctrl+T.");
        draw_state(app);
    }
    ui_end_panel();
}
