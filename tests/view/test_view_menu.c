#include "support/test.h"

#include "log_text.h"

#include "actions.h"
#include "panels.h"

#include <string.h>

static char menu_text[16384], keys_text[16384];

/* The panel as it is drawn the second time: some of the first is unknown to ImGui. */
static void log_panel(struct view_app *app, void (*draw)(struct view_app *), char *text,
                      size_t size)
{
    struct ui_geometry geometry;
    const struct ui_input input = {.width = 1280, .height = 720, .seconds = 0.02f};
    for (int i = 0; i < 2; i++) {
        ui_begin_frame(&input);
        log_text_begin();
        draw(app);
        snprintf(text, size, "%s", log_text_end());
        ui_end_frame(&geometry);
    }
}

static int draw_panels(void **state)
{
    static struct view_app app;
    (void)state;
    app_init(&app);
    app.width = 1280;
    app.height = 720;
    app.open[PANEL_MENU] = app.open[PANEL_KEYS] = true;
    if (!ui_create(1))
        return 1;
    log_panel(&app, panel_menu, menu_text, sizeof menu_text);
    log_panel(&app, panel_keys, keys_text, sizeof keys_text);
    app_finish(&app);
    return 0;
}

static int end_panels(void **state)
{
    (void)state;
    ui_destroy();
    return 0;
}

static const char *key_of(const struct action *action)
{
    return action->shown ? action->shown : action->chord;
}

/* Returns whether the key follows the words, or the end of their button. */
static bool says(const char *text, const char *words, const char *key)
{
    for (const char *at = text; (at = strstr(at, words)); at++) {
        const char *next = at + strlen(words);
        next += strncmp(next, " ] ", 3) == 0 ? 3 : strspn(next, " ");
        const size_t length = strlen(key);
        if (strncmp(next, key, length) == 0 && (next[length] == '\n' || next[length] == '\0'))
            return true;
    }
    return false;
}

/* Keys of recordings are listed where one is shown. */
static bool is_listed(const struct action *action)
{
    static struct view_app app;
    const bool listed = actions_lists(&app, action);
    assert_true(listed || strcmp(action->group, "Recordings") == 0);
    return listed;
}

static void the_menu_has_everything_with_a_key_and_shows_the_key(void **state)
{
    uint32_t count;
    const struct action *actions = actions_get(&count);
    (void)state;
    assert_true(count > 50);
    for (uint32_t i = 0; i < count; i++)
        if (actions[i].chord && is_listed(&actions[i]) &&
            !says(menu_text, actions[i].words, key_of(&actions[i])))
            fail_msg("%s (%s) is not in the menu:\n%s", actions[i].words, key_of(&actions[i]),
                     menu_text);
}

static void the_page_of_keys_has_every_key(void **state)
{
    uint32_t count;
    const struct action *actions = actions_get(&count);
    (void)state;
    for (uint32_t i = 0; i < count; i++)
        if (is_listed(&actions[i]) && !says(keys_text, key_of(&actions[i]), actions[i].words))
            fail_msg("%s (%s) is not on the page:\n%s", actions[i].words, key_of(&actions[i]),
                     keys_text);
}

static bool is_chord(const struct action *action, int key, unsigned modifiers)
{
    struct view_chord chord;
    return action->chord && view_chord_read(action->chord, &chord) && chord.key == key &&
           chord.modifiers == modifiers;
}

/* The menu's name of a key that stands for others. */
static const char *alias_of(int key, unsigned modifiers)
{
    return key == VIEW_KEY_ESCAPE      ? "H or Esc"
           : key == VIEW_KEY_BACKQUOTE ? "Tab or `"
           : key < '1' || key > '9'    ? NULL
           : modifiers == VIEW_CONTROL ? "Ctrl+1 to 9"
           : modifiers == VIEW_ALT     ? "Alt+1 to 9"
                                       : NULL;
}

static void every_key_that_does_something_is_in_the_menu(void **state)
{
    static struct view_app app;
    uint32_t count, found = 0;
    const struct action *actions = actions_get(&count);
    (void)state;
    for (int key = 1; key < VIEW_KEY_COUNT; key++)
        for (unsigned modifiers = 0; modifiers < 8; modifiers++) {
            const char *name = alias_of(key, modifiers);
            app_init(&app);
            app.program = "sluice-view";
            if (!actions_press(&app, key, modifiers))
                continue;
            for (uint32_t i = 0; !name && i < count; i++)
                if (is_chord(&actions[i], key, modifiers))
                    name = key_of(&actions[i]);
            if (!name || !strstr(menu_text, name))
                fail_msg("key %d with modifiers %u is not in the menu", key, modifiers);
            found++;
        }
    assert_true(found > count / 2);
}

static void a_panel_that_is_opened_by_its_key_is_seen_after_panels_were_hidden(void **state)
{
    static struct view_app app;
    (void)state;
    app_init(&app);
    assert_true(actions_press(&app, 'H', 0));
    assert_int_not_equal(app.settings.panels, 0);
    assert_true(actions_press(&app, 'M', 0));
    assert_true(app.open[PANEL_MEMORY]);
    assert_int_equal(app.settings.panels, 0);
    assert_true(actions_press(&app, 'H', 0));
    assert_true(actions_press(&app, 'M', 0));
    assert_true(app.open[PANEL_MEMORY]);
    assert_int_equal(app.settings.panels, 0);
    assert_true(actions_press(&app, 'M', 0));
    assert_false(app.open[PANEL_MEMORY]);
}

static void a_panel_that_opens_by_itself_leaves_panels_hidden(void **state)
{
    static struct view_app app;
    (void)state;
    app_init(&app);
    app.settings.panels = 1;
    app_set_panel(&app, PANEL_FILE, true);
    assert_int_equal(app.settings.panels, 1);
}

static void escape_closes_the_page_of_keys_and_the_menu_before_it_hides_panels(void **state)
{
    static const int pages[] = {PANEL_KEYS, PANEL_MENU};
    static struct view_app app;
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        app_init(&app);
        app_set_panel(&app, (enum app_panel)pages[i], true);
        assert_true(actions_press(&app, VIEW_KEY_ESCAPE, 0));
        assert_false(app.open[pages[i]]);
        assert_int_equal(app.settings.panels, 0);
        assert_true(actions_press(&app, VIEW_KEY_ESCAPE, 0));
        assert_int_not_equal(app.settings.panels, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_menu_has_everything_with_a_key_and_shows_the_key),
        cmocka_unit_test(the_page_of_keys_has_every_key),
        cmocka_unit_test(every_key_that_does_something_is_in_the_menu),
        cmocka_unit_test(a_panel_that_is_opened_by_its_key_is_seen_after_panels_were_hidden),
        cmocka_unit_test(a_panel_that_opens_by_itself_leaves_panels_hidden),
        cmocka_unit_test(escape_closes_the_page_of_keys_and_the_menu_before_it_hides_panels)};
    return cmocka_run_group_tests(tests, draw_panels, end_panels);
}
