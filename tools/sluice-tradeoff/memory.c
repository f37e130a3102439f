#define _POSIX_C_SOURCE 200809L
#include "memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *checked(void *block)
{
    if (!block) {
        fputs("sluice-tradeoff: out of memory\n", stderr);
        exit(EXIT_FAILURE);
    }
    return block;
}

void *memory_take(size_t count, size_t size)
{
    return checked(calloc(count ? count : 1, size));
}

void *memory_grow(void *block, size_t count, size_t size)
{
    return checked(count > SIZE_MAX / size ? NULL : realloc(block, count * size));
}

char *memory_copy_text(const char *text)
{
    return checked(strdup(text));
}

char *memory_text(const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    char *text = checked(length < 0 ? NULL : malloc((size_t)length + 1));
    vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    va_end(arguments);
    return text;
}

static void add_owned(struct text_list *list, char *text)
{
    if (list->count + 1 >= list->capacity) {
        list->capacity = list->capacity ? 2 * list->capacity : 16;
        list->items = memory_grow(list->items, list->capacity, sizeof *list->items);
    }
    list->items[list->count++] = text;
    list->items[list->count] = NULL;
}

void text_list_add(struct text_list *list, const char *text)
{
    add_owned(list, memory_copy_text(text));
}

void text_list_add_all(struct text_list *list, const struct text_list *more)
{
    for (size_t i = 0; i < more->count; i++)
        text_list_add(list, more->items[i]);
}

void text_list_add_parts(struct text_list *list, const char *text, char separator)
{
    for (;;) {
        const char *end = strchr(text, separator);
        size_t length = end ? (size_t)(end - text) : strlen(text);
        add_owned(list, checked(strndup(text, length)));
        if (!end)
            return;
        text = end + 1;
    }
}

static bool is_plain(const char *text)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"
                                "_./=:,+@%-";
    return *text && text[strspn(text, plain)] == '\0';
}

/* Quotes a word for the shell: 'it'\''s'. */
static size_t quote(const char *text, char *out)
{
    char *at = out;
    *at++ = '\'';
    for (; *text; text++) {
        if (*text == '\'') {
            memcpy(at, "'\\''", 4);
            at += 4;
        } else {
            *at++ = *text;
        }
    }
    *at++ = '\'';
    return (size_t)(at - out);
}

char *text_list_join(const struct text_list *list)
{
    size_t size = 1;
    for (size_t i = 0; i < list->count; i++)
        size += 4 * strlen(list->items[i]) + 3;
    char *line = memory_take(size, 1), *at = line;
    for (size_t i = 0; i < list->count; i++) {
        const char *text = list->items[i];
        if (i > 0)
            *at++ = ' ';
        if (is_plain(text)) {
            memcpy(at, text, strlen(text));
            at += strlen(text);
        } else {
            at += quote(text, at);
        }
    }
    return line;
}

void text_list_finish(struct text_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->items[i]);
    free(list->items);
    memset(list, 0, sizeof *list);
}
