/* A white furnace around the estimators that make samples: those of datasets (weft simulate) and those of the virtual
 * rig. A shipped stitch is painted white, and a closed white floor of rods is laid under it. Then nothing is
 * absorbed and nothing passes: whatever the cloth is like, the reflectance over all lights is 1 in every view. That is
 * the whole truth of the test; it needs no model of the cloth. */
#include "btf/dataset/dataset.h"
#include "geometry/acquisition/acquisition.h"
#include "geometry/light/stitch_sample.h"
#include "tests/geometry/shipped_stitches.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIRECTIONS = 32, IMAGES = DIRECTIONS * DIRECTIONS, SIDE = 4, TEXELS = SIDE * SIDE, COARSE = 24, BOUNCES = 100 };

/* Of the sum over the lights. */
#define QUADRATURE 0.005

/* Directions of equal solid angle over the whole hemisphere: a spiral. Its sum is the integral of the cosine to the
 * last digit, and of what differs from it by a smooth function to a few tenths of a percent. */
static weft_vec3 direction_of(int i, int count)
{
    double z = 1 - (i + 0.5) / count, radius = sqrt(1 - z * z), phi = i * 2.39996322972865332;
    return (weft_vec3){radius * cos(phi), radius * sin(phi), z};
}

/* Overwrites every value of the key, which is a colour, in place. */
static void paint(char *text, const char *key, char digit)
{
    for (char *at = strstr(text, key); at; at = strstr(at + 1, key)) {
        char *open = strchr(at, '{'), *close = strchr(at, '}');
        assert_true(open && close && close - open >= 7);
        memset(open + 1, ' ', (size_t)(close - open - 1));
        for (int c = 0; c < 3; c++) {
            open[1 + 2 * c] = digit;
            open[2 + 2 * c] = c < 2 ? ',' : ' ';
        }
    }
}

/* The shipped stitch with white yarns. */
static char *white_text(const char *name)
{
    char path[512];
    size_t size;
    snprintf(path, sizeof path, "%s/stitches/%s.stitch", WEFT_ASSETS, name);
    char *text = (char *)scratch_load(path, &size);
    text = realloc(text, size + 1);
    assert_non_null(text);
    text[size] = 0;
    paint(text, "diffuse =", '1');
    paint(text, "specular =", '0');
    return text;
}

/* Puts rods that overlap under what `text` describes. */
static char *with_floor(char *text, const weft_tile_mesh *mesh)
{
    enum { RODS = 5 };
    double pitch = (double)mesh->height / RODS, radius = 0.7 * pitch, z = (double)mesh->bottom - 1.3 * radius;
    char *result = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&result, &size);
    assert_non_null(out);
    *strrchr(text, '}') = 0;
    fputs(text, out);
    for (int i = 0; i < RODS; i++) {
        double y = (i + 0.5) * pitch, width = (double)mesh->width;
        fprintf(out,
                ",\n  yarn { radius = %.9g, diffuse = {1, 1, 1}, points { {0, %.9g, %.9g}, {%.9g, %.9g, %.9g}, "
                "{%.9g, %.9g, %.9g} } }",
                radius, y, z, width / 2, y, z, width, y, z);
    }
    fputs("\n}\n", out);
    fclose(out);
    free(text);
    return result;
}

/* The text of the furnace for a shipped stitch. */
static char *furnace_text(const char *name)
{
    weft_stitch stitch;
    weft_tile_mesh mesh;
    shipped_stitch_open(name, COARSE, &stitch, &mesh);
    char *text = with_floor(white_text(name), &mesh);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
    return text;
}

static weft_acquisition_report simulate(const char *name)
{
    weft_stitch stitch;
    weft_tile_mesh mesh;
    weft_vec3 direction[DIRECTIONS];
    weft_acquisition_options options = {.width = SIDE, .height = SIDE, .bounces = BOUNCES, .noise = 0.1, .seed = 5};
    weft_acquisition_report report;
    weft_error error = {0};
    char *text = furnace_text(name);
    for (int i = 0; i < DIRECTIONS; i++)
        direction[i] = direction_of(i, DIRECTIONS);
    if (weft_stitch_parse(text, name, &stitch, &error) != WEFT_OK ||
        weft_tile_mesh_create(&stitch, COARSE, name, &mesh, &error) != WEFT_OK ||
        weft_acquire(&stitch, &mesh, direction, DIRECTIONS, &options, "furnace.btf.h5", NULL, &report, &error))
        fail_msg("%s: %s", name, error.message);
    weft_tile_mesh_free(&mesh);
    weft_stitch_free(&stitch);
    free(text);
    return report;
}

/* Reflectance over all lights, mean over the texels, by view; returns the mean over the views. */
static double read_albedo(double albedo[DIRECTIONS])
{
    static weft_half half[TEXELS][IMAGES][3];
    weft_dataset *dataset;
    double mean = 0;
    assert_int_equal(weft_dataset_open("furnace.btf.h5", &dataset, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_read_block(dataset, 0, 0, SIDE, SIDE, &half[0][0][0], NULL, NULL), WEFT_OK);
    weft_dataset_close(dataset);
    for (int view = 0; view < DIRECTIONS; view++) {
        albedo[view] = 0;
        for (int i = 0; i < TEXELS * DIRECTIONS; i++) {
            double value = (double)weft_float_of_half(half[i / DIRECTIONS][view * DIRECTIONS + i % DIRECTIONS][1]);
            albedo[view] += 2 * value / DIRECTIONS / TEXELS;
        }
        mean += albedo[view] / DIRECTIONS;
    }
    return mean;
}

static void a_simulated_dataset_keeps_all_light(void **state)
{
    (void)state;
    for (int i = 0; i < SHIPPED_STITCHES; i += shipped_stitch_step()) {
        double albedo[DIRECTIONS], worst = 0;
        weft_acquisition_report report = simulate(shipped_stitch[i]);
        double mean = read_albedo(albedo);
        for (int view = 0; view < DIRECTIONS; view++)
            worst = fmax(worst, fabs(albedo[view] - 1));
        /* All lights of a path deviate together at most, texels and views on their own. The RMS of the samples of a
         * white diffuser is 2 / sqrt(3) of their mean. */
        double of_view = report.noise * 2 / sqrt(3) / SIDE, of_mean = of_view / sqrt(DIRECTIONS);
        print_message("%s: %.4f +- %.4f, worst view %.4f off +- %.4f\n", shipped_stitch[i], mean, of_mean, worst,
                      of_view);
        assert_true(fabs(mean - 1) < 4 * of_mean + QUADRATURE);
        assert_true(worst < 4 * of_view + QUADRATURE);
    }
}

/* It follows few bounces: what it lacks is less than the share of paths that are still inside after the last. */
static void a_sample_of_the_virtual_rig_keeps_all_light(void **state)
{
    (void)state;
    enum { PATHS = 3000, LIGHTS = 32 };
    for (int i = 0; i < SHIPPED_STITCHES; i += shipped_stitch_step()) {
        weft_stitch_sample *sample;
        weft_error error = {0};
        char *text = furnace_text(shipped_stitch[i]);
        scratch_store("white.stitch", text, strlen(text));
        free(text);
        if (weft_stitch_sample_read("white.stitch", WEFT_STITCH_SAMPLE_MAX_BOUNCES, &sample, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        double sum = 0, squares = 0, lost = 0;
        for (int path = 0; path < PATHS; path++) {
            weft_seen_vertex vertex[1 + WEFT_STITCH_SAMPLE_MAX_BOUNCES];
            const weft_stitch *stitch = weft_stitch_sample_stitch(sample);
            double u = fmod(0.5 + path * 0.7548776662466927, 1), v = fmod(0.5 + path * 0.5698402909980532, 1);
            int count = weft_stitch_sample_see(sample, u * stitch->width, v * stitch->height,
                                               direction_of(path % LIGHTS, LIGHTS), 3, (uint32_t)path, vertex);
            double here = 0;
            for (int light = 0; light < LIGHTS; light++)
                here += 2.0 / LIGHTS * weft_stitch_sample_light(sample, vertex, count, direction_of(light, LIGHTS)).g;
            lost += count == 1 + WEFT_STITCH_SAMPLE_MAX_BOUNCES;
            sum += here / PATHS;
            squares += here * here / PATHS;
        }
        double deviation = sqrt((squares - sum * sum) / PATHS);
        print_message("%s: %.4f +- %.4f; %.4f of the paths end inside\n", shipped_stitch[i], sum, deviation,
                      lost / PATHS);
        assert_true(sum < 1 + 4 * deviation + QUADRATURE);
        assert_true(sum > 1 - lost / PATHS - 4 * deviation - QUADRATURE);
        assert_true(lost < 0.15 * PATHS);
        weft_stitch_sample_free(sample);
    }
}

int test_furnace(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_simulated_dataset_keeps_all_light),
        cmocka_unit_test(a_sample_of_the_virtual_rig_keeps_all_light),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
