#include "gallery_report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/report.h"

void gallery_report_picture_path(const char *folder, const char *kind, uint32_t frame, char *path,
                                 size_t size)
{
    snprintf(path, size, "%s/%s-%04u.png", folder, kind, frame);
}

typedef double (*frame_value)(const struct frame_record *now, const struct frame_record *before);

static double psnr_value(const struct frame_record *now, const struct frame_record *before)
{
    (void)before;
    return now->psnr;
}

static double resident_value(const struct frame_record *now, const struct frame_record *before)
{
    (void)before;
    return measure_resident_tiles(now);
}

static double wanted_value(const struct frame_record *now, const struct frame_record *before)
{
    (void)before;
    return now->statistics.mappedTileCount + now->statistics.requestedTileCount +
           now->statistics.allocatedTileCount;
}

static double mapped_value(const struct frame_record *now, const struct frame_record *before)
{
    return (double)(now->statistics.tilesMapped - before->statistics.tilesMapped);
}

static double unmapped_value(const struct frame_record *now, const struct frame_record *before)
{
    return (double)(now->statistics.tilesUnmapped - before->statistics.tilesUnmapped);
}

static double uploaded_value(const struct frame_record *now, const struct frame_record *before)
{
    return (double)(now->statistics.bytesUploaded - before->statistics.bytesUploaded) / 1048576.0;
}

static double missing_value(const struct frame_record *now, const struct frame_record *before)
{
    (void)before;
    return now->missing_percent;
}

static double needed_value(const struct frame_record *now, const struct frame_record *before)
{
    (void)before;
    return now->needs.needed_tiles;
}

static double missing_regions_value(const struct frame_record *now,
                                    const struct frame_record *before)
{
    (void)before;
    return now->needs.missing_regions;
}

static double frame_time_value(const struct frame_record *now, const struct frame_record *before)
{
    (void)before;
    return 1e3 * now->frame_seconds;
}

static double host_time_value(const struct frame_record *now, const struct frame_record *before)
{
    (void)before;
    return 1e3 * now->host_seconds;
}

struct plot_line {
    const char *name;
    frame_value value;
};

static void add_plot(struct report *report, const struct measure *measure, const char *title,
                     const char *unit, double maximum, const struct plot_line *lines,
                     size_t line_count)
{
    const struct frame_record start = {.statistics = measure->start};
    const uint32_t first = measure->first_frame, count = measure->frame_count - first;
    const uint32_t rest = measure->rest_frame > first ? measure->rest_frame - first : 0;
    struct report_series series[2];
    double *values = calloc(2 * (size_t)count, sizeof *values);
    if (!values)
        return;
    for (size_t s = 0; s < line_count; s++) {
        double *line = values + s * count;
        series[s] = (struct report_series){lines[s].name, line};
        for (uint32_t i = first; i < measure->frame_count; i++)
            line[i - first] = lines[s].value(
                &measure->frames[i], i > measure->begin_frame ? &measure->frames[i - 1] : &start);
    }
    report_plot(report,
                &(struct report_plot){
                    .title = title,
                    .unit = unit,
                    .value_count = count,
                    .series_count = line_count,
                    .series = series,
                    .maximum = maximum,
                    .mark = rest < count || !measure->settings->range.given ? (double)rest : -1.0,
                    .mark_name = "camera at rest"});
    free(values);
}

static void add_plots(struct report *report, const struct measure *measure, bool compared)
{
    static const struct plot_line psnr[] = {{"PSNR to everything resident", psnr_value}};
    static const struct plot_line tiles[] = {{"resident", resident_value},
                                             {"wanted", wanted_value}};
    static const struct plot_line flow[] = {{"mapped", mapped_value}, {"unmapped", unmapped_value}};
    static const struct plot_line bytes[] = {{"uploaded", uploaded_value}};
    static const struct plot_line missing[] = {{"pixels coarser than wanted", missing_value}};
    static const struct plot_line needed[] = {{"resident", resident_value},
                                              {"needed by the frame", needed_value}};
    static const struct plot_line regions[] = {{"regions that wait", missing_regions_value}};
    static const struct plot_line times[] = {{"frame", frame_time_value},
                                             {"the application's thread", host_time_value}};
    if (compared)
        add_plot(report, measure, "Difference to everything resident", "dB (equality at the top)",
                 80.0, psnr, 1);
    if (measure->counting || measure->needs)
        add_plot(report, measure, "Missing detail", "% of the streamed pixels", 0.0, missing, 1);
    add_plot(report, measure, "Tiles in memory", "tiles of 64 KiB", 0.0, tiles, 2);
    if (measure->needs) {
        add_plot(report, measure, "Tiles in memory and needed", "tiles of 64 KiB", 0.0, needed, 2);
        add_plot(report, measure, "Detail that is not there yet", "regions of a tile", 0.0, regions,
                 1);
    }
    add_plot(report, measure, "Tiles mapped and unmapped", "tiles per frame", 0.0, flow, 2);
    add_plot(report, measure, "Uploads", "MiB per frame", 0.0, bytes, 1);
    add_plot(report, measure, "Time", "ms per frame", 0.0, times, 2);
}

static double figure_value(const struct figure *figures, uint32_t count, const char *name)
{
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(figures[i].name, name) == 0)
            return figures[i].value;
    return NAN;
}

/** Formats like "12.5 MiB, 6.3 % of all". */
static const char *share_text(double bytes, double all, char text[64])
{
    snprintf(text, 64, "%.1f MiB, %.1f %% of all", bytes / 1048576.0, 100.0 * bytes / all);
    return text;
}

/** Compares loaded bytes with those that the walk required. */
static void add_required(struct report *report, const struct figure *figures, uint32_t count)
{
    double all = figure_value(figures, count, "virtual_bytes");
    double needed = figure_value(figures, count, "needed_bytes");
    double loaded = figure_value(figures, count, "loaded_bytes");
    double used = needed - figure_value(figures, count, "needed_unloaded_bytes");
    double peak = figure_value(figures, count, "resident_bytes_peak");
    char texts[5][64], line[256];
    if (isnan(needed))
        return;
    const struct report_bar bars[] = {
        {"all textures", all, all, share_text(all, all, texts[0])},
        {"needed by some frame", needed, needed, share_text(needed, all, texts[1])},
        {"loaded (orange: in vain)", loaded, used, share_text(loaded, all, texts[2])},
        {"in memory, at most", peak, peak, share_text(peak, all, texts[3])},
        {"needed by one frame, at most", figure_value(figures, count, "needed_bytes_peak"),
         figure_value(figures, count, "needed_bytes_peak"),
         share_text(figure_value(figures, count, "needed_bytes_peak"), all, texts[4])},
    };
    report_heading(report, "Only what the scene requires");
    report_bars(report, bars, sizeof bars / sizeof *bars);
    snprintf(line, sizeof line,
             "Loaded per needed: %.3f. Of %.0f textures %.0f were never sampled, %.0f never read. "
             "Half of the detail that came to be needed was there after %.0f frames, 99 %% of it "
             "after %.0f.",
             loaded / needed, figure_value(figures, count, "textures"),
             figure_value(figures, count, "textures_never_sampled"),
             figure_value(figures, count, "textures_never_read"),
             figure_value(figures, count, "frames_until_sharp_p50"),
             figure_value(figures, count, "frames_until_sharp_p99"));
    report_text(report, line);
}

static void add_figures(struct report *report, const struct measure *measure)
{
    struct figure figures[MEASURE_MAX_FIGURES];
    uint32_t count = measure_figures(measure, figures);
    add_required(report, figures, count);
    report_heading(report, "Figures");
    report_begin_table(report);
    for (uint32_t i = 0; i < count; i++) {
        char buffer[32];
        if (!isnan(figures[i].value))
            report_row(report, figures[i].name, measure_format(figures[i].value, buffer),
                       figures[i].unit, figures[i].meaning);
    }
    report_end_table(report);
}

/** Writes the known parts of "frame 12, 34.5 dB, SSIM 0.9876". */
static void write_caption(const struct gallery_report_info *info, const struct measure *measure,
                          uint32_t frame, char *caption, size_t size)
{
    const struct frame_record *record = &measure->frames[frame];
    char psnr[32] = "", ssim[32] = "";
    if (info->compared && isinf(record->psnr))
        snprintf(psnr, sizeof psnr, ", the same picture");
    else if (info->compared)
        snprintf(psnr, sizeof psnr, ", %.1f dB", record->psnr);
    if (!isnan(record->ssim))
        snprintf(ssim, sizeof ssim, ", SSIM %.4f", record->ssim);
    snprintf(caption, size, "frame %u%s%s", frame, psnr, ssim);
}

static void add_picture(struct report *report, const struct gallery_report_info *info,
                        const char *kind, uint32_t frame, const char *caption)
{
    char path[4096];
    gallery_report_picture_path(info->folder, kind, frame, path, sizeof path);
    report_picture(report, path, caption);
}

/** Shows the frame, its truth and its error in a row. */
static void add_comparison(struct report *report, const struct gallery_report_info *info,
                           const struct measure *measure, uint32_t frame)
{
    char caption[128];
    report_begin_row(report);
    write_caption(info, measure, frame, caption, sizeof caption);
    add_picture(report, info, "frame", frame, caption);
    add_picture(report, info, "truth", frame, "everything resident");
    if (!isnan(measure->frames[frame].flip)) {
        snprintf(caption, sizeof caption, "what one sees of the difference: FLIP %.4f",
                 measure->frames[frame].flip);
        add_picture(report, info, "flip", frame, caption);
    }
    report_end_pictures(report);
}

static void add_frames(struct report *report, const struct gallery_report_info *info,
                       const struct measure *measure)
{
    report_heading(report, info->compared ? "Streamed, and with everything resident" : "Frames");
    report_begin_pictures(report);
    for (uint32_t i = 0; i < info->written_count; i++) {
        char caption[128];
        if (info->compared) {
            add_comparison(report, info, measure, info->written_frames[i]);
            continue;
        }
        write_caption(info, measure, info->written_frames[i], caption, sizeof caption);
        add_picture(report, info, "frame", info->written_frames[i], caption);
    }
    report_end_pictures(report);
}

static void add_pictures(struct report *report, const struct picture_list *pictures)
{
    report_heading(report, "Pictures");
    report_begin_table(report);
    for (uint32_t i = 0; i < pictures->count; i++) {
        char size[64];
        snprintf(size, sizeof size, "%u x %u", pictures->pictures[i].info.width,
                 pictures->pictures[i].info.height);
        report_row(report, pictures->pictures[i].path, size,
                   sluiceGetFormatName(pictures->pictures[i].info.format), NULL);
    }
    report_end_table(report);
}

bool gallery_report_write(const struct gallery_report_info *info, const struct measure *measure)
{
    char path[4096];
    struct report report;
    settings_report_path(measure->settings, "report", ".html", path, sizeof path);
    if (!report_begin(&report, path, "A walk through the gallery"))
        return false;
    report_code(&report, info->command_line);
    report_text(&report, info->device_name);
    add_figures(&report, measure);
    add_plots(&report, measure, info->compared);
    add_frames(&report, info, measure);
    add_pictures(&report, info->pictures);
    return report_end(&report);
}
