#include "report.h"

#include "../../tools/common/input.h"
#include "../../tools/common/output_file.h"

#include <math.h>
#include <string.h>

#define PLOT_WIDTH 860
#define PLOT_HEIGHT 220
#define MARGIN_LEFT 64
#define MARGIN_TOP 10
#define MARGIN_BOTTOM 24
#define MARGIN_RIGHT 14
#define BAR_HEIGHT 24
#define BAR_LEFT 210
#define BAR_ROOM 460.0

static const char *const style =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:1000px;margin:2em auto;padding:0 1em;"
    "color:#222;background:#fbfaf8}h1,h2{font-weight:600}h2{margin-top:2em;font-size:1.15em}"
    "table{border-collapse:collapse}td{padding:.15em 1.2em .15em 0;border-bottom:1px solid #e3e0da}"
    "td:nth-child(2){text-align:right;font-variant-numeric:tabular-nums}"
    "pre{background:#efece6;padding:.7em;white-space:pre-wrap}svg{background:#fff;border:1px solid "
    "#e3e0da}figure{display:inline-block;margin:.3em .6em .3em 0;vertical-align:top}"
    "figure img{max-width:480px;width:100%;display:block}figcaption{font-size:.85em;color:#555}"
    ".k{font-size:.85em;margin-right:1.2em}.row{display:flex;gap:.6em}.row figure{flex:1;"
    "max-width:480px;margin-right:0}";

static const char *const colors[] = {"#1f6fb2", "#d1682c", "#3c8d40", "#8b4fb0", "#b03a48"};
#define COLOR_COUNT (sizeof colors / sizeof *colors)

static void put_escaped(FILE *file, const char *text)
{
    for (; *text; text++) {
        switch (*text) {
        case '<': fputs("&lt;", file); break;
        case '>': fputs("&gt;", file); break;
        case '&': fputs("&amp;", file); break;
        case '"': fputs("&quot;", file); break;
        default: fputc(*text, file);
        }
    }
}

static void put_element(FILE *file, const char *tag, const char *text)
{
    fprintf(file, "<%s>", tag);
    put_escaped(file, text);
    fprintf(file, "</%s>\n", tag);
}

bool report_begin(struct report *report, const char *path, const char *title)
{
    report->output = output_file_begin(path);
    if (!report->output)
        return false;
    report->file = output_file_stream(report->output);
    fprintf(report->file, "<!DOCTYPE html><html lang=\"en\"><meta charset=\"utf-8\"><title>");
    put_escaped(report->file, title);
    fprintf(report->file, "</title><style>%s</style>\n", style);
    put_element(report->file, "h1", title);
    return true;
}

void report_heading(struct report *report, const char *text)
{
    put_element(report->file, "h2", text);
}

void report_text(struct report *report, const char *text)
{
    put_element(report->file, "p", text);
}

void report_code(struct report *report, const char *text)
{
    put_element(report->file, "pre", text);
}

void report_begin_table(struct report *report)
{
    fputs("<table>\n", report->file);
}

void report_row(struct report *report, const char *name, const char *value, const char *unit,
                const char *meaning)
{
    const char *const cells[] = {name, value, unit, meaning};
    fputs("<tr>", report->file);
    for (int i = 0; i < 4 && cells[i]; i++)
        put_element(report->file, "td", cells[i]);
    fputs("</tr>\n", report->file);
}

void report_end_table(struct report *report)
{
    fputs("</table>\n", report->file);
}

/** Returns the smallest of 1, 2, 5, 10, ... that gives at most five steps. */
static double axis_step(double maximum)
{
    double step = pow(10.0, floor(log10(maximum / 5.0)));
    if (maximum / step > 25.0)
        return step * 10.0;
    if (maximum / step > 10.0)
        return step * 5.0;
    return maximum / step > 5.0 ? step * 2.0 : step;
}

static double largest_value(const struct report_plot *plot)
{
    double largest = plot->maximum;
    for (size_t s = 0; plot->maximum == 0.0 && s < plot->series_count; s++)
        for (size_t i = 0; i < plot->value_count; i++)
            if (isfinite(plot->series[s].values[i]))
                largest = fmax(largest, plot->series[s].values[i]);
    return largest > 0.0 ? largest : 1.0;
}

static double plot_x(const struct report_plot *plot, double index)
{
    double span = plot->value_count > 1 ? (double)(plot->value_count - 1) : 1.0;
    return MARGIN_LEFT + index / span * (PLOT_WIDTH - MARGIN_LEFT - MARGIN_RIGHT);
}

static double plot_y(double value, double maximum)
{
    double share = fmin(fmax(value / maximum, 0.0), 1.0);
    return MARGIN_TOP + (1.0 - share) * (PLOT_HEIGHT - MARGIN_TOP - MARGIN_BOTTOM);
}

static void put_axes(FILE *file, const struct report_plot *plot, double maximum)
{
    double step = axis_step(maximum);
    for (double tick = 0.0; tick <= maximum * 1.0001; tick += step) {
        double y = plot_y(tick, maximum);
        fprintf(file,
                "<line x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#e6e3dd\"/>"
                "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.6g</text>",
                MARGIN_LEFT, PLOT_WIDTH - MARGIN_RIGHT, y, y, MARGIN_LEFT - 6, y + 4.0, tick);
    }
    double frame_step = fmax(1.0, axis_step((double)plot->value_count));
    for (double frame = 0.0; frame < (double)plot->value_count; frame += frame_step)
        fprintf(file, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.0f</text>",
                plot_x(plot, frame), PLOT_HEIGHT - 7, frame);
}

/** Draws the mark over the lines, with a rim that keeps its name readable. */
static void put_mark(FILE *file, const struct report_plot *plot)
{
    if (plot->mark >= 0.0)
        fprintf(file,
                "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\" stroke=\"#999\" "
                "stroke-dasharray=\"4 3\"/><text x=\"%.1f\" y=\"%d\" stroke=\"#fff\" "
                "stroke-width=\"4\" paint-order=\"stroke\">%s</text>",
                plot_x(plot, plot->mark), plot_x(plot, plot->mark), MARGIN_TOP,
                PLOT_HEIGHT - MARGIN_BOTTOM, plot_x(plot, plot->mark) + 4.0, MARGIN_TOP + 12,
                plot->mark_name);
}

static void put_series(FILE *file, const struct report_plot *plot,
                       const struct report_series *series, const char *color, double maximum)
{
    bool drawing = false;
    fprintf(file, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" d=\"", color);
    for (size_t i = 0; i < plot->value_count; i++) {
        double value = series->values[i];
        if (isnan(value) || value == -INFINITY) {
            drawing = false;
            continue;
        }
        fprintf(file, "%c%.1f %.1f", drawing ? 'L' : 'M', plot_x(plot, (double)i),
                plot_y(value, maximum));
        drawing = true;
    }
    fputs("\"/>", file);
}

void report_plot(struct report *report, const struct report_plot *plot)
{
    FILE *file = report->file;
    double maximum = largest_value(plot);
    put_element(file, "h2", plot->title);
    fprintf(file,
            "<svg viewBox=\"0 0 %d %d\" width=\"100%%\" font-size=\"11\" fill=\"#666\" "
            "font-family=\"system-ui,sans-serif\">",
            PLOT_WIDTH, PLOT_HEIGHT);
    put_axes(file, plot, maximum);
    for (size_t s = 0; s < plot->series_count; s++)
        put_series(file, plot, &plot->series[s], colors[s % COLOR_COUNT], maximum);
    put_mark(file, plot);
    fputs("</svg><div>", file);
    for (size_t s = 0; s < plot->series_count; s++) {
        fprintf(file, "<span class=\"k\" style=\"color:%s\">&#9632; ", colors[s % COLOR_COUNT]);
        put_escaped(file, plot->series[s].name);
        fputs("</span>", file);
    }
    fputs("<span class=\"k\">", file);
    put_escaped(file, plot->unit);
    fputs(" over frames</span></div>\n", file);
}

void report_bars(struct report *report, const struct report_bar *bars, size_t count)
{
    FILE *file = report->file;
    double largest = 0.0;
    int y = 0;
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, bars[i].value);
    fprintf(file,
            "<svg viewBox=\"0 0 %d %d\" width=\"100%%\" font-size=\"12\" fill=\"#444\" "
            "font-family=\"system-ui,sans-serif\">",
            PLOT_WIDTH, (int)count * BAR_HEIGHT);
    for (size_t i = 0; i < count; i++) {
        if (!(bars[i].value >= 0.0) || largest == 0.0)
            continue;
        double width = BAR_ROOM * bars[i].value / largest,
               first = BAR_ROOM * bars[i].first / largest;
        fprintf(file, "<text x=\"6\" y=\"%d\">", y + 17);
        put_escaped(file, bars[i].name);
        fprintf(file,
                "</text><rect x=\"%d\" y=\"%d\" width=\"%.1f\" height=\"14\" fill=\"%s\"/>"
                "<rect x=\"%.1f\" y=\"%d\" width=\"%.1f\" height=\"14\" fill=\"%s\"/>"
                "<text x=\"%.1f\" y=\"%d\">",
                BAR_LEFT, y + 5, first, colors[0], BAR_LEFT + first, y + 5, width - first,
                colors[1], BAR_LEFT + width + 6, y + 17);
        put_escaped(file, bars[i].text);
        fputs("</text>", file);
        y += BAR_HEIGHT;
    }
    fputs("</svg>\n", file);
}

void report_begin_pictures(struct report *report)
{
    fputs("<div>\n", report->file);
}

void report_begin_row(struct report *report)
{
    fputs("<div class=\"row\">\n", report->file);
}

static void put_base64(FILE *out, FILE *in)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    unsigned char bytes[3];
    for (size_t count; (count = fread(bytes, 1, 3, in)) > 0;) {
        unsigned word = (unsigned)bytes[0] << 16;
        word |= count > 1 ? (unsigned)bytes[1] << 8 : 0;
        word |= count > 2 ? (unsigned)bytes[2] : 0;
        fputc(digits[word >> 18], out);
        fputc(digits[word >> 12 & 63], out);
        fputc(count > 1 ? digits[word >> 6 & 63] : '=', out);
        fputc(count > 2 ? digits[word & 63] : '=', out);
    }
}

void report_picture(struct report *report, const char *png_path, const char *caption)
{
    FILE *png = input_open(png_path);
    if (!png)
        return;
    fputs("<figure><img alt=\"", report->file);
    put_escaped(report->file, caption);
    fputs("\" src=\"data:image/png;base64,", report->file);
    put_base64(report->file, png);
    fputs("\">", report->file);
    put_element(report->file, "figcaption", caption);
    fputs("</figure>\n", report->file);
    fclose(png);
}

void report_end_pictures(struct report *report)
{
    fputs("</div>\n", report->file);
}

bool report_end(struct report *report)
{
    return output_file_end(report->output, true);
}
