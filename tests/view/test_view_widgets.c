/* Colors of themes (contrast by WCAG 2.1, color blindness), present modes that a window offers, and
 * input of widgets. */
#include "support/test.h"

#include "keys.h"
#include "swapchain.h"
#include "ui.h"

#include <math.h>

static const uint32_t roles[] = {UI_WHITE, UI_GRAY, UI_ORANGE, UI_RED, UI_BLUE};
enum { ROLES = sizeof roles / sizeof *roles };

static void decode(uint32_t color, double linear[3])
{
    for (int i = 0; i < 3; i++) {
        const double c = (color >> 8 * i & 255) / 255.0;
        linear[i] = c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
    }
}

static double luminance(const double linear[3])
{
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
}

/* WCAG 2.1, contrast ratio. */
static double contrast(uint32_t a, uint32_t b)
{
    double x[3], y[3];
    decode(a, x);
    decode(b, y);
    const double light = fmax(luminance(x), luminance(y)), dark = fmin(luminance(x), luminance(y));
    return (light + 0.05) / (dark + 0.05);
}

static void texts_of_every_theme_have_the_contrast_that_reading_needs(void **state)
{
    (void)state;
    static const double least[] = {4.5, 4.5, 7}; /* AA, and AAA for the theme of contrast */
    for (int theme = UI_DARK; theme <= UI_CONTRAST; theme++)
        for (int i = 0; i < ROLES; i++) {
            const double ratio =
                contrast(ui_theme_color(theme, roles[i]), ui_theme_background(theme));
            if (ratio < least[theme])
                fail_msg("theme %d, color %d: %.2f", theme, i, ratio);
        }
}

/* Vienot, Brettel and Mollon, "Digital Video Colourmaps for Checking the Legibility of Displays by
 * Dichromats", 1999: protanopia and deuteranopia in linear RGB. */
static void see(const double linear[3], int kind, double seen[3])
{
    static const double m[2][3][3] = {
        {{0.11238, 0.88762, 0}, {0.11238, 0.88762, 0}, {0.00401, -0.00401, 1}},
        {{0.29275, 0.70725, 0}, {0.29275, 0.70725, 0}, {-0.02234, 0.02234, 1}}};
    for (int i = 0; i < 3; i++)
        seen[i] = fmax(0, m[kind][i][0] * linear[0] + m[kind][i][1] * linear[1] +
                              m[kind][i][2] * linear[2]);
}

static double curve(double t)
{
    return t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

/* CIE 1976 L*a*b*, D65. */
static void lab_of(const double linear[3], double lab[3])
{
    const double r = linear[0], g = linear[1], b = linear[2];
    const double x = curve((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
    const double y = curve(0.2126 * r + 0.7152 * g + 0.0722 * b);
    const double z = curve((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
    lab[0] = 116 * y - 16;
    lab[1] = 500 * (x - y);
    lab[2] = 200 * (y - z);
}

static double difference(uint32_t a, uint32_t b, int kind)
{
    double linear[3], seen[3], left[3], right[3];
    decode(a, linear);
    see(linear, kind, seen);
    lab_of(seen, left);
    decode(b, linear);
    see(linear, kind, seen);
    lab_of(seen, right);
    return sqrt(pow(left[0] - right[0], 2) + pow(left[1] - right[1], 2) +
                pow(left[2] - right[2], 2));
}

static void warnings_differ_for_eyes_without_red_or_green_cones(void **state)
{
    (void)state;
    for (int theme = UI_DARK; theme <= UI_CONTRAST; theme++)
        for (int kind = 0; kind < 2; kind++)
            for (int i = 0; i < ROLES; i++)
                for (int k = i + 1; k < ROLES; k++) {
                    const double apart = difference(ui_theme_color(theme, roles[i]),
                                                    ui_theme_color(theme, roles[k]), kind);
                    if (apart < 10)
                        fail_msg("theme %d, kind %d: colors %d and %d differ by %.1f", theme, kind,
                                 i, k, apart);
                }
}

static void a_mode_that_the_window_lacks_is_replaced_by_the_next_one(void **state)
{
    (void)state;
    static const VkPresentModeKHR modes[] = {VK_PRESENT_MODE_IMMEDIATE_KHR,
                                             VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_FIFO_KHR};
    for (uint32_t wanted = 0; wanted < 3; wanted++)
        for (uint32_t offers = 0; offers < 4; offers++) {
            VkPresentModeKHR offered[3];
            uint32_t count = 0, got = wanted;
            for (uint32_t i = 0; i < 3; i++)
                if (i == 2 || (offers >> i & 1))
                    offered[count++] = modes[i];
            while (got < 2 && !(offers >> got & 1))
                got++;
            assert_int_equal(swapchain_choose_mode(modes[wanted], offered, count), modes[got]);
        }
    assert_string_equal(swapchain_mode_name(VK_PRESENT_MODE_MAILBOX_KHR), "MAILBOX");
}

struct seen {
    bool hovered, doubled, deleted;
    int value;
};

/* Draws a panel with a choice below a button. */
static struct seen draw_choice(struct ui_input *input, int value)
{
    const float placement[4] = {10, 10, 300, 200}, pivot[2] = {0, 0};
    struct ui_geometry geometry;
    struct seen seen = {.value = value};
    input->width = 400;
    input->height = 400;
    input->seconds = 0.05f;
    ui_begin_frame(input);
    if (ui_begin_panel("panel", NULL, placement, pivot, 0)) {
        ui_button("button", 0, 0, false);
        ui_choice("choice", "first|second|third", &seen.value);
        seen.hovered = ui_hovered();
        seen.doubled = ui_double_clicked();
        seen.deleted = ui_deleted();
    }
    ui_end_panel();
    ui_end_frame(&geometry);
    input->key_count = 0;
    return seen;
}

static void find_choice(struct ui_input *input)
{
    *input = (struct ui_input){.mouse_x = 60};
    for (input->mouse_y = 20; input->mouse_y < 200; input->mouse_y += 4) {
        draw_choice(input, 1);
        if (draw_choice(input, 1).hovered)
            break;
    }
    input->mouse_y += 8; /* away from its edge */
    assert_true(draw_choice(input, 1).hovered);
}

static void a_double_click_on_a_choice_is_one_and_leaves_no_list_open(void **state)
{
    (void)state;
    struct ui_input input;
    uint32_t doubled = 0, alone = 0;
    assert_true(ui_create(1));
    find_choice(&input);
    for (int i = 0; i < 20; i++) { /* one click, and much later two */
        input.buttons[0] = i == 1 || i == 12 || i == 14;
        const struct seen seen = draw_choice(&input, 1);
        assert_int_equal(seen.value, 1);
        doubled += seen.doubled;
        alone += i < 12 && seen.doubled;
        if (i == 9) /* an outside click closes the list of the first one */
            input.mouse_y += 150;
        if (i == 10)
            input.mouse_y -= 150;
        input.buttons[0] = i == 9;
        draw_choice(&input, 1);
    }
    assert_true(doubled == 1 && alone == 0);
    assert_true(draw_choice(&input, 1).hovered); /* a list would be in the way */
    ui_destroy();
}

static void press(struct ui_input *input, int key)
{
    for (int down = 1; down >= 0; down--) {
        input->keys[0] = (struct ui_key_event){key, down};
        input->key_count = 1;
        draw_choice(input, 1);
    }
}

static void the_keyboard_alone_reaches_a_choice_and_delete_is_seen_there_only(void **state)
{
    (void)state;
    struct ui_input input = {.mouse_x = -1, .mouse_y = -1};
    uint32_t deleted = 0;
    assert_true(ui_create(1));
    for (int i = 0; i < 3; i++)
        draw_choice(&input, 1);
    input.control = true;
    draw_choice(&input, 1);
    press(&input, VIEW_KEY_TAB);
    input.control = false;
    for (int i = 0; i < 3; i++)
        draw_choice(&input, 1);
    for (int i = 0; i < 3; i++) { /* the button has the keyboard, then the choice */
        input.keys[0] = (struct ui_key_event){VIEW_KEY_DELETE, true};
        input.key_count = 1;
        const bool seen = draw_choice(&input, 1).deleted;
        deleted += seen;
        input.keys[0].down = false;
        input.key_count = 1;
        assert_false(draw_choice(&input, 1).deleted);
        press(&input, VIEW_KEY_DOWN);
        draw_choice(&input, 1);
    }
    assert_true(deleted >= 1 && deleted < 3);
    ui_destroy();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts_of_every_theme_have_the_contrast_that_reading_needs),
        cmocka_unit_test(warnings_differ_for_eyes_without_red_or_green_cones),
        cmocka_unit_test(a_double_click_on_a_choice_is_one_and_leaves_no_list_open),
        cmocka_unit_test(the_keyboard_alone_reaches_a_choice_and_delete_is_seen_there_only),
        cmocka_unit_test(a_mode_that_the_window_lacks_is_replaced_by_the_next_one),
    };
    return RUN_TESTS(tests);
}
