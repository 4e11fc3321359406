/* What the maps of components say of a highlight that some views did not see. */
#include "tests/support/cmocka_all.h"

#include "btf/direction/direction.h"
#include "reflectance/components/components.h"
#include "tests/support/expect_ok.h"

#include <math.h>

enum { VIEWS = 49, LIGHTS = 61, BLIND = 5 }; /* every fifth view is blind to the highlight */

static weft_vec3 direction(int index)
{
    return weft_direction_of_angles(weft_ubo81_angles(index));
}

/* A highlight round the normal, the same for all views; times l . h it is a function of the half vector. */
static double truth(weft_vec3 light, weft_vec3 view)
{
    weft_vec3 half_vector = weft_unit(weft_add(light, view));
    return exp(-12 * (1 - half_vector.z)) / weft_dot(light, half_vector);
}

static bool is_seen(int view, int light)
{
    weft_vec3 half_vector = weft_unit(weft_add(direction(view), direction(light)));
    return view % BLIND != 2 || half_vector.z < cos(weft_rad_of_deg(25));
}

static void fill(weft_components *components)
{
    uint32_t images = 0;
    for (int view = 0; view < VIEWS; view++) {
        const weft_vec3 v = direction(view);
        components->first[view] = images;
        for (int k = 0; k < 3; k++)
            components->view[3 * view + k] = (float)(k == 0 ? v.x : k == 1 ? v.y : v.z);
        for (int light = 0; light < LIGHTS; light++) {
            const weft_vec3 l = direction(light);
            if (!is_seen(view, light))
                continue;
            for (int k = 0; k < 3; k++)
                components->light[3 * images + (uint32_t)k] = (float)(k == 0 ? l.x : k == 1 ? l.y : l.z);
            components->value[(size_t)images * 3 * WEFT_COMPONENTS_GROUP] = weft_half_of_float((float)truth(l, v));
            images++;
        }
    }
    components->first[VIEWS] = images;
    components->scale[0] = 1;
}

static int count_images(void)
{
    int count = 0;
    for (int view = 0; view < VIEWS; view++)
        for (int light = 0; light < LIGHTS; light++)
            count += is_seen(view, light);
    return count;
}

/* Relative RMSE where the blind views would have seen it. */
static double error_of_what_was_not_seen(weft_components_kind kind, float view_variance_threshold)
{
    const weft_components shape = {.kind = kind,
                                   .component_count = WEFT_COMPONENTS_GROUP,
                                   .view_count = VIEWS,
                                   .image_count = count_images(),
                                   .light_side = 16,
                                   .view_side = 10,
                                   .light_smoothness = 1e-3f,
                                   .view_smoothness = 3e-3f,
                                   .exponent = 1,
                                   .incidence_power = 1,
                                   .least_incidence = 0.0625f,
                                   .view_length = 1,
                                   .view_nugget = 1e-3f,
                                   .least_cosine = 0.2f,
                                   .view_variance_threshold = view_variance_threshold};
    weft_error error = {0};
    weft_components *components = NULL;
    weft_component_maps maps;
    expect_ok(weft_components_create(&shape, 4, 4, 1, &components, &error), &error);
    fill(components);
    for (int k = 0; k < WEFT_COMPONENTS_GROUP; k++) {
        components->length[k] = 0.6f;
        components->nugget[k] = 1e-4f;
    }
    expect_ok(weft_component_maps_create(components, &maps, &error), &error);
    double squares = 0, energy = 0;
    for (int view = 0; view < VIEWS; view++)
        for (int light = 0; light < LIGHTS; light++) {
            float factor[3 * WEFT_COMPONENTS_GROUP];
            double true_value = truth(direction(light), direction(view));
            if (is_seen(view, light))
                continue;
            weft_component_factors(&maps, direction(light), direction(view), factor);
            squares += ((double)factor[0] - true_value) * ((double)factor[0] - true_value);
            energy += true_value * true_value;
        }
    weft_component_maps_free(&maps);
    weft_components_free(components);
    return sqrt(squares / energy);
}

static void a_highlight_is_taken_from_the_views_that_saw_it(void **state)
{
    (void)state;
    double alike = error_of_what_was_not_seen(WEFT_COMPONENTS_OF_HALF_VECTOR, 0),
           doubted = error_of_what_was_not_seen(WEFT_COMPONENTS_OF_HALF_VECTOR, 10),
           kriged = error_of_what_was_not_seen(WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR, 0);
    print_message("all views alike %.3f, by what they know %.3f, kriged %.3f\n", alike, doubted, kriged);
    assert_true(doubted < 0.2);
    assert_true(kriged < 0.2);
    assert_true(alike > 2 * doubted);
}

int test_component_maps(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_highlight_is_taken_from_the_views_that_saw_it)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
