#include "plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/text.h"
#include "help_text.h"

#define MOST_POINTS 1000u
#define MOST_GRID_SETTINGS 16u

/** Values of one setting. */
struct axis {
    uint32_t setting;
    struct text_list values;
};

struct planner {
    const struct scene *scene;
    const struct program *program;
    struct sweep *sweep;
    struct sweep_setting *settings;
    bool failed;
};

static bool parse_number(const char *text, double *number)
{
    char *end;
    *number = strtod(text, &end);
    if (end != text && *end == '/') {
        const char *divisor = end + 1;
        *number /= strtod(divisor, &end);
        return end != divisor && *end == '\0' && isfinite(*number);
    }
    return end != text && *end == '\0' && isfinite(*number);
}

bool plan_same_value(const char *a, const char *b)
{
    double x, y;
    return strcmp(a, b) == 0 || (parse_number(a, &x) && parse_number(b, &y) && x == y);
}

static int find_setting(const struct sweep *sweep, const char *name, size_t length)
{
    for (uint32_t i = 0; i < sweep->setting_count; i++)
        if (strlen(sweep->settings[i].name) == length &&
            strncmp(sweep->settings[i].name, name, length) == 0)
            return (int)i;
    return -1;
}

static bool is_flag(const struct program *program, const char *name)
{
    struct help_entry entry;
    bool flag = help_text_find(program->help, name, &entry) && entry.operand[0] == '\0';
    help_entry_finish(&entry);
    return flag;
}

/* Takes name, meaning and unit. The point that holds the base value frees it. */
static void add_setting(struct planner *planner, const struct sweep_setting *setting,
                        const char *base)
{
    struct sweep *sweep = planner->sweep;
    struct sweep_point *point = &sweep->points[0];
    uint32_t count = sweep->setting_count + 1;
    struct help_entry entry;
    help_text_find(planner->program->help, setting->name, &entry);
    planner->settings = memory_grow(planner->settings, count, sizeof *planner->settings);
    planner->settings[count - 1] = (struct sweep_setting){
        memory_copy_text(setting->name),
        memory_copy_text(setting->meaning ? setting->meaning : entry.meaning),
        memory_copy_text(setting->unit),
    };
    point->values = memory_grow(point->values, count, sizeof *point->values);
    point->values[count - 1] = memory_copy_text(base                       ? base
                                                : entry.operand[0] == '\0' ? "off"
                                                                           : entry.default_value);
    sweep->settings = planner->settings;
    sweep->setting_count = count;
    help_entry_finish(&entry);
}

/* Returns the setting that "name=values" names. Adds it if the program has the option but the scene
 * does not list it. */
static int need_setting(struct planner *planner, const char *text)
{
    size_t length = strcspn(text, "=");
    int found = find_setting(planner->sweep, text, length);
    char *name = memory_text("%.*s", (int)length, text);
    if (text[length] == '\0' || text[length + 1] == '\0') {
        text_say("sluice-tradeoff: '%s': wants NAME=VALUE", text);
        planner->failed = true;
    } else if (found < 0 && program_has_option(planner->program, name)) {
        const struct sweep_setting setting = {name, NULL, ""};
        add_setting(planner, &setting, NULL);
        found = (int)planner->sweep->setting_count - 1;
    } else if (found < 0) {
        text_say("sluice-tradeoff: %s has no option --%s", planner->program->arguments.items[0],
                 name);
        planner->failed = true;
    }
    free(name);
    return planner->failed ? -1 : found;
}

static bool is_allowed(struct planner *planner, uint32_t setting, const char *value)
{
    const char *name = planner->sweep->settings[setting].name;
    bool flag = is_flag(planner->program, name);
    bool allowed = *value && (!flag || strcmp(value, "on") == 0 || strcmp(value, "off") == 0);
    if (!allowed)
        text_say("sluice-tradeoff: %s=%s: wants %s", name, value, flag ? "on or off" : "a value");
    planner->failed = planner->failed || !allowed;
    return allowed;
}

static bool same_point(const struct sweep *sweep, char *const *a, char *const *b)
{
    for (uint32_t i = 0; i < sweep->setting_count; i++)
        if (!plan_same_value(a[i], b[i]))
            return false;
    return true;
}

static char *make_label(const struct sweep *sweep, char *const *values)
{
    char *label = memory_copy_text("");
    for (uint32_t i = 0; i < sweep->setting_count; i++) {
        if (plan_same_value(values[i], sweep->points[0].values[i]))
            continue;
        char *longer =
            memory_text("%s%s%s %s", label, *label ? ", " : "", sweep->settings[i].name, values[i]);
        free(label);
        label = longer;
    }
    return label;
}

/* Copies `values`. */
static void add_point(struct planner *planner, char *const *values)
{
    struct sweep *sweep = planner->sweep;
    for (uint32_t i = 0; i < sweep->point_count; i++)
        if (same_point(sweep, sweep->points[i].values, values))
            return;
    if (sweep->point_count == MOST_POINTS) {
        if (!planner->failed)
            text_say("sluice-tradeoff: more than %u points", MOST_POINTS);
        planner->failed = true;
        return;
    }
    sweep->points = memory_grow(sweep->points, sweep->point_count + 1, sizeof *sweep->points);
    struct sweep_point *point = &sweep->points[sweep->point_count++];
    *point = (struct sweep_point){0};
    point->values = memory_take(sweep->setting_count, sizeof *point->values);
    for (uint32_t i = 0; i < sweep->setting_count; i++)
        point->values[i] = memory_copy_text(values[i]);
    point->label = make_label(sweep, values);
}

/* Adds all combinations of the axes. `values` holds the choices for the other axes. */
static void add_grid(struct planner *planner, const struct axis *axes, size_t count, char **values)
{
    if (count == 0) {
        add_point(planner, values);
        return;
    }
    char *before = values[axes->setting];
    for (size_t i = 0; i < axes->values.count && !planner->failed; i++) {
        values[axes->setting] = axes->values.items[i];
        add_grid(planner, axes + 1, count - 1, values);
    }
    values[axes->setting] = before;
}

/* Reads "name=a,b". A grid includes the base's value, first. */
static bool read_axis(struct planner *planner, const char *text, bool with_base, struct axis *axis)
{
    int setting = need_setting(planner, text);
    *axis = (struct axis){0};
    if (setting < 0)
        return false;
    axis->setting = (uint32_t)setting;
    if (with_base)
        text_list_add(&axis->values, planner->sweep->points[0].values[setting]);
    size_t first = axis->values.count;
    text_list_add_parts(&axis->values, strchr(text, '=') + 1, ',');
    for (size_t i = first; i < axis->values.count; i++)
        is_allowed(planner, axis->setting, axis->values.items[i]);
    return !planner->failed;
}

static void add_product(struct planner *planner, const struct axis *axes, size_t count)
{
    const struct sweep *sweep = planner->sweep;
    char **values = memory_take(sweep->setting_count, sizeof *values);
    memcpy(values, sweep->points[0].values, sweep->setting_count * sizeof *values);
    add_grid(planner, axes, count, values);
    free(values);
}

/* Adds the product of all axes, or each axis by itself. */
static void add_axes(struct planner *planner, const struct text_list *texts, bool grid)
{
    struct axis axes[MOST_GRID_SETTINGS];
    size_t count = 0;
    if (texts->count > MOST_GRID_SETTINGS && grid) {
        text_say("sluice-tradeoff: a grid of more than %u settings", MOST_GRID_SETTINGS);
        planner->failed = true;
    }
    for (size_t i = 0; i < texts->count && !planner->failed; i++) {
        struct axis *axis = &axes[grid ? count++ : 0];
        if (read_axis(planner, texts->items[i], grid, axis) && !grid)
            add_product(planner, axis, 1);
        if (!grid)
            text_list_finish(&axis->values);
    }
    if (grid && count > 0 && !planner->failed)
        add_product(planner, axes, count);
    for (size_t i = 0; i < count; i++)
        text_list_finish(&axes[i].values);
}

/* Adds all settings before any point, so that all points have equal settings. */
static void add_settings(struct planner *planner, const struct options *options)
{
    const struct scene *scene = planner->scene;
    for (uint32_t i = 0; i < scene->setting_count; i++)
        if (program_has_option(planner->program, scene->settings[i].setting.name))
            add_setting(planner, &scene->settings[i].setting, scene->settings[i].base);
    for (size_t i = 0; i < options->sweeps.count && !planner->failed; i++)
        need_setting(planner, options->sweeps.items[i]);
    for (size_t i = 0; i < options->bases.count && !planner->failed; i++) {
        int setting = need_setting(planner, options->bases.items[i]);
        const char *value = strchr(options->bases.items[i], '=') + 1;
        if (setting < 0 || !is_allowed(planner, (uint32_t)setting, value))
            return;
        free(planner->sweep->points[0].values[setting]);
        planner->sweep->points[0].values[setting] = memory_copy_text(value);
    }
}

/* Refuses settings among the program's arguments: each point sets all settings, so they would have
 * no effect. */
static void refuse_settings(struct planner *planner, const struct text_list *arguments)
{
    for (size_t i = 0; i < arguments->count; i++) {
        const char *word = arguments->items[i];
        if (strncmp(word, "--", 2) != 0 ||
            find_setting(planner->sweep, word + 2, strcspn(word + 2, "=")) < 0)
            continue;
        text_say("sluice-tradeoff: %s is a setting: --base %.*s=VALUE instead", word,
                 (int)strcspn(word + 2, "="), word + 2);
        planner->failed = true;
    }
}

/* Adds the scene's axes and grid, as far as the program has the options. */
static void add_built_in(struct planner *planner, bool full)
{
    const struct scene *scene = planner->scene;
    struct text_list texts = {0}, grid = {0};
    for (uint32_t i = 0; i < scene->setting_count; i++) {
        const struct scene_setting *setting = &scene->settings[i];
        const char *values = full ? setting->full : setting->quick;
        if (!values || !program_has_option(planner->program, setting->setting.name))
            continue;
        char *text = memory_text("%s=%s", setting->setting.name, values);
        text_list_add(&texts, text);
        free(text);
    }
    add_axes(planner, &texts, false);
    if (full && scene->full_grid) {
        text_list_add_parts(&grid, scene->full_grid, ' ');
        bool known = true;
        for (size_t i = 0; i < grid.count; i++)
            known = known &&
                    find_setting(planner->sweep, grid.items[i], strcspn(grid.items[i], "=")) >= 0;
        if (known)
            add_axes(planner, &grid, true);
    }
    text_list_finish(&texts);
    text_list_finish(&grid);
}

bool plan_build(const struct options *options, const struct scene *scene,
                const struct program *program, struct sweep *sweep)
{
    struct planner planner = {.scene = scene, .program = program, .sweep = sweep};
    sweep->points = memory_take(1, sizeof *sweep->points);
    sweep->point_count = 1;
    sweep->points[0].label = memory_copy_text("base");
    add_settings(&planner, options);
    refuse_settings(&planner, &options->scene_arguments);
    if (!planner.failed && options->sweeps.count > 0)
        add_axes(&planner, &options->sweeps, options->grid);
    else if (!planner.failed)
        add_built_in(&planner, options->full);
    return !planner.failed;
}

void plan_add_arguments(const struct sweep *sweep, const struct sweep_point *point,
                        const struct program *program, struct text_list *arguments)
{
    for (uint32_t i = 0; i < sweep->setting_count; i++) {
        const char *value = point->values[i];
        bool flag = is_flag(program, sweep->settings[i].name);
        if (*value == '\0' || (flag && strcmp(value, "off") == 0))
            continue;
        char *option = memory_text("--%s", sweep->settings[i].name);
        text_list_add(arguments, option);
        if (!flag)
            text_list_add(arguments, value);
        free(option);
    }
}
