#include "sets.h"

#include "controls.h"

#include "../common/option_value.h"
#include "../common/text.h"

#include <stdio.h>
#include <string.h>

#define NAMED_MOST 2 /* settings that a label lists */

static void copy(const struct control *control, const struct view_settings *from,
                 struct view_settings *to)
{
    static const size_t sizes[] = {
        [OPTION_UINT] = sizeof(uint32_t),  [OPTION_REAL] = sizeof(double),
        [OPTION_SECONDS] = sizeof(double), [OPTION_MILLISECONDS] = sizeof(double),
        [OPTION_BYTES] = sizeof(uint64_t), [OPTION_CHOICE] = sizeof(int)};
    const enum option_kind kind = control->option.kind;
    if (kind < sizeof sizes / sizeof *sizes)
        memcpy((char *)to + control->offset, (const char *)from + control->offset, sizes[kind]);
}

static bool equal(const struct control *control, const struct view_settings *a,
                  const struct view_settings *b)
{
    char left[64], right[64];
    return strcmp(control_write(control, a, left, sizeof left),
                  control_write(control, b, right, sizeof right)) == 0;
}

static void copy_those(unsigned flags, const struct view_settings *from, struct view_settings *to)
{
    uint32_t count;
    const struct control *controls = controls_get(&count);
    for (uint32_t i = 0; i < count; i++)
        if (control_is_of_sets(&controls[i]) && (controls[i].flags & flags) == flags)
            copy(&controls[i], from, to);
}

void sets_copy(const struct view_settings *from, struct view_settings *to)
{
    copy_those(0, from, to);
}

void sets_copy_opened(const struct view_settings *from, struct view_settings *to)
{
    copy_those(CONTROL_REOPENS, from, to);
}

bool sets_must_reopen(const struct view_settings *opened, const struct view_settings *now)
{
    uint32_t count;
    const struct control *controls = controls_get(&count);
    for (uint32_t i = 0; i < count; i++)
        if (control_is_of_sets(&controls[i]) && controls[i].flags & CONTROL_REOPENS &&
            !equal(&controls[i], opened, now))
            return true;
    return false;
}

bool sets_set(struct view_settings *set, const char *name, const char *value, const char *speaker)
{
    const struct control *control = controls_find(name);
    if (control && !control_is_of_sets(control)) {
        text_say("%s: %s is shared by A and B", speaker, name);
        return false;
    }
    return controls_set(set, name, value, speaker);
}

bool sets_read(struct view_settings *set, const char *text, const char *speaker)
{
    char item[128];
    while (*text) {
        const size_t length = strcspn(text, ",");
        snprintf(item, sizeof item, "%.*s", (int)(length < sizeof item ? length : sizeof item - 1),
                 text);
        char *value = strchr(item, '=');
        if (length >= sizeof item || !value || value == item) {
            text_say("%s %s: wants NAME=VALUE, like budget=16", speaker, item);
            return false;
        }
        *value++ = '\0';
        if (!sets_set(set, item, value, speaker))
            return false;
        text += length + (text[length] == ',');
    }
    return true;
}

void sets_write(const struct view_settings *a, const struct view_settings *b, char *text,
                size_t size)
{
    char value[64];
    uint32_t count;
    size_t length = 0;
    const struct control *controls = controls_get(&count);
    text[0] = '\0';
    for (uint32_t i = 0; i < count && length < size; i++)
        if (control_is_of_sets(&controls[i]) && !equal(&controls[i], a, b))
            length += (size_t)snprintf(text + length, size - length, "%s%s=%s", length ? "," : "",
                                       controls[i].option.name,
                                       control_write(&controls[i], b, value, sizeof value));
}

struct view_settings sets_of_second(const struct view_settings *a, const struct view_settings *b)
{
    struct view_settings second = *a;
    const int compared = a->view == VIEW_TRUTH ? VIEW_WITH_EVERYTHING : a->compared;
    if (compared == VIEW_WITH_B)
        sets_copy(b, &second);
    else
        second.load = compared == VIEW_WITH_BUDGET ? VIEW_LOAD_WANTED : VIEW_LOAD_EVERYTHING;
    if (compared != VIEW_WITH_B)
        second.budget = compared == VIEW_WITH_BUDGET ? SETS_SMALL_BUDGET : 0;
    return second;
}

void sets_swap(struct view_settings *a, struct view_settings *b)
{
    const struct view_settings second = sets_of_second(a, b);
    sets_copy(a, b);
    sets_copy(&second, a);
    a->compared = VIEW_WITH_B;
}

const char *sets_name_second(const struct view_settings *a, const struct view_settings *b,
                             char *text, size_t size)
{
    char value[64];
    uint32_t count, named = 0, left = 0;
    size_t length = 0;
    const struct control *controls = controls_get(&count);
    snprintf(text, size, "%s",
             a->compared == VIEW_WITH_EVERYTHING ? "everything"
             : a->compared == VIEW_WITH_BUDGET   ? "16 MB"
                                                 : "as A");
    for (uint32_t i = 0; a->compared == VIEW_WITH_B && i < count && length < size; i++) {
        if (!control_is_of_sets(&controls[i]) || equal(&controls[i], a, b))
            continue;
        if (named++ < NAMED_MOST)
            length += (size_t)snprintf(text + length, size - length, "%s%s %s", length ? ", " : "",
                                       controls[i].option.name,
                                       control_write(&controls[i], b, value, sizeof value));
        else
            left++;
    }
    if (left > 0 && length < size)
        snprintf(text + length, size - length, ", and %u more", left);
    return text;
}
