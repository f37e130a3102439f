/* strdup, realpath, strtok_r, strcasecmp */
#define _XOPEN_SOURCE 700

#include "keys.h"

#include <string.h>
#include <strings.h>

static const struct {
    const char *name;
    int key;
} names[] = {{"space", VIEW_KEY_SPACE},
             {"escape", VIEW_KEY_ESCAPE},
             {"esc", VIEW_KEY_ESCAPE},
             {"enter", VIEW_KEY_ENTER},
             {"tab", VIEW_KEY_TAB},
             {"backspace", VIEW_KEY_BACKSPACE},
             {"insert", VIEW_KEY_INSERT},
             {"delete", VIEW_KEY_DELETE},
             {"right", VIEW_KEY_RIGHT},
             {"left", VIEW_KEY_LEFT},
             {"down", VIEW_KEY_DOWN},
             {"up", VIEW_KEY_UP},
             {"pageup", VIEW_KEY_PAGE_UP},
             {"pagedown", VIEW_KEY_PAGE_DOWN},
             {"home", VIEW_KEY_HOME},
             {"end", VIEW_KEY_END},
             {"backquote", VIEW_KEY_BACKQUOTE}};

static const struct {
    const char *name;
    unsigned modifier;
} modifiers[] = {{"shift", VIEW_SHIFT}, {"ctrl", VIEW_CONTROL}, {"alt", VIEW_ALT}};

/* Returns the length of "Shift+", or 0. */
static size_t read_modifier(const char *text, unsigned *modifier)
{
    for (size_t i = 0; i < sizeof modifiers / sizeof *modifiers; i++) {
        size_t length = strlen(modifiers[i].name);
        if (strncasecmp(text, modifiers[i].name, length) == 0 &&
            (text[length] == '+' || text[length] == '-') && text[length + 1]) {
            *modifier = modifiers[i].modifier;
            return length + 1;
        }
    }
    return 0;
}

static int read_function_key(const char *text)
{
    int number = 0;
    if ((text[0] != 'F' && text[0] != 'f') || text[1] < '1' || text[1] > '9')
        return VIEW_KEY_NONE;
    for (const char *c = text + 1; *c; c++) {
        if (*c < '0' || *c > '9' || number > 2)
            return VIEW_KEY_NONE;
        number = number * 10 + (*c - '0');
    }
    return number <= 12 ? VIEW_KEY_F1 + number - 1 : VIEW_KEY_NONE;
}

int view_chord_read(const char *text, struct view_chord *chord)
{
    unsigned modifier = 0;
    *chord = (struct view_chord){0};
    for (size_t length; (length = read_modifier(text, &modifier)) > 0; text += length)
        chord->modifiers |= modifier;
    if (text[0] > ' ' && text[0] <= '~' && text[1] == '\0') {
        chord->key = text[0] >= 'a' && text[0] <= 'z' ? text[0] - 'a' + 'A' : text[0];
        return 1;
    }
    chord->key = read_function_key(text);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(text, names[i].name) == 0)
            chord->key = names[i].key;
    return chord->key != VIEW_KEY_NONE;
}
