/* The mean over texels, and what is said of texels once it is imposed on them. */
#include "tests/support/cmocka_all.h"

#include "compress/components/known.h"
#include "tests/support/synthetic_texel.h"

#include <math.h>
#include <stdlib.h>

enum { COUNT = 40, TEXELS = 6, SERIES = 3 * TEXELS, VIEWS = 3, LIGHTS = 4, ASKED = VIEWS * LIGHTS };

static weft_vec3 any_direction(uint64_t *seed)
{
    double theta = 1.2 * sqrt(synthetic_uniform(seed)), phi = 2 * WEFT_PI * synthetic_uniform(seed);
    return weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

/* Reciprocal, and the same after half a turn; `tilt` spoils both. */
static double mean_truth(weft_vec3 l, weft_vec3 v, int channel, double tilt)
{
    weft_vec3 h = weft_unit(weft_add(l, v));
    double highlight = pow(fmax(0, 1 - 1.2 * h.x * h.x - 6 * h.y * h.y), 2) / sqrt(l.z * v.z);
    return l.z * (0.1 * (1 + channel) + highlight) * (1 + tilt * (v.x + v.z));
}

/* Of texels that differ by where their highlights are. */
static double texel_truth(weft_vec3 l, weft_vec3 v, int texel, int channel, double tilt)
{
    weft_vec3 h = weft_unit(weft_add(l, v));
    double sign = texel % 2 ? 1 : -1, differs = sign * (0.5 + 0.1 * (double)(texel / 2)) * sin(3 * h.x);
    return mean_truth(l, v, channel, tilt) * (1 + differs);
}

typedef struct cloth {
    weft_known known;
    weft_direction_pair pair[COUNT];
    double weight[COUNT], sample[SERIES * COUNT];
    weft_component_images images;
    weft_vec3 light[ASKED], view[VIEWS];
    weft_training training;
    float vector[TEXELS * 3 * ASKED];
} cloth;

/* Half a dozen texels at 40 pairs; asked for are other pairs, of which texel t says t + 1. */
static void make(double tilt, cloth *c)
{
    uint64_t seed = 31;
    *c = (cloth){.known = {.count = COUNT, .series_count = SERIES}};
    for (int i = 0; i < COUNT; i++) {
        weft_vec3 l = any_direction(&seed), v = any_direction(&seed);
        c->pair[i] = weft_direction_pair_of(l, v);
        c->weight[i] = 1;
        for (int series = 0; series < SERIES; series++)
            c->sample[series * COUNT + i] = texel_truth(l, v, series / 3, series % 3, tilt);
    }
    for (int i = 0; i < ASKED; i++)
        c->light[i] = any_direction(&seed);
    for (int i = 0; i < VIEWS; i++)
        c->view[i] = any_direction(&seed);
    for (int i = 0; i < TEXELS * 3 * ASKED; i++)
        c->vector[i] = (float)(i / (3 * ASKED) + 1);
    c->known.pair = c->pair;
    c->known.weight = c->weight;
    c->known.sample = c->sample;
    c->images = (weft_component_images){.image_count = ASKED, .view_count = VIEWS, .light = c->light, .view = c->view};
    c->training =
        (weft_training){.texel_count = TEXELS, .length = 3 * ASKED, .image_count = ASKED, .vector = c->vector};
}

static void the_mean_is_that_of_the_texels(void **state)
{
    (void)state;
    cloth c;
    double *mean;
    make(0, &c);
    assert_int_equal(weft_mean_texel_take(&c.known, &mean, NULL), WEFT_OK);
    for (int i = 0; i < COUNT; i++)
        for (int channel = 0; channel < 3; channel++) {
            double sum = 0;
            for (int texel = 0; texel < TEXELS; texel++)
                sum += c.sample[(3 * texel + channel) * COUNT + i];
            assert_float_equal(mean[channel * COUNT + i], sum / TEXELS, 1e-9);
        }
    free(mean);
}

/* Chosen for itself, the mean of a cloth with symmetries is predicted better; that of one without is left alone where
 * the covariance of the texels says more. */
static void its_covariance_is_used_where_it_predicts_better(void **state)
{
    (void)state;
    cloth c;
    weft_covariance texels = weft_covariance_usual(), mean;
    double error_of[2];
    make(0, &c);
    assert_int_equal(weft_mean_texel_choose(&c.known, &texels, NULL, &mean, error_of, NULL), WEFT_OK);
    print_message("mean left out: %.3f as texels are, %.3f by its own covariance\n", error_of[0], error_of[1]);
    assert_true(mean.is_of_mean);
    assert_true(error_of[1] < 0.7 * error_of[0]);
    assert_int_equal(weft_mean_texel_choose(&c.known, &mean, NULL, &texels, error_of, NULL), WEFT_OK);
    assert_true(error_of[1] >= error_of[0]);
    assert_false(texels.is_of_mean);
}

static double mean_said(const cloth *c, int asked, int channel)
{
    double sum = 0;
    for (int texel = 0; texel < TEXELS; texel++)
        sum += (double)c->vector[(texel * ASKED + asked) * 3 + channel] / TEXELS;
    return sum;
}

/* What texels say relative to each other stays. */
static void what_texels_say_has_the_mean_then(void **state)
{
    (void)state;
    cloth c;
    double *mean, error_of[2], square = 0, energy = 0;
    weft_covariance texels = weft_covariance_usual(), covariance;
    make(0, &c);
    for (int texel = 0; texel < TEXELS; texel++) /* nothing to scale */
        c.vector[3 * ASKED * texel] = 0;
    assert_int_equal(weft_mean_texel_choose(&c.known, &texels, NULL, &covariance, error_of, NULL), WEFT_OK);
    assert_int_equal(weft_mean_texel_take(&c.known, &mean, NULL), WEFT_OK);
    assert_int_equal(weft_mean_texel_impose(&c.known, mean, &covariance, &c.images, &c.training, NULL), WEFT_OK);
    for (int i = 1; i < 3 * ASKED; i++) {
        /* The mean over the texels of what differs is not 0 for an even choice of signs alone. */
        double truth = 0, said = mean_said(&c, i / 3, i % 3);
        for (int texel = 0; texel < TEXELS; texel++)
            truth += texel_truth(c.light[i / 3], c.view[i / 3 / LIGHTS], texel, i % 3, 0) / TEXELS;
        square += pow(said - truth, 2);
        energy += truth * truth;
        for (int texel = 1; texel < TEXELS && said > 0; texel++)
            assert_float_equal(c.vector[3 * ASKED * texel + i] / c.vector[i], texel + 1, 1e-3);
    }
    for (int texel = 0; texel < TEXELS; texel++)
        assert_true(c.vector[3 * ASKED * texel] == 0);
    print_message("the mean elsewhere: %.3f\n", sqrt(square / energy));
    assert_true(sqrt(square / energy) < 1.5 * error_of[1]);
    free(mean);
}

int test_mean_texel(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mean_is_that_of_the_texels),
        cmocka_unit_test(its_covariance_is_used_where_it_predicts_better),
        cmocka_unit_test(what_texels_say_has_the_mean_then),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
