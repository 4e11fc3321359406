/* The hints of the panel: each belongs to a widget that there is, and the key in it does that. */
#include "player/window/keys.h"
#include "player/window/ui/ui_bridge.h"
#include "tests/support/expect_ok.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROOM = 1 << 18, LONGEST = 72 };

/* The sources of the panel, one after the other. The caller frees. */
static char *sources(void)
{
    static const char *const name[] = {"panel.c", "panel_weave.c", "weave_edit.c"};
    char *all = calloc(ROOM, 1);
    size_t used = 0;
    assert_non_null(all);
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", WEFT_TREE "/player/window", name[i]);
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        used += fread(all + used, 1, ROOM - 1 - used, file);
        fclose(file);
    }
    assert_true(used < ROOM - 1);
    return all;
}

static void every_hint_has_its_widget(void **state)
{
    (void)state;
    const char *label;
    char *all = sources();
    for (size_t i = 0; weft_hint_at(i, &label); i++) {
        char quoted[80];
        snprintf(quoted, sizeof quoted, "\"%s\"", label);
        if (!strstr(all, quoted))
            fail_msg("no widget of the panel is called %s", quoted);
    }
    free(all);
}

static void a_hint_is_a_short_line_and_not_its_label(void **state)
{
    (void)state;
    const char *label, *other, *text;
    for (size_t i = 0; (text = weft_hint_at(i, &label)); i++) {
        assert_true(strlen(text) > 0 && strlen(text) <= LONGEST && !strchr(text, '\n'));
        assert_string_not_equal(text, label);
        assert_ptr_equal(weft_hint_of(label), text);
        for (size_t k = 0; k < i && weft_hint_at(k, &other); k++)
            assert_string_not_equal(other, label);
    }
    assert_null(weft_hint_of("Rew"));
}

/* What the table of keys says of a key; NULL: there is none. */
static const char *meaning_of(const char *name)
{
    size_t count;
    const weft_key *key = weft_keys(&count);
    for (size_t i = 0; i < count; i++) {
        if (key[i].name && key[i].meaning && strcmp(key[i].name, name) == 0)
            return key[i].meaning;
    }
    return NULL;
}

/* Words of the table of keys that tell the widget. */
static const struct {
    const char *label, *key, *word;
} keyed[] = {
    {"Raw", "1", "raw"},
    {"Compressed", "2", "compressed"},
    {"Analytic", "3", "analytic"},
    {"Panes", "S", "side by side"},
    {"Wipe", "W", "wipe"},
    {"Difference", "X", "difference"},
    {"Shadows", "C", "shadows"},
    {"Environment", "E", "environment"},
    {"Drape", "D", "drape"},
    {"Ball", "O", "ball"},
    {"Plane", "P", "plane"},
    {"Trilinear", "M", "trilinear"},
    {"Nearest", "M", "nearest"},
    {"None", "M", "none"},
    {"Show levels", "N", "mip level"},
    {"Exposure", "[", "darker"},
    {"Exposure", "]", "brighter"},
    {"Tint extrapolation", "T", "tint"},
};

static void the_key_in_a_hint_does_the_same(void **state)
{
    (void)state;
    size_t count = 0, listed = 0;
    const char *label, *text;
    for (size_t i = 0; i < sizeof keyed / sizeof *keyed; i++) {
        const char *bracket = strrchr(weft_hint_of(keyed[i].label), '(');
        assert_non_null(bracket);
        assert_non_null(strstr(bracket, keyed[i].key));
        assert_non_null(meaning_of(keyed[i].key));
        assert_non_null(strstr(meaning_of(keyed[i].key), keyed[i].word));
        count += i == 0 || strcmp(keyed[i].label, keyed[i - 1].label) != 0;
    }
    for (size_t i = 0; (text = weft_hint_at(i, &label)); i++)
        listed += text[strlen(text) - 1] == ')';
    assert_int_equal(listed, count);
}

int test_hints(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_hint_has_its_widget),
        cmocka_unit_test(a_hint_is_a_short_line_and_not_its_label),
        cmocka_unit_test(the_key_in_a_hint_does_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
