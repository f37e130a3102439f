/* strdup, realpath, strtok_r, strcasecmp */
#define _XOPEN_SOURCE 700

#include "script.h"

#include "keys.h"

#include "../common/input.h"
#include "../common/text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define MAX_WORDS 8
#define MAX_FRAME 10000000u
#define MAX_SCRIPT_SIZE (16u << 20)

struct line {
    struct script *script;
    uint32_t frame;
    char *words[MAX_WORDS]; ///< behind the name of the event
    int count;
    char *rest; ///< all behind the name
};

static bool add(struct line *line, struct script_step step)
{
    struct script *script = line->script;
    if (script->count == script->capacity) {
        size_t capacity = 2 * script->capacity + 64;
        struct script_step *steps = realloc(script->steps, capacity * sizeof *steps);
        if (!steps)
            return false;
        script->steps = steps;
        script->capacity = capacity;
    }
    step.frame += line->frame;
    step.order = (uint32_t)script->count;
    script->steps[script->count++] = step;
    return true;
}

static bool read_number(const char *word, float *number)
{
    char *end;
    *number = strtof(word, &end);
    return end != word && *end == '\0' && isfinite(*number) && fabsf(*number) < 1e6f;
}

static bool read_numbers(const struct line *line, int count, float *numbers)
{
    if (line->count < count)
        return false;
    for (int i = 0; i < count; i++)
        if (!read_number(line->words[i], &numbers[i]))
            return false;
    return true;
}

static bool add_move(struct line *line, uint32_t after, float x, float y)
{
    return add(line, (struct script_step){.frame = after, .kind = SCRIPT_MOVE, .x = x, .y = y});
}

/* Adds a press of a button. It lasts at least one frame, since ImGui 1.86 loses shorter clicks. */
static bool add_press(struct line *line, uint32_t after, uint32_t frames, int button)
{
    return add(line,
               (struct script_step){
                   .frame = after, .kind = SCRIPT_BUTTON, .number = button, .down = true}) &&
           add(line, (struct script_step){
                         .frame = after + frames, .kind = SCRIPT_BUTTON, .number = button});
}

static bool add_keys(struct line *line, const struct view_chord *chord, uint32_t frames)
{
    static const int held[] = {VIEW_KEY_SHIFT, VIEW_KEY_CONTROL, VIEW_KEY_ALT};
    for (int down = 1; down >= 0; down--) {
        const uint32_t after = down ? 0 : frames;
        for (int i = 0; i < 3; i++)
            if (chord->modifiers >> i & 1 &&
                !add(line, (struct script_step){after, 0, SCRIPT_KEY, held[i], down != 0}))
                return false;
        if (!add(line, (struct script_step){after, 0, SCRIPT_KEY, chord->key, down != 0}))
            return false;
    }
    return true;
}

static bool add_text(struct line *line, enum script_kind kind, const char *text, const char *value)
{
    struct script_step step = {.kind = kind, .text = strdup(text)};
    step.value = value ? strdup(value) : NULL;
    return add(line, step);
}

static bool take_key(struct line *line)
{
    struct view_chord chord;
    return line->count == 1 && view_chord_read(line->words[0], &chord) && add_keys(line, &chord, 1);
}

static bool take_hold(struct line *line)
{
    struct view_chord chord;
    float frames;
    return line->count == 2 && view_chord_read(line->words[0], &chord) &&
           read_number(line->words[1], &frames) && frames >= 1 &&
           add_keys(line, &chord, (uint32_t)frames);
}

static bool take_type(struct line *line)
{
    return line->count > 0 && strlen(line->rest) < 60 &&
           add_text(line, SCRIPT_TYPE, line->rest, NULL);
}

static bool take_hover(struct line *line)
{
    float at[2];
    return line->count == 2 && read_numbers(line, 2, at) && add_move(line, 0, at[0], at[1]);
}

static bool take_click(struct line *line)
{
    static const char *const buttons[] = {"left", "right", "middle"};
    float at[2];
    int button = 0;
    if (line->count == 3)
        while (button < 3 && strcmp(line->words[2], buttons[button]) != 0)
            button++;
    return (line->count == 2 || line->count == 3) && button < 3 && read_numbers(line, 2, at) &&
           add_move(line, 0, at[0], at[1]) && add_press(line, 1, 1, button);
}

static bool take_double_click(struct line *line)
{
    float at[2];
    return line->count == 2 && read_numbers(line, 2, at) && add_move(line, 0, at[0], at[1]) &&
           add_press(line, 1, 1, 0) && add_press(line, 3, 1, 0);
}

static bool take_drag(struct line *line)
{
    float at[4], frames = 10;
    if ((line->count != 4 && line->count != 5) || !read_numbers(line, 4, at) ||
        (line->count == 5 && !read_number(line->words[4], &frames)) || frames < 1)
        return false;
    if (!add_move(line, 0, at[0], at[1]) || !add_press(line, 1, (uint32_t)frames + 2, 0))
        return false;
    for (uint32_t i = 1; i <= (uint32_t)frames; i++) {
        const float part = (float)i / frames;
        if (!add_move(line, i + 1, at[0] + (at[2] - at[0]) * part, at[1] + (at[3] - at[1]) * part))
            return false;
    }
    return true;
}

static bool take_wheel(struct line *line)
{
    float turns;
    return line->count == 1 && read_numbers(line, 1, &turns) &&
           add(line, (struct script_step){.kind = SCRIPT_WHEEL, .x = turns});
}

static bool take_drop(struct line *line)
{
    return line->count > 0 && add_text(line, SCRIPT_DROP, line->rest, NULL);
}

static bool take_set(struct line *line)
{
    if (line->count == 3 && strcmp(line->words[0], "b") == 0)
        return add_text(line, SCRIPT_SET_B, line->words[1], line->words[2]);
    return line->count == 2 && add_text(line, SCRIPT_SET, line->words[0], line->words[1]);
}

static bool take_do(struct line *line)
{
    return line->count == 1 && add_text(line, SCRIPT_DO, line->words[0], NULL);
}

static bool take_screenshot(struct line *line)
{
    return line->count > 0 && add_text(line, SCRIPT_SCREENSHOT, line->rest, NULL);
}

static bool take_record(struct line *line)
{
    return line->count > 0 && add_text(line, SCRIPT_RECORD, line->rest, NULL);
}

static bool take_frame(struct line *line)
{
    float number;
    return line->count == 1 && read_numbers(line, 1, &number) && number >= 0 &&
           add(line, (struct script_step){.kind = SCRIPT_FRAME,
                                          .number = (int)strtol(line->words[0], NULL, 10)});
}

static bool take_reset(struct line *line)
{
    return line->count == 0 && add(line, (struct script_step){.kind = SCRIPT_RESET});
}

static bool take_quit(struct line *line)
{
    return line->count == 0 && add(line, (struct script_step){.kind = SCRIPT_QUIT});
}

static const struct {
    const char *name, *wants;
    bool (*take)(struct line *line);
} events[] = {
    {"key", "a key, as 3, F1, Shift+R or space", take_key},
    {"hold", "a key and a number of frames", take_hold},
    {"type", "a text of less than 60 bytes", take_type},
    {"hover", "X Y", take_hover},
    {"click", "X Y, and maybe left, right or middle", take_click},
    {"double-click", "X Y", take_double_click},
    {"drag", "X Y X Y, and maybe a number of frames", take_drag},
    {"wheel", "a number of turns", take_wheel},
    {"drop", "a path", take_drop},
    {"set", "the name of an option and a value, and maybe b before them", take_set},
    {"do", "evict, pin, hide, retry or file", take_do},
    {"record", "a file", take_record},
    {"frame", "the number of a frame of the recording", take_frame},
    {"screenshot", "a file", take_screenshot},
    {"reset", "nothing else", take_reset},
    {"quit", "nothing else", take_quit},
};

static char *next_word(char **text)
{
    char *word = *text + strspn(*text, " \t");
    size_t length = strcspn(word, " \t");
    *text = word + length;
    if (**text)
        *(*text)++ = '\0';
    return word;
}

static const char *take_line(struct script *script, char *text, char *message, size_t size)
{
    char *end;
    char rest[1024];
    char *number = next_word(&text), *name = next_word(&text);
    unsigned long frame = strtoul(number, &end, 10);
    if (*end || end == number || number[0] == '-' || frame > MAX_FRAME) {
        snprintf(message, size, "%s is no number of a frame", number);
        return message;
    }
    text += strspn(text, " \t");
    snprintf(rest, sizeof rest, "%s", text);
    struct line line = {.script = script, .frame = (uint32_t)frame, .rest = rest};
    for (char *word; line.count < MAX_WORDS && *(word = next_word(&text));)
        line.words[line.count++] = word;
    for (size_t i = 0; i < sizeof events / sizeof *events; i++)
        if (strcmp(events[i].name, name) == 0) {
            if (events[i].take(&line))
                return NULL;
            snprintf(message, size, "%s: wants %s", name, events[i].wants);
            return message;
        }
    snprintf(message, size, "there is no event %s", name);
    return message;
}

static int compare(const void *left, const void *right)
{
    const struct script_step *a = left, *b = right;
    if (a->frame != b->frame)
        return a->frame < b->frame ? -1 : 1;
    return a->order < b->order ? -1 : a->order > b->order;
}

bool script_parse(const char *name, const char *text, struct script *script)
{
    char line[1024], message[256];
    *script = (struct script){0};
    for (unsigned number = 1; *text; number++) {
        size_t length = strcspn(text, "\n");
        snprintf(line, sizeof line, "%.*s", (int)(length < sizeof line ? length : 0), text);
        line[strcspn(line, "#\r")] = '\0';
        text += length + (text[length] == '\n');
        const char *wrong = length >= sizeof line ? "the line is too long" : NULL;
        if (line[strspn(line, " \t")])
            wrong = take_line(script, line, message, sizeof message);
        if (wrong) {
            text_say("sluice-view: %s:%u: %s", name, number, wrong);
            script_finish(script);
            return false;
        }
    }
    if (script->count > 0)
        qsort(script->steps, script->count, sizeof *script->steps, compare);
    return true;
}

bool script_read(const char *path, struct script *script)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = input_open_stream(path);
    bool read = file && input_read_rest(file, MAX_SCRIPT_SIZE, &text, &size);
    if (!read)
        text_say("sluice-view: %s: %s", path, input_reason(errno));
    if (file)
        fclose(file);
    bool parsed = read && script_parse(path, text, script);
    free(text);
    return parsed;
}

void script_finish(struct script *script)
{
    for (size_t i = 0; i < script->count; i++) {
        free(script->steps[i].text);
        free(script->steps[i].value);
    }
    free(script->steps);
    *script = (struct script){0};
}

const struct script_step *script_next(struct script *script, uint32_t frame)
{
    if (script->next == script->count || script->steps[script->next].frame > frame)
        return NULL;
    return &script->steps[script->next++];
}

uint32_t script_last_frame(const struct script *script)
{
    return script->count > 0 ? script->steps[script->count - 1].frame : 0;
}
