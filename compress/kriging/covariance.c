#include "compress/kriging/covariance.h"

#include "reflectance/layers/half_vector.h"
#include "reflectance/layers/layers.h"

/* Powers of smaller cosines than that of 84 degrees are those of that one: directions nearer to the horizon are rarely
 * photographed, and tell nothing of how highlights go on. */
static const double least_cosine = 0.1;

weft_direction_pair weft_direction_pair_of(weft_vec3 light, weft_vec3 view)
{
    weft_vec3 half_vector = weft_half_vector(light, view);
    return (weft_direction_pair){.light = {(double)light.x, (double)light.y, (double)light.z},
                                 .view = {(double)view.x, (double)view.y, (double)view.z},
                                 .half_vector = {(double)half_vector.x, (double)half_vector.y, (double)half_vector.z},
                                 .log_incidence = log(fmax((double)weft_dot(light, half_vector), WEFT_LEAST_INCIDENCE)),
                                 .log_light = log(fmax((double)light.z, least_cosine)),
                                 .log_view = log(fmax((double)view.z, least_cosine))};
}

/* Where the search for the covariance of a dataset begins: highlights of some 30 degrees, all else wider. Highlights
 * grow with the inverse cosine of incidence. */
weft_covariance weft_covariance_usual(void)
{
    return (weft_covariance){{[WEFT_NOISE] = -4,
                              [WEFT_DIFFUSE_VARIANCE] = 3,
                              [WEFT_SMOOTH_VIEW_LENGTH] = 0.5,
                              [WEFT_HIGHLIGHT_LENGTH] = -1,
                              [WEFT_HIGHLIGHT_VIEW_LENGTH] = 0.5,
                              [WEFT_FIXED_HIGHLIGHT_LENGTH] = -1,
                              [WEFT_INCIDENCE_POWER] = -2}};
}

weft_covariance weft_covariance_diffuse(void)
{
    weft_covariance covariance = weft_covariance_usual();
    covariance.number[WEFT_DIFFUSE_VARIANCE] = 8;
    covariance.number[WEFT_HIGHLIGHT_VARIANCE] = -8;
    covariance.number[WEFT_FIXED_HIGHLIGHT_VARIANCE] = -8;
    return covariance;
}

/* 3 / length^2: the factor that M takes is in it. */
static double scale_of(double log2_of_length)
{
    return 3 * exp2(-2 * log2_of_length);
}

weft_covariance_terms weft_covariance_terms_of(const weft_covariance *covariance)
{
    const double *number = covariance->number;
    return (weft_covariance_terms){.diffuse = exp2(number[WEFT_DIFFUSE_VARIANCE]),
                                   .highlight = exp2(number[WEFT_HIGHLIGHT_VARIANCE]),
                                   .fixed = exp2(number[WEFT_FIXED_HIGHLIGHT_VARIANCE]),
                                   .smooth_light = scale_of(number[WEFT_SMOOTH_LIGHT_LENGTH]),
                                   .smooth_view = scale_of(number[WEFT_SMOOTH_VIEW_LENGTH]),
                                   .highlight_half = scale_of(number[WEFT_HIGHLIGHT_LENGTH]),
                                   .highlight_view = scale_of(number[WEFT_HIGHLIGHT_VIEW_LENGTH]),
                                   .fixed_half = scale_of(number[WEFT_FIXED_HIGHLIGHT_LENGTH]),
                                   .incidence_power = number[WEFT_INCIDENCE_POWER] / 2,
                                   .light_power = number[WEFT_LIGHT_POWER] / 2,
                                   .view_power = number[WEFT_VIEW_POWER] / 2};
}

static double squared_distance(const double a[3], const double b[3])
{
    double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/* Of three times the squared distance. */
static double matern(double scaled)
{
    double distance = sqrt(scaled);
    return (1 + distance) * exp(-distance);
}

double weft_covariance_between(const weft_covariance_terms *terms, const weft_direction_pair *a,
                               const weft_direction_pair *b)
{
    double light = squared_distance(a->light, b->light), view = squared_distance(a->view, b->view);
    double half_vector = squared_distance(a->half_vector, b->half_vector);
    double growth =
        exp(terms->incidence_power * (a->log_incidence + b->log_incidence) +
            terms->light_power * (a->log_light + b->log_light) + terms->view_power * (a->log_view + b->log_view));
    double highlight = terms->highlight * matern(terms->highlight_half * half_vector + terms->highlight_view * view) +
                       terms->fixed * matern(terms->fixed_half * half_vector);
    return terms->diffuse * a->light[2] * b->light[2] +
           matern(terms->smooth_light * light + terms->smooth_view * view) + growth * highlight;
}
