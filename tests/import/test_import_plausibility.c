/* Lists and values that contradict the brightness of their photographs are told: a matt sample is photographed here
 * under lamps that are known, and listed wrongly. */
#include "folder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 24, RINGS = 3, LAMPS = 8 };

static const double degree = 0.017453292519943295, albedo = 0.4;

/* How the photographs were made, and how the lamps are listed. */
typedef struct scene {
    double largest_deg;  /* of the lamps from the normal */
    double distance;     /* of the lamps, widths of the picture; 0: far */
    double bulge;        /* of the surface: change of the slope of its normal across the picture */
    double listed_share; /* of the angle that is listed */
    double length;       /* of the vectors that are listed */
    bool is_divided;     /* by the cosine */
} scene;

static double light_at(const scene *s, const double lamp[3], double x, double y)
{
    double normal[3] = {s->bulge * x, s->bulge * y, 1};
    double size = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + 1);
    double to[3] = {lamp[0], lamp[1], lamp[2]}, falloff = 1;
    if (s->distance > 0) {
        double r2 = 0;
        const double at[3] = {x, y, 0};
        for (int i = 0; i < 3; i++) {
            to[i] = s->distance * lamp[i] - at[i];
            r2 += to[i] * to[i];
        }
        falloff = s->distance * s->distance / r2;
        for (int i = 0; i < 3; i++)
            to[i] /= sqrt(r2);
    }
    double cosine = (to[0] * normal[0] + to[1] * normal[1] + to[2] * normal[2]) / size;
    return albedo * falloff * fmax(cosine, 0) / (s->is_divided ? lamp[2] : 1);
}

static void put_photograph(const test_folder *folder, const scene *s, const char *name, const double lamp[3])
{
    weft_image image;
    assert_int_equal(weft_image_create(SIDE, SIDE, &image, NULL), WEFT_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double x = (i % SIDE + 0.5) / SIDE - 0.5, y = 0.5 - (i / SIDE + 0.5) / SIDE;
        for (int c = 0; c < 3; c++)
            image.pixels[3 * i + c] = (float)light_at(s, lamp, x, y);
    }
    folder_put_image(folder, name, &image);
    weft_image_free(&image);
}

static void lamp_of(double theta_deg, double phi_deg, double lamp[3])
{
    lamp[0] = sin(theta_deg * degree) * cos(phi_deg * degree);
    lamp[1] = sin(theta_deg * degree) * sin(phi_deg * degree);
    lamp[2] = cos(theta_deg * degree);
}

/* All notes of the import. */
static void import_scene(scene s, int values, char text[4096])
{
    test_folder folder = folder_make();
    char list[4096];
    int length = snprintf(list, sizeof list, "%d\n", RINGS * LAMPS);
    for (int i = 0; i < RINGS * LAMPS; i++) {
        double lamp[3], listed[3], theta_deg = s.largest_deg * (i / LAMPS + 1) / RINGS, phi_deg = 360.0 * i / LAMPS + 7;
        char name[32];
        snprintf(name, sizeof name, "%02d.exr", i);
        lamp_of(theta_deg, phi_deg, lamp);
        lamp_of(s.listed_share * theta_deg, phi_deg, listed);
        put_photograph(&folder, &s, name, lamp);
        length += snprintf(list + length, sizeof list - (size_t)length, "%s %.6f %.6f %.6f\n", name,
                           s.length * listed[0], s.length * listed[1], s.length * listed[2]);
    }
    folder_put_text(&folder, "dirs.lp", list);
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    weft_error error = {0};
    options.values = values;
    options.texel_pitch_mm = 1;
    if (weft_import(folder.path, folder.dataset, &options, NULL, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    text[0] = 0;
    for (int i = 0; i < report.notes.count; i++)
        snprintf(text + strlen(text), 4096 - strlen(text), "%s\n", report.notes.line[i]);
    weft_import_report_free(&report);
    folder_remove(&folder);
}

static void assert_said(scene s, int values, const char *words)
{
    char text[4096];
    import_scene(s, values, text);
    if (words ? !strstr(text, words) : text[0] != 0)
        fail_msg("'%s' does not say '%s'", text, words ? words : "");
}

static const scene sound = {.largest_deg = 70, .listed_share = 1, .length = 1};

static void what_is_sound_says_nothing(void **state)
{
    (void)state;
    scene s = sound;
    assert_said(s, WEFT_VALUES_OF_SOURCE, NULL);
    s.is_divided = true;
    assert_said(s, WEFT_REFLECTANCE, NULL);
    s = sound;
    s.largest_deg = 40;
    assert_said(s, WEFT_VALUES_OF_SOURCE, NULL);
    s.distance = 30;
    assert_said(s, WEFT_VALUES_OF_SOURCE, NULL);
}

static void a_cosine_too_many_or_too_few_is_told(void **state)
{
    (void)state;
    scene s = sound;
    assert_said(s, WEFT_REFLECTANCE, "is it still in their values?");
    s.is_divided = true;
    assert_said(s, WEFT_VALUES_OF_SOURCE, "pass --values reflectance");
}

static void lights_and_views_that_were_exchanged_are_told(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    char table[8192] = "file,theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n", text[4096] = "";
    for (int i = 0; i < 16; i++) {
        char name[32];
        int theta_light_deg = 20 * (i / 4), theta_view_deg = 20 * (i % 4);
        snprintf(name, sizeof name, "%02d.exr", i);
        folder_put_grey(&folder, name, 4, 4, (float)(albedo * cos(theta_light_deg * degree)));
        snprintf(table + strlen(table), sizeof table - strlen(table), "%s,%d,0,%d,90\n", name, theta_view_deg,
                 theta_light_deg);
    }
    folder_put_text(&folder, "directions.csv", table);
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    weft_error error = {0};
    if (weft_import(folder.path, folder.dataset, &options, NULL, &report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    for (int i = 0; i < report.notes.count; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s\n", report.notes.line[i]);
    weft_import_report_free(&report);
    folder_remove(&folder);
    if (!strstr(text, "are light and view exchanged?"))
        fail_msg("'%s'", text);
}

static void radians_are_asked_for(void **state)
{
    (void)state;
    test_folder folder = folder_make();
    char table[2048] = "file,theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n";
    for (int i = 0; i < 6; i++) {
        char name[32];
        snprintf(name, sizeof name, "%02d.exr", i);
        folder_put_grey(&folder, name, 4, 4, 0.3f);
        snprintf(table + strlen(table), sizeof table - strlen(table), "%s,%g,%g,0.5,3.1\n", name, 0.2 * (i + 1),
                 i * 1.0);
    }
    folder_put_text(&folder, "directions.csv", table);
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    assert_int_equal(weft_import(folder.path, folder.dataset, &options, NULL, &report, NULL), WEFT_OK);
    bool is_asked = false;
    for (int i = 0; i < report.notes.count; i++)
        is_asked =
            is_asked || strstr(report.notes.line[i], "its largest angle is 5 degrees: if its angles are radians");
    assert_true(is_asked);
    weft_import_report_free(&report);
    folder_remove(&folder);
}

static void normals_of_a_ball_for_lamps_are_told(void **state)
{
    (void)state;
    scene s = sound;
    s.listed_share = 0.5;
    assert_said(s, WEFT_VALUES_OF_SOURCE, "the normals of a ball?");
}

/* The size that is told is that of the scene. */
static void near_lamps_are_told_with_their_distance(void **state)
{
    (void)state;
    scene s = sound;
    s.distance = 3;
    assert_said(s, WEFT_VALUES_OF_SOURCE, "lamps at 3 times the width");
    s.distance = 6;
    assert_said(s, WEFT_VALUES_OF_SOURCE, "lamps at 6");
}

static void a_surface_that_bulges_is_not_taken_for_near_lamps(void **state)
{
    (void)state;
    scene s = sound;
    s.bulge = 0.3;
    assert_said(s, WEFT_VALUES_OF_SOURCE, NULL);
}

static void positions_are_told_with_their_distance(void **state)
{
    (void)state;
    scene s = sound;
    s.length = 300;
    assert_said(s, WEFT_VALUES_OF_SOURCE,
                "lamps stand 300 to 300 mm from the middle of the sample; they are taken as far");
    s.length = 30;
    assert_said(s, WEFT_VALUES_OF_SOURCE, "(are these cm or m?)");
    s.length = 0.3;
    assert_said(s, WEFT_VALUES_OF_SOURCE, "0.3 to 0.3 long and taken as directions; positions are in mm");
}

int test_import_plausibility(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_sound_says_nothing),
        cmocka_unit_test(a_cosine_too_many_or_too_few_is_told),
        cmocka_unit_test(lights_and_views_that_were_exchanged_are_told),
        cmocka_unit_test(radians_are_asked_for),
        cmocka_unit_test(normals_of_a_ball_for_lamps_are_told),
        cmocka_unit_test(near_lamps_are_told_with_their_distance),
        cmocka_unit_test(a_surface_that_bulges_is_not_taken_for_near_lamps),
        cmocka_unit_test(positions_are_told_with_their_distance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
