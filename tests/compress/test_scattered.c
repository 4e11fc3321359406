/* Lists of photographs that are no grid. The truth is a microfacet highlight (Trowbridge and Reitz 1975) over a rough
 * diffuse ground (Oren and Nayar 1994), which is none of the terms that kriging has. */
#include "tests/support/cmocka_all.h"

#include "compress/compress.h"
#include "reflectance/components/components.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/support/expect_ok.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 8, ASKED = 150 };

#define NAME "list.btf.h5"

/* ---- The truth ---- */

static double microfacets(weft_vec3 n, weft_vec3 l, weft_vec3 v, double alpha)
{
    weft_vec3 h = weft_unit(weft_add(l, v));
    double nl = weft_dot(n, l), nv = weft_dot(n, v), nh = weft_dot(n, h), a2 = alpha * alpha;
    if (nl <= 0 || nv <= 0)
        return 0;
    double d = a2 / (WEFT_PI * pow(nh * nh * (a2 - 1) + 1, 2));
    double shadow = 2 * nl / (nl + sqrt(a2 + (1 - a2) * nl * nl)), mask = 2 * nv / (nv + sqrt(a2 + (1 - a2) * nv * nv));
    double fresnel = 0.04 + 0.96 * pow(1 - weft_dot(l, h), 5);
    return WEFT_PI * d * shadow * mask * fresnel / (4 * nl * nv);
}

static double rough_diffuse(weft_vec3 n, weft_vec3 l, weft_vec3 v, double sigma)
{
    double nl = weft_dot(n, l), nv = weft_dot(n, v), s2 = sigma * sigma;
    if (nl <= 0 || nv <= 0)
        return 0;
    weft_vec3 flat_l = weft_unit(weft_subtract(l, weft_scale(n, nl))),
              flat_v = weft_unit(weft_subtract(v, weft_scale(n, nv)));
    double alpha = acos(fmin(nl, nv)), beta = acos(fmin(1, fmax(nl, nv)));
    return 1 - 0.5 * s2 / (s2 + 0.33) +
           0.45 * s2 / (s2 + 0.09) * fmax(0, weft_dot(flat_l, flat_v)) * sin(alpha) * tan(beta);
}

/* Whether threads slope as much to either side, and are seen foreshortened: the mean is reciprocal then, and the same
 * after half a turn. */
static bool even_cloth;

/* Threads of two kinds, and a coat that is smoother here than there. */
static void truth(int x, int y, weft_vec3 l, weft_vec3 v, double rgb[3])
{
    weft_vec3 n = weft_unit(weft_vec3_of(x % 2 ? 0.25 : -0.2, y % 2 ? 0.15 : -0.1, 1));
    if (even_cloth)
        n = weft_unit(weft_vec3_of(x % 2 ? 0.3 : -0.3, y % 2 ? 0.2 : -0.2, 1));
    double alpha = 0.25 + 0.05 * ((x + 2 * y) % 4), shine = microfacets(n, l, v, alpha);
    double ground = rough_diffuse(n, l, v, 0.5), albedo = 0.15 + 0.1 * ((3 * x + y) % 5), lit = fmax(0, weft_dot(n, l));
    if (even_cloth)
        lit *= fmax(0, weft_dot(n, v)) / (n.z * v.z);
    for (int c = 0; c < 3; c++)
        rgb[c] = lit * (albedo * (1 - 0.2 * c) * ground + 1.5 * shine);
}

/* ---- Datasets ---- */

static weft_vec3 any_direction(uint64_t *seed)
{
    double theta = 1.25 * sqrt(synthetic_uniform(seed)), phi = 2 * WEFT_PI * synthetic_uniform(seed);
    return weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

static weft_dataset_layout list_of(int images, int views, weft_distance distance)
{
    uint64_t seed = 77;
    weft_dataset_layout layout = {.width = SIDE,
                                  .height = SIDE,
                                  .image_count = images,
                                  .view_count = views,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .distance = distance,
                                  .texel_pitch_mm = 4};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    double far = distance == WEFT_NEAR ? 70 : 1;
    for (int i = 0; i < images; i++) {
        layout.light[i] = weft_scale(any_direction(&seed), far);
        layout.view[i % views] = weft_scale(any_direction(&seed), far);
        layout.view_of_image[i] = i % views;
    }
    return layout;
}

static void fill_truth(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    for (int i = 0; i < layout->image_count; i++) {
        double rgb[3];
        truth(x, y, weft_dataset_light_direction(layout, i, x, y),
              weft_dataset_view_direction(layout, layout->view_of_image[i], x, y), rgb);
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = (float)rgb[c];
    }
}

static weft_material compress_list(const weft_dataset_layout *layout, synthetic_fill *fill, int components,
                                   weft_compress_report *report)
{
    weft_compress_options options = weft_compress_default_options();
    weft_material material;
    weft_error error = {0};
    synthetic_dataset_write(NAME, layout, fill);
    weft_dataset *dataset = synthetic_dataset_open(NAME);
    options.component_count = components;
    options.levels = false;
    if (weft_compress(dataset, &options, NULL, &material, report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    weft_dataset_close(dataset);
    return material;
}

/* ---- What a material says ---- */

typedef struct asked {
    const weft_material *material;
    weft_component_maps maps;
} asked;

static asked ask(const weft_material *material)
{
    asked a = {.material = material};
    if (material->components)
        assert_int_equal(weft_component_maps_create(material->components, &a.maps, NULL), WEFT_OK);
    return a;
}

static weft_rgb answer(const asked *a, int x, int y, weft_vec3 l, weft_vec3 v)
{
    float factor[3 * WEFT_COMPONENTS_MAX];
    if (a->material->components) {
        weft_component_factors(&a->maps, l, v, factor);
        return weft_components_texel(a->material->components, a->material->components->component_count, factor, 0, x, y,
                                     l.z);
    }
    weft_rgba f = weft_material_texel(a->material, NULL, 0, x, y, l, v);
    return (weft_rgb){l.z * f.r, l.z * f.g, l.z * f.b};
}

/* Relative RMSE on pairs of directions that no dataset here has. */
static double error_of(const weft_material *material)
{
    asked a = ask(material);
    uint64_t seed = 4242;
    double square = 0, energy = 0;
    for (int i = 0; i < ASKED; i++) {
        weft_vec3 l = any_direction(&seed), v = any_direction(&seed);
        for (int texel = 0; texel < SIDE * SIDE; texel++) {
            double rgb[3];
            truth(texel % SIDE, texel / SIDE, l, v, rgb);
            weft_rgb said = answer(&a, texel % SIDE, texel / SIDE, l, v);
            square += pow(said.r - rgb[0], 2) + pow(said.g - rgb[1], 2) + pow(said.b - rgb[2], 2);
            energy += rgb[0] * rgb[0] + rgb[1] * rgb[1] + rgb[2] * rgb[2];
        }
    }
    weft_component_maps_free(&a.maps);
    return sqrt(square / energy);
}

static double error_with(int images, int views, weft_distance distance, int components)
{
    weft_dataset_layout layout = list_of(images, views, distance);
    weft_material material = compress_list(&layout, fill_truth, components, NULL);
    double error = error_of(&material);
    assert_true((material.components != NULL) == (components != 0));
    weft_material_free(&material);
    weft_dataset_layout_free(&layout);
    return error;
}

static void more_photographs_say_more_and_more_than_lobes(void **state)
{
    (void)state;
    static const int images[] = {5, 20, 60, 300};
    double before = 1;
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) {
        double components = error_with(images[i], images[i], WEFT_FAR, WEFT_COMPONENTS_AUTOMATIC);
        double lobes = error_with(images[i], images[i], WEFT_FAR, 0);
        print_message("%d photographs: %.3f by components, %.3f by lobes\n", images[i], components, lobes);
        assert_true(components < before);
        assert_true(components < lobes);
        before = components;
    }
}

static void an_even_cloth_has_a_mean_that_is_known_better(void **state)
{
    (void)state;
    even_cloth = true;
    double components = error_with(63, 63, WEFT_FAR, WEFT_COMPONENTS_AUTOMATIC);
    even_cloth = false;
    print_message("63 photographs of an even cloth: %.3f\n", components);
    assert_true(components < 0.15);
}

static void near_photographs_are_seen_from_each_texel(void **state)
{
    (void)state;
    double components = error_with(60, 60, WEFT_NEAR, WEFT_COMPONENTS_AUTOMATIC);
    double far = error_with(60, 60, WEFT_FAR, WEFT_COMPONENTS_AUTOMATIC);
    print_message("near: %.3f by components; %.3f of far ones\n", components, far);
    assert_true(components < 1.1 * far);
}

static void few_near_photographs_share_a_highlight(void **state)
{
    (void)state;
    weft_dataset_layout layout = list_of(12, 12, WEFT_NEAR);
    weft_compress_report report;
    weft_material material = compress_list(&layout, fill_truth, WEFT_COMPONENTS_AUTOMATIC, &report);
    assert_int_equal(report.model, WEFT_COMPRESS_SPARSE);
    assert_int_equal(material.lobe_count, 1);
    assert_null(material.components);
    weft_material_free(&material);
    weft_dataset_layout_free(&layout);
}

/* ---- Masks and threads ---- */

static void fill_masked(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_truth(layout, x, y, samples, mask);
    for (int i = 0; i < layout->image_count; i++) {
        if ((x + i) % 4 && i != 7)
            continue;
        mask[i] = i % 2 ? WEFT_MASK_DARK : WEFT_MASK_MISSING;
        samples[3 * i] = samples[3 * i + 1] = samples[3 * i + 2] = 700;
    }
}

static void masked_samples_leave_no_trace(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        weft_dataset_layout layout = list_of(60, 60, kind ? WEFT_NEAR : WEFT_FAR);
        weft_material whole = compress_list(&layout, fill_truth, WEFT_COMPONENTS_AUTOMATIC, NULL);
        weft_material masked = compress_list(&layout, fill_masked, WEFT_COMPONENTS_AUTOMATIC, NULL);
        double all = error_of(&whole), some = error_of(&masked);
        print_message("a quarter masked: %.3f, else %.3f\n", some, all);
        assert_true(some < 1.15 * all);
        weft_material_free(&whole);
        weft_material_free(&masked);
        weft_dataset_layout_free(&layout);
    }
}

static void threads_leave_no_trace(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        weft_dataset_layout layout = list_of(20, 20, kind ? WEFT_NEAR : WEFT_FAR);
        int threads = omp_get_max_threads();
        omp_set_num_threads(1);
        weft_material one = compress_list(&layout, fill_masked, WEFT_COMPONENTS_AUTOMATIC, NULL);
        omp_set_num_threads(3);
        weft_material three = compress_list(&layout, fill_masked, WEFT_COMPONENTS_AUTOMATIC, NULL);
        omp_set_num_threads(threads);
        size_t count = (size_t)one.components->component_count;
        assert_memory_equal(one.components->level[0].coefficient, three.components->level[0].coefficient,
                            SIDE * SIDE * count);
        assert_memory_equal(one.components->value, three.components->value,
                            3 * count * (size_t)one.components->image_count * sizeof(weft_half));
        weft_material_free(&one);
        weft_material_free(&three);
        weft_dataset_layout_free(&layout);
    }
}

/* The metadata have errors of the two kinds of maps that scattered images choose between, and none of the third. */
static void what_was_not_tried_is_not_told(void **state)
{
    (void)state;
    static const char list[] = "\"trial_relative_rmse\":[";
    weft_dataset_layout layout = list_of(20, 20, WEFT_FAR);
    weft_material material = compress_list(&layout, fill_masked, WEFT_COMPONENTS_AUTOMATIC, NULL);
    const char *at = strstr(material.metadata, list);
    double error[2];
    int end = 0;
    assert_non_null(at);
    assert_int_equal(sscanf(at + strlen(list), "%lf,%lf]%n", &error[0], &error[1], &end), 2);
    assert_true(end > 0 && error[0] > 0 && error[1] > 0);
    weft_material_free(&material);
    weft_dataset_layout_free(&layout);
}

/* ---- One view ---- */

static void one_view_speaks_of_its_lights(void **state)
{
    (void)state;
    weft_dataset_layout layout = list_of(40, 1, WEFT_FAR);
    weft_material material = compress_list(&layout, fill_truth, WEFT_COMPONENTS_AUTOMATIC, NULL);
    weft_vec3 v = weft_unit(layout.view[0]);
    asked a = ask(&material);
    uint64_t seed = 4;
    double square = 0, energy = 0;
    assert_int_equal(material.components->view_count, 1);
    for (int i = 0; i < ASKED; i++) {
        weft_vec3 l = any_direction(&seed);
        double rgb[3];
        truth(3, 2, l, v, rgb);
        weft_rgb said = answer(&a, 3, 2, l, v);
        square += pow(said.g - rgb[1], 2);
        energy += rgb[1] * rgb[1];
    }
    print_message("40 lights on one view: %.3f\n", sqrt(square / energy));
    assert_true(sqrt(square / energy) < 0.15);
    weft_component_maps_free(&a.maps);
    weft_material_free(&material);
    weft_dataset_layout_free(&layout);
}

/* ---- Sets that mean no good ---- */

static void spoil_bright(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_truth(layout, x, y, samples, mask);
    samples[3 * 2] = samples[3 * 2 + 1] = samples[3 * 2 + 2] = 300;
}

static void spoil_noise(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    uint64_t seed = (uint64_t)(17 * x + 113 * y + 1);
    (void)mask;
    for (int i = 0; i < 3 * layout->image_count; i++)
        samples[i] = (float)synthetic_uniform(&seed);
}

static void spoil_clipped(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_truth(layout, x, y, samples, mask);
    for (int i = 0; i < 3 * layout->image_count; i++)
        samples[i] = fminf(samples[i], 0.1f);
}

static void spoil_black(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)x, (void)y, (void)mask;
    for (int i = 0; i < 3 * layout->image_count; i++)
        samples[i] = 0;
}

/* All lights along one line, all pictures of one pair, or as they are. */
typedef enum arrangement { SCATTERED, COLLINEAR, DUPLICATES } arrangement;

static void arrange(weft_dataset_layout *layout, arrangement how)
{
    for (int i = 0; i < layout->image_count && how != SCATTERED; i++) {
        double theta = how == COLLINEAR ? -1.2 + 2.4 * i / layout->image_count : 0.3;
        layout->light[i] = weft_vec3_of(sin(theta), 0, cos(theta));
        layout->view[layout->view_of_image[i]] = weft_vec3_of(0, 0, 1);
    }
}

/* The largest sample, however it came about. */
static double brightest(const weft_dataset_layout *layout, synthetic_fill *fill)
{
    double most = 0;
    float *samples = calloc(3 * (size_t)layout->image_count, sizeof *samples);
    uint8_t *mask = calloc((size_t)layout->image_count, 1);
    for (int texel = 0; texel < SIDE * SIDE; texel++) {
        fill(layout, texel % SIDE, texel / SIDE, samples, mask);
        for (int i = 0; i < 3 * layout->image_count; i++)
            most = fmax(most, (double)samples[i]);
    }
    free(samples);
    free(mask);
    return most;
}

static void hold_to_limits(const char *what, synthetic_fill *fill, arrangement how, int images, int views)
{
    weft_dataset_layout layout = list_of(images, views, WEFT_FAR);
    arrange(&layout, how);
    weft_material material = compress_list(&layout, fill, WEFT_COMPONENTS_AUTOMATIC, NULL);
    /* A ceiling is rounded up by at most an eighth of a power of two. */
    double limit = WEFT_BRIGHTEST_MULTIPLE * brightest(&layout, fill) * 1.1 + 1e-6, most = 0;
    asked a = ask(&material);
    uint64_t seed = 99;
    assert_non_null(material.components);
    for (int i = 0; i < 20 * ASKED; i++) {
        weft_vec3 l = any_direction(&seed), v = any_direction(&seed);
        weft_rgb said = answer(&a, i % SIDE, i / SIDE % SIDE, l, v);
        if (!(said.r >= 0 && said.g >= 0 && said.b >= 0))
            fail_msg("%s: %g %g %g", what, said.r, said.g, said.b);
        most = fmax(most, fmax(said.r, fmax(said.g, said.b)));
    }
    if (!(most <= limit))
        fail_msg("%s: %g above %g", what, most, limit);
    weft_component_maps_free(&a.maps);
    weft_material_free(&material);
    weft_dataset_layout_free(&layout);
}

static void bad_sets_keep_to_the_limits(void **state)
{
    (void)state;
    hold_to_limits("one bright light", spoil_bright, SCATTERED, 12, 12);
    hold_to_limits("noise alone", spoil_noise, SCATTERED, 12, 12);
    hold_to_limits("clipped", spoil_clipped, SCATTERED, 12, 12);
    hold_to_limits("black", spoil_black, SCATTERED, 8, 8);
    hold_to_limits("lights on a line", fill_truth, COLLINEAR, 12, 12);
    hold_to_limits("one pair again and again", fill_truth, DUPLICATES, 12, 12);
    hold_to_limits("one view", spoil_noise, SCATTERED, 8, 1);
    hold_to_limits("one image", fill_truth, SCATTERED, 1, 1);
    hold_to_limits("two images", fill_truth, SCATTERED, 2, 2);
}

/* Of `views` views with `lights` lights each. */
static bool is_scattered(int views, int lights, weft_distance distance)
{
    enum { MOST = 600 };
    int view_of_image[MOST];
    for (int i = 0; i < views * lights; i++)
        view_of_image[i] = i / lights;
    const weft_dataset_layout layout = {
        .view_count = views, .image_count = views * lights, .view_of_image = view_of_image, .distance = distance};
    return weft_images_are_scattered(&layout);
}

/* Two or three views do not tell what lies between them: kriging over pairs of directions knows more of it. */
static void what_is_no_grid_is_scattered(void **state)
{
    (void)state;
    assert_false(is_scattered(1, 12, WEFT_FAR));
    assert_false(is_scattered(4, 12, WEFT_FAR));
    assert_true(is_scattered(1, 11, WEFT_FAR));
    assert_true(is_scattered(2, 16, WEFT_FAR));
    assert_true(is_scattered(3, 16, WEFT_FAR));
    assert_true(is_scattered(1, 600, WEFT_FAR));
    assert_true(is_scattered(4, 12, WEFT_NEAR));
}

int test_scattered(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(more_photographs_say_more_and_more_than_lobes),
        cmocka_unit_test(an_even_cloth_has_a_mean_that_is_known_better),
        cmocka_unit_test(near_photographs_are_seen_from_each_texel),
        cmocka_unit_test(few_near_photographs_share_a_highlight),
        cmocka_unit_test(masked_samples_leave_no_trace),
        cmocka_unit_test(threads_leave_no_trace),
        cmocka_unit_test(what_was_not_tried_is_not_told),
        cmocka_unit_test(one_view_speaks_of_its_lights),
        cmocka_unit_test(bad_sets_keep_to_the_limits),
        cmocka_unit_test(what_is_no_grid_is_scattered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
