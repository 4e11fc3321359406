/* What a report page makes of text from outside, and of its parts. */
#include "tests/support/cmocka_all.h"

#include "base/atomic_file.h"
#include "base/text/chart.h"
#include "base/text/html_page.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define HOSTILE "<b>\"it's\" & more</b>"
#define ESCAPED "&lt;b&gt;&quot;it&#39;s&quot; &amp; more&lt;/b&gt;"

/* The caller frees it. */
static char *finished_page(weft_page *page)
{
    char *html;
    size_t size;
    assert_int_equal(weft_page_finish(page, NULL), WEFT_OK);
    assert_int_equal(weft_read_file("report/index.html", 1 << 20, &html, &size, NULL), WEFT_OK);
    return html;
}

static void nothing_in_a_text_is_markup(void **state)
{
    (void)state;
    weft_page page;
    assert_int_equal(weft_page_begin("report", HOSTILE, &page, NULL), WEFT_OK);
    weft_page_fact(&page, HOSTILE, "%s", HOSTILE);
    weft_page_tile(&page, HOSTILE, "%s", HOSTILE);
    char *html = finished_page(&page);
    assert_non_null(strstr(html, "<title>" ESCAPED "</title>"));
    assert_non_null(strstr(html, "<h1>" ESCAPED "</h1>"));
    assert_non_null(strstr(html, "<tr><td>" ESCAPED "</td><td class=\"fact\">" ESCAPED "</td></tr>"));
    assert_non_null(strstr(html, "<div><b>" ESCAPED "</b>" ESCAPED "</div>"));
    assert_null(strstr(html, "it's"));
    free(html);
}

static void a_picture_lies_beside_the_page_under_its_caption(void **state)
{
    (void)state;
    weft_page page;
    weft_image image;
    assert_int_equal(weft_image_create(3, 2, &image, NULL), WEFT_OK);
    assert_int_equal(weft_page_begin("report", "Pictures", &page, NULL), WEFT_OK);
    assert_int_equal(weft_page_picture(&page, "one", &image, 30, HOSTILE, NULL), WEFT_OK);
    weft_image_free(&image);
    char *html = finished_page(&page);
    assert_non_null(strstr(html, "<a href=\"one.png\"><img src=\"one.png\" width=\"30\" alt=\"" ESCAPED "\"></a>"));
    assert_non_null(strstr(html, "<figcaption>" ESCAPED "</figcaption>"));
    assert_int_equal(access("report/one.png", R_OK), 0);
    free(html);
}

static void headings_of_columns_say_that_they_are(void **state)
{
    (void)state;
    weft_page page;
    assert_int_equal(weft_page_begin("report", "Columns", &page, NULL), WEFT_OK);
    weft_page_columns(&page, "a & b||:words");
    char *html = finished_page(&page);
    assert_non_null(strstr(html, "<tr><th scope=\"col\">a &amp; b</th><th scope=\"col\"></th>"
                                 "<th scope=\"col\" class=\"text\">words</th></tr>\n"));
    free(html);
}

/* The place of the n-th disc of a page. */
static void place_of_disc(const char *html, int n, double place[2])
{
    const char *disc = html;
    for (int i = 0; i <= n; i++) {
        disc = strstr(disc + 1, "<circle");
        assert_non_null(disc);
    }
    assert_int_equal(sscanf(strstr(disc, " cx="), " cx=\"%lf\" cy=\"%lf\"", &place[0], &place[1]), 2);
}

static void a_chart_has_its_points_where_its_ticks_say(void **state)
{
    (void)state;
    weft_page page;
    const double point[][2] = {{0, -5}, {10, 20}, {5, NAN}, {20, 7.5}};
    const weft_chart_series series = {HOSTILE, 1, WEFT_CHART_LINE, 4, point, NULL};
    const weft_chart chart = {HOSTILE, {HOSTILE, "\u00b0", 0, 10, 0}, {"y", " %", 0, 1, 0}, 1, &series};
    assert_int_equal(weft_page_begin("report", "Chart", &page, NULL), WEFT_OK);
    weft_chart_write(&page, &chart);
    char *html = finished_page(&page);
    double first[2], second[2], last[2];
    place_of_disc(html, 0, first);
    place_of_disc(html, 1, second);
    place_of_disc(html, 2, last);
    assert_true(fabs(second[0] - (first[0] + last[0]) / 2) < 0.11);
    assert_true(fabs(last[1] - (first[1] + second[1]) / 2) < 0.11);
    assert_true(second[1] < first[1]);
    char tick[96];
    snprintf(tick, sizeof tick, "text-anchor=\"middle\">20\u00b0</text>");
    assert_non_null(strstr(html, tick));
    snprintf(tick, sizeof tick, "y=\"%.1f\" text-anchor=\"end\">-5 %%</text>", first[1] + 4);
    assert_non_null(strstr(html, tick));
    assert_null(strstr(html, "it's"));
    assert_null(strstr(html, "nan"));
    free(html);
}

static void points_lie_on_logarithmic_axes(void **state)
{
    (void)state;
    weft_page page;
    const double point[][2] = {{1, 100}, {10, 10}, {100, 1}, {0, 5}};
    const weft_chart_note note[] = {{HOSTILE, "a"}, {"second", "b"}, {"third", "c"}, {"absent", "d"}};
    const weft_chart_series series[] = {{"points", 1, WEFT_CHART_POINTS, 4, point, note},
                                        {"stairs", 2, WEFT_CHART_STEPS, 3, point, NULL},
                                        {"nothing", 3, WEFT_CHART_RINGS, 1, point + 3, NULL}};
    const weft_chart chart = {"Powers", {"x", "", 0, 0, 0}, {"y", " %", 0, 0, 0}, 3, series};
    assert_int_equal(weft_page_begin("report", "Chart", &page, NULL), WEFT_OK);
    weft_chart_write_logarithmic(&page, &chart);
    char *html = finished_page(&page);
    double first[2], second[2], last[2];
    place_of_disc(html, 0, first);
    place_of_disc(html, 1, second);
    place_of_disc(html, 2, last);
    assert_true(fabs(second[0] - (first[0] + last[0]) / 2) < 0.11);
    assert_true(fabs(second[1] - (first[1] + last[1]) / 2) < 0.11);
    assert_true(last[0] > first[0] + 300 && last[1] > first[1] + 100);
    assert_non_null(strstr(html, "<a href=\"#b\">"));
    assert_non_null(strstr(html, "second, 10: 10 %"));
    assert_non_null(strstr(html, "</tspan>stairs</text>"));
    assert_null(strstr(html, "absent"));
    assert_null(strstr(html, "nothing"));
    assert_null(strstr(html, "it's"));
    assert_null(strstr(html, "nan"));
    free(html);
}

static void a_chart_of_one_point_has_axes(void **state)
{
    (void)state;
    weft_page page;
    const double point[][2] = {{0, 0}};
    const weft_chart_series series = {NULL, 0, WEFT_CHART_LINE, 1, point, NULL};
    const weft_chart chart = {"One", {"stay", "", 0, 0, 1}, {"y", "", 0, 0, 0}, 1, &series};
    assert_int_equal(weft_page_begin("report", "Chart", &page, NULL), WEFT_OK);
    weft_chart_write(&page, &chart);
    char *html = finished_page(&page);
    assert_null(strstr(html, "nan"));
    assert_null(strstr(html, "inf"));
    assert_null(strstr(html, "middle\">0.")); /* half a stay */
    assert_non_null(strstr(html, "middle\">1</text>"));
    free(html);
}

static void a_chart_of_nothing_is_not_drawn(void **state)
{
    (void)state;
    weft_page page;
    const double nowhere[][2] = {{NAN, 1}, {1, INFINITY}};
    const weft_chart_series series[] = {{"none", 0, WEFT_CHART_LINE, 2, nowhere, NULL},
                                        {"empty", 0, WEFT_CHART_POINTS, 0, NULL, NULL}};
    const weft_chart chart = {"Nothing", {"x", "", 0, 1, 0}, {"y", "", 0, 1, 0}, 2, series};
    assert_int_equal(weft_page_begin("report", "Chart", &page, NULL), WEFT_OK);
    weft_chart_write(&page, &chart);
    char *html = finished_page(&page);
    assert_null(strstr(html, "<svg"));
    free(html);
}

static void a_page_that_is_given_up_leaves_no_file(void **state)
{
    (void)state;
    weft_page page;
    assert_int_equal(weft_page_begin("given-up", "Nothing", &page, NULL), WEFT_OK);
    weft_page_abandon(&page);
    assert_int_not_equal(access("given-up/index.html", F_OK), 0);
}

int test_html_page(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_in_a_text_is_markup),
        cmocka_unit_test(a_picture_lies_beside_the_page_under_its_caption),
        cmocka_unit_test(headings_of_columns_say_that_they_are),
        cmocka_unit_test(a_chart_has_its_points_where_its_ticks_say),
        cmocka_unit_test(points_lie_on_logarithmic_axes),
        cmocka_unit_test(a_chart_of_one_point_has_axes),
        cmocka_unit_test(a_chart_of_nothing_is_not_drawn),
        cmocka_unit_test(a_page_that_is_given_up_leaves_no_file),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
