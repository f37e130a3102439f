#include "panels.h"

#include "panel_played.h"
#include "panel_traced.h"

#include <stdio.h>

static const char *const stage_names[] = {"feedback", "queue", "read", "bind", "copy"};

/* Returns the largest wait of a bucket. */
static uint64_t bucket_end(const SluiceLoadStageCounts *stage, int bucket)
{
    const uint64_t end = (1ull << bucket) - 1;
    return end < stage->frameMax && bucket + 1 < SLUICE_STAGE_BUCKET_COUNT ? end : stage->frameMax;
}

/* Returns the quantile of a stage in frames, rounded up to the end of its bucket. */
static uint64_t stage_wait(const SluiceLoadStageCounts *stage, double part)
{
    uint64_t sum = 0;
    for (int i = 0; i < SLUICE_STAGE_BUCKET_COUNT; i++) {
        sum += stage->buckets[i];
        if (stage->count > 0 && (double)sum >= part * (double)stage->count)
            return bucket_end(stage, i);
    }
    return stage->frameMax;
}

static void draw_bars(const uint64_t *counts, float height)
{
    float r[4], x, y;
    char text[96];
    uint64_t most = 1;
    for (int i = 0; i < SLUICE_STAGE_BUCKET_COUNT; i++)
        most = counts[i] > most ? counts[i] : most;
    ui_canvas(0, height * ui_scale(), r);
    const bool hovered = ui_hovered();
    ui_mouse(&x, &y);
    const float step = r[2] / SLUICE_STAGE_BUCKET_COUNT;
    for (int i = 0; i < SLUICE_STAGE_BUCKET_COUNT; i++) {
        const float left = r[0] + (float)i * step;
        const float size = r[3] * (float)((double)counts[i] / (double)most);
        ui_fill(left, r[1], step - 2, r[3], UI_COLOR(30, 34, 40, 255));
        ui_fill(left, r[1] + r[3] - size, step - 2, size, UI_COLOR(86, 180, 233, 255));
        if (!hovered || x < left || x >= left + step)
            continue;
        const unsigned first = i > 0 ? 1u << (i - 1) : 0u, last = (1u << i) - 1u;
        if (i + 1 == SLUICE_STAGE_BUCKET_COUNT)
            snprintf(text, sizeof text, "%llu after %u frames or more",
                     (unsigned long long)counts[i], first);
        else if (first == last)
            snprintf(text, sizeof text, "%llu after %u frame%s", (unsigned long long)counts[i],
                     first, first == 1 ? "" : "s");
        else
            snprintf(text, sizeof text, "%llu after %u to %u frames", (unsigned long long)counts[i],
                     first, last);
        ui_show_hint(text);
    }
}

static void draw_stage(const SluiceLoadStageCounts *stage, const char *name)
{
    ui_text(UI_WHITE, "%s", name);
    ui_same_line(90 * ui_scale());
    ui_text(UI_GRAY, "p50 %llu   p99 %llu   most %llu   mean %.1f frames",
            (unsigned long long)stage_wait(stage, 0.5), (unsigned long long)stage_wait(stage, 0.99),
            (unsigned long long)stage->frameMax,
            stage->count ? (double)stage->frameSum / (double)stage->count : 0.0);
    ui_hint(
        "%llu maps or tiles left this stage. p50 and p99: frames that 50 %% and 99 %% of them did "
        "not exceed, rounded up to 1, 3, 7, 15, ...",
        (unsigned long long)stage->count);
    draw_bars(stage->buckets, 18);
}

/* Draws exact waits. The stages have buckets of powers of 2 only. */
static void draw_whole(const struct tile_log *log)
{
    uint64_t buckets[SLUICE_STAGE_BUCKET_COUNT] = {0};
    for (uint32_t frames = 0; frames <= TILE_LOG_MOST_WAIT; frames++) {
        int bucket = 0;
        while (bucket + 1 < SLUICE_STAGE_BUCKET_COUNT && frames >> bucket)
            bucket++;
        buckets[bucket] += log->waits[frames];
    }
    ui_text(UI_BLUE, "whole way");
    ui_same_line(90 * ui_scale());
    ui_text(UI_WHITE, "p50 %u   p99 %u   most %u frames", tile_log_wait(log, 0.5),
            tile_log_wait(log, 0.99), tile_log_wait(log, 1.0));
    ui_hint("From the request of a tile until it is resident: %llu loads. Feedback comes before.",
            (unsigned long long)log->wait_count);
    draw_bars(buckets, 26);
}

static void draw_reads(const SluiceTileLoaderStatistics *reads, const char *name, int row,
                       float name_width)
{
    char shortened[256];
    ui_table_row(row, false);
    ui_table_cell(row == 0 ? UI_BLUE : UI_WHITE, "%s",
                  panel_shorten(name, name_width, shortened, sizeof shortened));
    ui_table_cell(UI_WHITE, "%llu", (unsigned long long)reads->readCount);
    ui_table_cell(UI_WHITE, "%.2f", (double)reads->medianLatencyNs / 1e6);
    ui_table_cell(UI_WHITE, "%.2f", (double)reads->latency99Ns / 1e6);
    ui_table_cell(UI_WHITE, "%.2f", (double)reads->maxLatencyNs / 1e6);
    ui_table_cell(UI_WHITE, "%.1f", (double)reads->byteCount / 1e6);
    ui_table_cell(reads->failedCount ? UI_RED : UI_WHITE, "%llu",
                  (unsigned long long)reads->failedCount);
}

static void draw_sources(const struct view_app *app)
{
    const float name_width = ui_panel_width() / 4;
    ui_text(UI_GRAY, "Reads by source: milliseconds per read");
    if (!ui_begin_table("sources",
                        "Source|Reads=99999|p50=99.99|p99=999.99|Longest=999.99|MB=9999.9|Failed",
                        0, false))
        return;
    draw_reads(&app->facts.reads, "all", 0, name_width);
    for (uint32_t i = 0; i < app->facts.texture_count; i++)
        if (app->facts.textures[i].reads.readCount > 0)
            draw_reads(&app->facts.textures[i].reads, stage_texture(app->stage, i)->name,
                       (int)i + 1, name_width);
    ui_end_table();
}

static void draw_streamer(const struct view_app *app)
{
    ui_text(UI_GRAY, "Bars: 0, 1, 2-3, 4-7, ... frames from a mark to the picture");
    draw_whole(&app->facts.log);
    for (int i = 0; i < SLUICE_LOAD_STAGE_COUNT; i++)
        draw_stage(&app->facts.stages.stages[i], stage_names[i]);
    if (!app->deterministic)
        draw_sources(app);
}

void panel_latency(struct view_app *app)
{
    if (!app->open[PANEL_LATENCY])
        return;
    if (panel_begin(app, PANEL_LATENCY, "Latency (Y)", 480, 520)) {
        if (stage_traced(app->stage))
            panel_traced_latency(app);
        else if (stage_played(app->stage))
            panel_played_latency(app);
        else
            draw_streamer(app);
    }
    ui_end_panel();
}
